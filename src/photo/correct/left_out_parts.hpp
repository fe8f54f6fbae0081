// What corrected copies leave out of the files that they are made from.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "photo/base/events.hpp"

namespace lensprof {

// Warns once of each text, with the first file it is true of.
class LeftOutParts {
public:
    void add(const std::string &source, const std::string &target);
    void warn(Events &events) const;

private:
    struct Files {
        std::string text, first;
        size_t count;
    };
    std::vector<Files> files_;
};

}  // namespace lensprof
