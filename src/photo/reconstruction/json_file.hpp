// JSON files of reconstruction programs.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

namespace lensprof {

// Sorted by name, not in file order, because an ordered object takes quadratic time to read.
using SceneJson = nlohmann::json;

// Failure (unreadable) with the file name.
SceneJson read_json_file(const std::string &path);

// A member that is a number or, as AliceVision writes it, a string of one; -1 if it is missing or neither.
int64_t whole_at(const SceneJson &object, const char *name);

// The same as a real number; NAN if it is neither.
double real_of(const SceneJson &value);

// A string member, or an integer as text; empty if missing.
std::string text_at(const SceneJson &object, const char *name);

// Three numbers, NAN for missing ones.
std::array<double, 3> vector_at(const SceneJson &object, const char *name);

// A member that is an object or an array; else an empty one.
const SceneJson &object_at(const SceneJson &object, const char *name);
const SceneJson &list_at(const SceneJson &object, const char *name);

}  // namespace lensprof
