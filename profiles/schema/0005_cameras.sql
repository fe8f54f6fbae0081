-- lensprof profile database, from layout 4 to layout 5: picture styles, the error of the common exponent, and cameras.
-- Runs in one transaction; a new database is made by 0001_profiles.sql and those that follow.

PRAGMA user_version = 5;

-- Part of the key: the picture style of a rendering, as the camera calls it; empty = any, or not known.
ALTER TABLE profiles ADD COLUMN style TEXT NOT NULL DEFAULT '' CHECK (length(CAST(style AS BLOB)) <= 63);

-- Part of where it comes from: standard error of ln gamma, the common exponent of response and falloff.
ALTER TABLE profiles ADD COLUMN gamma_sigma REAL CHECK (gamma_sigma > 0 AND gamma_sigma < 9e999);

-- Cameras: sensor size, mount and, where it cannot be changed, the lens. Several rows may have one name: a camera whose
-- picture formats have sensor sizes of their own, or cameras that EXIF does not tell apart.
CREATE TABLE cameras (
    id          INTEGER PRIMARY KEY CHECK (id > 0),
    maker       TEXT NOT NULL CHECK (length(CAST(maker AS BLOB)) <= 63), -- these two as EXIF has them
    model       TEXT NOT NULL CHECK (length(CAST(model AS BLOB)) <= 63),
    other_maker TEXT NOT NULL CHECK (length(CAST(other_maker AS BLOB)) <= 63), -- as people call it; '' = the same
    other_model TEXT NOT NULL CHECK (length(CAST(other_model AS BLOB)) <= 63),
    variant     TEXT NOT NULL CHECK (length(CAST(variant AS BLOB)) <= 63), -- which of those with one name; '' = the only one
    mount       TEXT NOT NULL CHECK (length(CAST(mount AS BLOB)) <= 63),   -- '' = not known
    lens        TEXT NOT NULL CHECK (length(CAST(lens AS BLOB)) <= 127),   -- as profiles call it; '' = can be changed, or not known
    crop_factor REAL CHECK (crop_factor > 0 AND crop_factor < 9e999),      -- 43.27 mm over the sensor's diagonal
    fixed_lens  INTEGER NOT NULL CHECK (fixed_lens IN (0, 1)),             -- 1 = the lens cannot be changed
    source      TEXT NOT NULL CHECK (length(CAST(source AS BLOB)) <= 255), -- file or database it is from
    -- model and other_model as lookups search them: without maker, ASCII case, blanks and signs
    name        TEXT NOT NULL,
    other_name  TEXT NOT NULL,
    UNIQUE (maker, model, variant)
) STRICT;
CREATE INDEX cameras_by_name ON cameras (name);
CREATE INDEX cameras_by_other_name ON cameras (other_name);

-- The way to a camera's responses: its name without ASCII case, blanks and signs, as lens_name is made of a lens's.
CREATE INDEX profiles_by_rendering ON profiles (
    lower(replace(replace(replace(replace(replace(replace(camera_model, ' ', ''), '-', ''), '/', ''), '.', ''), '(', ''), ')', '')),
    id) WHERE processing <> 'raw';
