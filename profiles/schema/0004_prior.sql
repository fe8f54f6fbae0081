-- lensprof profile database, from layout 3 to layout 4: what a profile holds, whether it was forced, and the colour
-- temperature of shading tables. Runs in one transaction; a new database is made by 0001_profiles.sql and those that
-- follow.

PRAGMA user_version = 4;

-- Part of the key: colour temperature of the light in K, where the falloff depends on it.
ALTER TABLE profiles ADD COLUMN color_temperature_k REAL
    CHECK (color_temperature_k > 0 AND color_temperature_k < 9e999);

-- Part of where it comes from. prior_id: the profile of this database that was the prior of its fit, whose pictures are
-- in it; NULL = none. It may have been removed since. forced: 1 = stored although the fit was not usable.
ALTER TABLE profiles ADD COLUMN prior_id INTEGER CHECK (prior_id > 0);
ALTER TABLE profiles ADD COLUMN forced INTEGER NOT NULL DEFAULT 0 CHECK (forced IN (0, 1));

-- Both were at the end of the method: "transfer+12 (forced)". src/store/profiles/layouts.h reads older layouts so.
UPDATE profiles SET forced = 1, method = substr(method, 1, length(method) - 9) WHERE substr(method, -9) = ' (forced)';
UPDATE profiles SET
    prior_id = nullif(CAST(substr(method, length(rtrim(method, '0123456789')) + 1) AS INTEGER), 0),
    method = substr(rtrim(method, '0123456789'), 1, length(rtrim(method, '0123456789')) - 1)
    WHERE rtrim(method, '0123456789') LIKE '%+' AND rtrim(method, '0123456789') <> method;
