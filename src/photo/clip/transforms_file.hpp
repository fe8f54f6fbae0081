// transforms.json: frames with the poses of their camera, as nerfstudio and instant-ngp read them.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lensprof {

constexpr char transforms_name[] = "transforms.json";

struct TransformsFile {
    std::string folder;  // its own
    nlohmann::ordered_json content;
    std::vector<std::string> files;  // of the frames, in the order of `content`
    bool is_sorted = false;          // the file lists them in another order
};

// What becomes of a frame.
struct LevelledPose {
    std::string file;  // relative to the folder of the new file; empty: left out
    double removed_ev = 0.0;
};

std::string transforms_path(const std::string &folder);

// Whether the folder holds the file.
bool has_transforms(const std::string &folder);

// Reads the file of a folder. A name without an extension is that of a .png, .jpg or .jpeg. Frames of one
// folder whose names differ only in a whole number at their end are sorted by it: programs list them in any order, but
// a clip has one. Other frames, also those with decimals (t1.02), stay as listed. Failure
// (unreadable) with the file and the frame, for content that is not such a file, is nested more than 100 deep, or names
// pictures that do not exist.
TransformsFile read_transforms(const std::string &folder);

// Failure (unreadable) if the file states another size than that of the frames.
void check_stated_size(const TransformsFile &transforms, uint32_t width, uint32_t height);

// The text of a file in `folder` with the levelled frames, which get the key exposure_ev: what was removed. Names of
// masks, depths and points are those of the same files from there; everything else is unchanged.
std::string levelled_transforms(const TransformsFile &transforms, const std::string &folder,
                                const std::vector<LevelledPose> &frames);

}  // namespace lensprof
