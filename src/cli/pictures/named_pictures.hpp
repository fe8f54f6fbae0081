// The pictures that a call names: files, and folders of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/program/run.hpp"

namespace lensprof {

struct NamedPicture {
    std::string file;
    std::string subfolder;   // of a folder that was named, "a/b"; empty where the picture is right in it, or was named
    bool in_folder = false;  // found in a folder, not named itself
    std::vector<std::string> instead_of = {};  // of the same name but its end, in the same folder: left out
};

// A subfolder that cannot be listed, and why.
struct UnlistedFolder {
    std::string folder, reason;
};

// Names as they are, and in the place of a folder's all pictures in it and its subfolders by their names' ends
// (is_picture_name), in the order of the alphabet, without hidden ones. Links are followed, but every folder is entered
// once, and `output`, where it is a subfolder, not at all. Failure (usage) for a folder without pictures. Of a camera
// raw file and rendered ones of its name (IMG_1.NEF, IMG_1.JPG) in a folder the raw file is taken where the program
// reads such files, since its values are linear and the camera has corrected nothing, else the rendered ones. A
// subfolder that cannot be listed goes to `unlisted`, where that is not NULL, else it is a Failure (unreadable).
std::vector<NamedPicture> named_pictures(const std::vector<std::string> &names, const std::string &output,
                                         std::vector<UnlistedFolder> *unlisted = nullptr);

// File of the records that calibrate keeps in the folder of its outputs.
constexpr const char *calibrate_records = ".lensprof-calibrate.json";

// Takes out, and returns, the pictures that lie in a subfolder for which is_output(folder) holds, or below one. Every
// folder is asked once; those that were named are not.
std::vector<NamedPicture> take_out_below(std::vector<NamedPicture> &pictures,
                                         const std::function<bool(const std::string &)> &is_output);

// States which one of such a pair is taken, and why.
void note_instead(const NamedPicture &picture, Streams &streams);

// Failure (usage) where camera raw files are among others: their values are no part of one response, and their falloff
// may have been corrected. Files that are not there are passed over.
void demand_one_kind(const std::vector<std::string> &files);

}  // namespace lensprof
