// Readers for files of structure-from-motion programs. All throw Failure with the file name: (unreadable) for a damaged
// file, (not_usable) if no two images share a point.
#pragma once

#include <string>

#include "photo/reconstruction/reconstruction.hpp"

namespace lensprof {

// COLMAP's database.db: points are connected sets of verified matches. is_database is true for such a file, and for a
// database that cannot be read.
bool is_colmap_database(const std::string &path);
bool is_database(const std::string &path);  // any SQLite database
Reconstruction read_colmap_database(const std::string &path);

// A folder with cameras, images and points3D, .bin or .txt.
bool is_colmap_model(const std::string &folder);
Reconstruction read_colmap_model(const std::string &folder);

// Copies the feature shapes of a model from the database it was made from. Returns false, without changes, if the
// features differ.
bool take_shapes(const std::string &database, Reconstruction &model);

// OpenSfM's tracks.csv, with colours, and camera centres and points from reconstruction.json next to it, if present.
bool is_opensfm_tracks(const std::string &path);
Reconstruction read_opensfm(const std::string &tracks);

// Bundler's .out, and next to it the list of its images, one name per line: list.txt, or a name ending in .list.txt.
bool is_bundler(const std::string &path);
Reconstruction read_bundler(const std::string &path);

// AliceVision's .sfm and OpenMVG's sfm_data.json, both with structure.
bool is_alicevision(const std::string &path);
Reconstruction read_alicevision(const std::string &path);
bool is_openmvg(const std::string &path);
Reconstruction read_openmvg(const std::string &path);

}  // namespace lensprof
