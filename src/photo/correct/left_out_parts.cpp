#include "photo/correct/left_out_parts.hpp"

#include <algorithm>

#include "photo/base/format.hpp"
#include "photo/pictures/other_parts.hpp"

namespace lensprof {

void LeftOutParts::add(const std::string &source, const std::string &target) {
    std::vector<std::string> parts;
    for (const std::string &part : other_parts(source, target).left_out)
        if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
    if (parts.empty()) return;
    const std::string text = joined(parts, ", ");
    const auto found =
        std::find_if(files_.begin(), files_.end(), [&](const Files &files) { return files.text == text; });
    if (found == files_.end())
        files_.push_back({text, source, 1});
    else
        found->count++;
}

void LeftOutParts::warn(Events &events) const {
    for (const Files &files : files_) {
        const std::string others = files.count > 1 ? " and " + std::to_string(files.count - 1) + " more" : "";
        events.warn(
            {}, files.first + others + ": left out of the copy: " + files.text + "; keep the original if you need it");
    }
}

}  // namespace lensprof
