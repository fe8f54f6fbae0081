-- lensprof profile database, layout 1. Needs SQLite 3.37 (STRICT tables).
--
-- A profile is one row of `profiles` with 1 or 3 rows in `responses` and in `vignettings`.
--   unknown   An unknown number is NULL, an unknown text is ''. NULL is never 0 or -1.
--   infinity  A lens focused at infinity has the REAL infinity in distance_m (`Inf` in the shell; write it 9e999).
--   curve     0 = all channels, or red when there are three; 1 = green; 2 = blue.
--   blobs     IEEE 754 float64, little-endian, without padding.
--   numbers   REAL keeps every bit of a finite number, except that SQLite stores -0.0 as 0.0.
-- lensprof checks everything it reads again; the constraints are for those who write with other tools. Such writers
-- turn `PRAGMA foreign_keys` on, and write a profile in one transaction.

PRAGMA application_id = 0x4C505246; -- "LPRF"; how lensprof and file(1) know the file
PRAGMA user_version = 1;            -- the layout; a lensprof that knows less refuses the file

CREATE TABLE profiles (
    id             INTEGER PRIMARY KEY AUTOINCREMENT CHECK (id > 0), -- never used again: the largest is the newest
    -- What it is for. Profiles with the same key may coexist; the newest is found.
    camera_maker   TEXT NOT NULL CHECK (length(CAST(camera_maker AS BLOB)) <= 63),
    camera_model   TEXT NOT NULL CHECK (length(CAST(camera_model AS BLOB)) <= 63),
    lens           TEXT NOT NULL CHECK (length(CAST(lens AS BLOB)) <= 127),
    focal_mm       REAL CHECK (focal_mm > 0 AND focal_mm < 9e999),
    aperture       REAL CHECK (aperture > 0 AND aperture < 9e999), -- f-number
    distance_m     REAL CHECK (distance_m > 0),
    processing     TEXT NOT NULL CHECK (processing IN ('raw', 'jpeg', 'corrected')),
    -- Where it comes from.
    method         TEXT NOT NULL CHECK (length(CAST(method AS BLOB)) <= 31),
    software       TEXT NOT NULL CHECK (length(CAST(software AS BLOB)) <= 31),
    source         TEXT NOT NULL CHECK (length(CAST(source AS BLOB)) <= 255),
    created_unix_s INTEGER CHECK (created_unix_s <> 0),
    images         INTEGER NOT NULL CHECK (images BETWEEN 0 AND 4294967295),
    pairs          INTEGER NOT NULL CHECK (pairs BETWEEN 0 AND 4294967295),
    heldout_rms    REAL CHECK (heldout_rms >= 0 AND heldout_rms < 9e999), -- levels of 255
    inlier_share   REAL CHECK (inlier_share BETWEEN 0 AND 1),
    -- How many curves belong to it, and the covariance of the estimated parameters: n x n, row major; the order is
    -- EMoR coefficients, then k1, k2, k3 of each vignetting curve, then centre x and y.
    response_curves   INTEGER NOT NULL CHECK (response_curves IN (1, 3)),
    vignetting_curves INTEGER NOT NULL CHECK (vignetting_curves IN (1, 3)),
    covariance_size   INTEGER NOT NULL CHECK (covariance_size BETWEEN 0 AND 36), -- n; 0 = not known
    covariance        BLOB CHECK (length(covariance) = 8 * covariance_size * covariance_size),
    CHECK ((covariance IS NULL) = (covariance_size = 0))
) STRICT;

-- The order of listings, and the way to a key: ASCII case and outer blanks do not count.
CREATE INDEX profiles_by_key ON profiles (
    trim(camera_maker) COLLATE NOCASE, trim(camera_model) COLLATE NOCASE, trim(lens) COLLATE NOCASE,
    focal_mm, aperture, distance_m, id);

-- B = f(x). linear: f = x. gamma: f = x^(1/gamma). emor: f = f0 + sum of coefficient * h_mode, on 1024 samples
-- (Grossberg and Nayar 2004). table: 1024 samples on the uniform grid x = j/1023.
CREATE TABLE responses (
    profile_id INTEGER NOT NULL REFERENCES profiles (id) ON DELETE CASCADE,
    curve      INTEGER NOT NULL CHECK (curve BETWEEN 0 AND 2),
    kind       TEXT NOT NULL CHECK (kind IN ('linear', 'gamma', 'emor', 'table')),
    gamma      REAL CHECK (gamma BETWEEN 0.1 AND 10),
    emor_modes INTEGER CHECK (emor_modes BETWEEN 0 AND 25), -- rows in emor_coefficients: modes 1..emor_modes
    samples    BLOB CHECK (length(samples) = 8192),
    PRIMARY KEY (profile_id, curve),
    CHECK ((gamma IS NOT NULL) = (kind = 'gamma')),
    CHECK ((emor_modes IS NOT NULL) = (kind = 'emor')),
    CHECK ((samples IS NOT NULL) = (kind = 'table'))
) STRICT;

CREATE TABLE emor_coefficients (
    profile_id  INTEGER NOT NULL,
    curve       INTEGER NOT NULL,
    mode        INTEGER NOT NULL CHECK (mode BETWEEN 1 AND 25),
    coefficient REAL NOT NULL CHECK (abs(coefficient) < 9e999),
    PRIMARY KEY (profile_id, curve, mode),
    FOREIGN KEY (profile_id, curve) REFERENCES responses (profile_id, curve) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- M = 1 + k1 r^2 + k2 r^4 + k3 r^6, r in half diagonals of the frame from the centre, which lies center_x to the right
-- of and center_y below the middle of the frame, in half diagonals.
CREATE TABLE vignettings (
    profile_id INTEGER NOT NULL REFERENCES profiles (id) ON DELETE CASCADE,
    curve      INTEGER NOT NULL CHECK (curve BETWEEN 0 AND 2),
    k1         REAL NOT NULL CHECK (abs(k1) < 9e999),
    k2         REAL NOT NULL CHECK (abs(k2) < 9e999),
    k3         REAL NOT NULL CHECK (abs(k3) < 9e999),
    center_x   REAL NOT NULL CHECK (abs(center_x) <= 1),
    center_y   REAL NOT NULL CHECK (abs(center_y) <= 1),
    PRIMARY KEY (profile_id, curve)
) STRICT, WITHOUT ROWID;
