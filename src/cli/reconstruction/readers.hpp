// The files of structure-from-motion programs. Every reader throws Failure (unreadable), which names the file, for one
// that is damaged, and (not_usable) for one in which no two images share a point.
#pragma once

#include <string>

#include "cli/reconstruction/reconstruction.hpp"

namespace lensprof {

// COLMAP's database.db: points are what its verified matches join. True of a file that is one, or of a database that
// cannot be read.
bool is_colmap_database(const std::string &path);
bool is_database(const std::string &path);  // of SQLite, COLMAP's or not
Reconstruction read_colmap_database(const std::string &path);

// A folder of cameras, images and points3D, .bin or .txt.
bool is_colmap_model(const std::string &folder);
Reconstruction read_colmap_model(const std::string &folder);

// Takes the shapes of a model's features from the database that it was made of. False, and nothing changed, where that
// has other features.
bool take_shapes(const std::string &database, Reconstruction &model);

// OpenSfM's tracks.csv, with colours, and camera centres and points of reconstruction.json beside it where that is
// there.
bool is_opensfm_tracks(const std::string &path);
Reconstruction read_opensfm(const std::string &tracks);

// Bundler's .out, and beside it the list of its images, a name a line: list.txt, or a name that ends in .list.txt.
bool is_bundler(const std::string &path);
Reconstruction read_bundler(const std::string &path);

// AliceVision's .sfm and OpenMVG's sfm_data.json, both with structure.
bool is_alicevision(const std::string &path);
Reconstruction read_alicevision(const std::string &path);
bool is_openmvg(const std::string &path);
Reconstruction read_openmvg(const std::string &path);

}  // namespace lensprof
