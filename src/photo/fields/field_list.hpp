// The pictures of fields: every page of every file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

struct FieldPage {
    std::string file;
    uint32_t page = 0;    // ReadOptions::page
    uint64_t offset = 0;  // ReadOptions::page_offset
    std::string name;     // of the file, with the number of the page if it has several, counted from 1
};

struct FieldList {
    std::vector<FieldPage> pages;
    std::vector<std::string> left_out;  // files and pages that cannot be read: messages that name them
    size_t files = 0;                   // with pages
    PictureMetadata metadata;           // of the first of them
};

// `names`: files, and folders of them, without `dark_files`. `channel`: of stacks with several, counted from 1; 0: not
// given. Failure if a stack has several channels and none is given, or not that one, if there is no picture, and if
// there are more than LENSPROF_FIELDS_IMAGES.
FieldList field_list(const std::vector<std::string> &names, const std::vector<std::string> &dark_files,
                     uint32_t channel, Events &events);

}  // namespace lensprof
