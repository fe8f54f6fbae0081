// Structs that grow (lensprof/base.h): the rule of struct_size for this layer.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "photo/base/failure.hpp"

namespace lensprof {

// Bytes of a struct's first version, of which `member` was the last.
#define LENSPROF_FIRST(type, member) (offsetof(type, member) + sizeof(type::member))

// `smallest`: bytes of the struct's first version.
template <class Struct>
void check_sized(const Struct &given, size_t smallest, const char *name) {
    if (given.struct_size < smallest)
        throw Failure(LENSPROF_ERROR_STRUCT_SIZE,
                      std::string(name) + ": struct_size is not set; call the struct's _init function first");
    if (given.struct_size > sizeof(Struct))
        throw Failure(LENSPROF_ERROR_STRUCT_SIZE, std::string(name)
                                                      + ": struct_size is that of a newer lensprof than this library; "
                                                        "install the newer library");
}

// The caller's struct in the size of this library: `defaults` where it is NULL or older.
template <class Struct>
Struct taken(const Struct *given, Struct defaults, size_t smallest, const char *name) {
    if (!given) return defaults;
    check_sized(*given, smallest, name);
    const uint32_t own = defaults.struct_size;
    std::memcpy(static_cast<void *>(&defaults), given, given->struct_size);
    defaults.struct_size = own;
    return defaults;
}

// Writes a result up to the caller's size, which does not change.
template <class Struct>
void give(const Struct &from, Struct *to, size_t smallest, const char *name) {
    check_sized(*to, smallest, name);
    const uint32_t given = to->struct_size;
    std::memcpy(static_cast<void *>(to), &from, given);
    to->struct_size = given;
}

}  // namespace lensprof
