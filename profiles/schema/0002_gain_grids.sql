-- lensprof profile database, from layout 1 to layout 2: what a radial falloff leaves. Runs in one transaction; a new
-- database is made by 0001_profiles.sql and this.

PRAGMA user_version = 2;

-- How many rows in gain_grids belong to the profile.
ALTER TABLE profiles ADD COLUMN gain_grids INTEGER NOT NULL DEFAULT 0 CHECK (gain_grids IN (0, 1));

-- Attenuation on a grid over the frame, multiplied to M. Bilinear between nodes; the first one lies at the frame's
-- first pixel, the last at its last. The blob is IEEE 754 float32, little-endian, [channel][row][column], without
-- padding.
CREATE TABLE gain_grids (
    profile_id   INTEGER PRIMARY KEY REFERENCES profiles (id) ON DELETE CASCADE,
    grid_columns INTEGER NOT NULL CHECK (grid_columns BETWEEN 2 AND 32),
    grid_rows    INTEGER NOT NULL CHECK (grid_rows BETWEEN 2 AND 32),
    channels     INTEGER NOT NULL CHECK (channels IN (1, 3)), -- one for all, or red, green, blue
    attenuation  BLOB NOT NULL CHECK (length(attenuation) = 4 * channels * grid_rows * grid_columns)
) STRICT;
