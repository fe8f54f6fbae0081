// What the readers and the writer of Lensfun databases share.
#pragma once

#include <string>
#include <string_view>

#include "formats/text/xml.hpp"

namespace lensprof {

constexpr double kLensfunInfinityM = 1000.0;  // what calibrate.py writes for pictures taken at infinity
constexpr double kLensfunAspectRatio = 1.5;   // of lenses without one; profiles do not store that of their frame

constexpr const char *kLensfunRemark = " written by lensprof ";  // whose data are not of Lensfun's database

// Whose data a file holds, with their licence; empty for those that lensprof wrote.
const char *lensfun_origin(std::string_view text);

// Throws UNSUPPORTED for a version that is not known, SYNTAX for none.
void check_lensfun_version(const XmlText &xml);

// Text of the child with this name: that without a language, else the English one, else the first.
std::string lensfun_text(const pugi::xml_node &parent, const char *name);

// Maker and model of a <lens>, as profiles call it; empty without a model.
std::string lensfun_lens_name(const pugi::xml_node &lens);

// Mounts of cameras whose lens cannot be changed begin with a small letter.
bool is_fixed_mount(const std::string &mount);

}  // namespace lensprof
