-- lensprof profile database, from layout 6 to layout 7: the image circle of lenses that do not cover the frame.
-- Runs in one transaction; a new database is made by 0001_profiles.sql and those that follow.

PRAGMA user_version = 7;

-- Its centre, to the right of and below the middle of the frame, and its radius: half diagonals. NULL = no circle.
ALTER TABLE profiles ADD COLUMN circle_x REAL CHECK (circle_x BETWEEN -1 AND 1);
ALTER TABLE profiles ADD COLUMN circle_y REAL CHECK (circle_y BETWEEN -1 AND 1);
ALTER TABLE profiles ADD COLUMN circle_radius REAL
    CHECK ((circle_radius IS NULL) = (circle_x IS NULL) AND (circle_radius IS NULL) = (circle_y IS NULL)
           AND circle_radius > 0 AND circle_radius <= 4);
