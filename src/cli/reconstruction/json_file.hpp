// JSON of programs that reconstruct.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

namespace lensprof {

// Sorted by name, not in the order of the file: that one takes the square of the number of members to read.
using SceneJson = nlohmann::json;

// Failure (unreadable) names the file.
SceneJson read_json_file(const std::string &path);

// A member that may be a number or, as AliceVision writes them, a text of one; -1 where it is not there or neither.
int64_t whole_at(const SceneJson &object, const char *name);

// Such a number; NAN where it is neither.
double real_of(const SceneJson &value);

// A member's text, also of a whole number; empty where it is not there.
std::string text_at(const SceneJson &object, const char *name);

// Three numbers, those that are not there NAN.
std::array<double, 3> vector_at(const SceneJson &object, const char *name);

// A member that is an object, or an array; else an empty one.
const SceneJson &object_at(const SceneJson &object, const char *name);
const SceneJson &list_at(const SceneJson &object, const char *name);

}  // namespace lensprof
