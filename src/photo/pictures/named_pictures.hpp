// The pictures named on the command line: files, and folders of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "photo/base/events.hpp"

namespace lensprof {

struct NamedPicture {
    std::string file;
    std::string subfolder;   // subfolder of a named folder, "a/b"; empty if the picture is directly in it or was named
    bool in_folder = false;  // found in a folder, not named itself
    std::vector<std::string> instead_of = {};  // files with the same base name in the same folder, left out
};

// A subfolder that cannot be listed, with the reason.
struct UnlistedFolder {
    std::string folder, reason;
};

// Replaces each folder by all pictures in it and its subfolders, identified by extension (is_picture_name), in
// alphabetical order, without hidden ones; other names stay. Links are followed, but every folder is entered only once,
// and `output`, if it is a subfolder, not at all. Failure (usage) for a folder without pictures. Of a camera raw file
// and rendered files with the same base name (IMG_1.NEF, IMG_1.JPG) in a folder, the raw file is used if the program
// can read it, because its values are linear and uncorrected; else the rendered ones. A subfolder that cannot be listed
// is added to `unlisted`, unless that is NULL; then it is a Failure (unreadable). Files in a folder that hold pictures
// of a kind that no command reads, such as videos, are left out: a line in `left_out` states each kind, their number
// and what to do.
std::vector<NamedPicture> named_pictures(const std::vector<std::string> &names, const std::string &output,
                                         std::vector<std::string> &left_out,
                                         std::vector<UnlistedFolder> *unlisted = nullptr);

// Name of the file in which calibrate keeps its records in the output folder.
constexpr const char *calibrate_records = ".lensprof-calibrate.json";

// Removes the pictures in output folders of calibrate and returns them; a note names each folder.
std::vector<NamedPicture> extract_outputs(std::vector<NamedPicture> &pictures, Events &events);

// Removes and returns the pictures in or below a subfolder for which is_output(folder) is true. Every folder is tested
// once; named folders are not tested.
std::vector<NamedPicture> extract_below(std::vector<NamedPicture> &pictures,
                                        const std::function<bool(const std::string &)> &is_output);

// Prints a note for each such pair: which file is used, and why.
void note_instead(const NamedPicture &picture, Events &events);

// Failure (usage) if camera raw files are mixed with others: their values do not share a response, and the falloff of
// the others may be corrected. Missing files are skipped.
void require_one_kind(const std::vector<std::string> &files);

}  // namespace lensprof
