-- lensprof profile database, from layout 2 to layout 3: single units, sensor sizes, doubt, and a way to a lens by its
-- name. Runs in one transaction; a new database is made by 0001_profiles.sql and those that follow.

PRAGMA user_version = 3;

-- Part of the key: serial numbers of the one camera and lens that a profile is of; empty = any of the model. The
-- sensor's size: 43.27 mm over its diagonal.
ALTER TABLE profiles ADD COLUMN unit TEXT NOT NULL DEFAULT '' CHECK (length(CAST(unit AS BLOB)) <= 63);
ALTER TABLE profiles ADD COLUMN crop_factor REAL CHECK (crop_factor > 0 AND crop_factor < 9e999);

-- Part of where it comes from: why it may be wrong, as found when it was imported; empty = no doubt.
ALTER TABLE profiles ADD COLUMN doubt TEXT NOT NULL DEFAULT '' CHECK (length(CAST(doubt AS BLOB)) <= 63);

-- The lens as lookups search it: names are written in many ways; this is lens without ASCII case, blanks and signs.
ALTER TABLE profiles ADD COLUMN lens_name TEXT NOT NULL DEFAULT '';
UPDATE profiles SET lens_name =
    lower(replace(replace(replace(replace(replace(replace(lens, ' ', ''), '-', ''), '/', ''), '.', ''), '(', ''), ')', ''));
CREATE INDEX profiles_by_lens ON profiles (lens_name, id);
