#include "cli/program/option_names.hpp"

#include <map>

namespace lensprof {

std::string option_of(const std::string &name) {
    static const std::map<std::string, std::string> options = {
        {"database", "--db FILE"},
        {"image_list", "--reconstruction list=FILE"},
        {"images", "--images"},
    };
    const auto found = options.find(name);
    return found == options.end() ? name : found->second;
}

}  // namespace lensprof
