-- lensprof profile database, from layout 5 to layout 6: black and white level of pictures.
-- Runs in one transaction; a new database is made by 0001_profiles.sql and those that follow.

PRAGMA user_version = 6;

-- Samples without light and at saturation, as shares of full scale: grey value = (sample - black) / (white - black).
-- NULL = 0 of black, and full scale of white.
ALTER TABLE profiles ADD COLUMN black_red REAL CHECK (black_red >= -0.5 AND black_red < 1);
ALTER TABLE profiles ADD COLUMN black_green REAL CHECK (black_green >= -0.5 AND black_green < 1);
ALTER TABLE profiles ADD COLUMN black_blue REAL CHECK (black_blue >= -0.5 AND black_blue < 1);
ALTER TABLE profiles ADD COLUMN white_level REAL CHECK (white_level > 0 AND white_level <= 1);
