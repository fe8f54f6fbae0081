// The pictures that a call names: files, and folders of them.
#pragma once

#include <string>
#include <vector>

namespace lensprof {

struct NamedPicture {
    std::string file;
    std::string subfolder;   // of a folder that was named, "a/b"; empty where the picture is right in it, or was named
    bool in_folder = false;  // found in a folder, not named itself
};

// Names as they are, and in the place of a folder's all pictures in it and its subfolders by their names' ends (.jpg,
// .jpeg, .png, .tif, .tiff), in the order of the alphabet, without hidden ones. Links are followed, but every folder is
// entered once, and `output`, where it is a subfolder, not at all. Failure (usage) for a folder without pictures.
std::vector<NamedPicture> named_pictures(const std::vector<std::string> &names, const std::string &output);

}  // namespace lensprof
