// Lenses as Lensfun's database names them.
#pragma once

#include <string>

namespace lensprof {

struct LensfunName {
    std::string maker, model;
    std::string mount;  // of lenses with this name; empty where the name does not tell
};

// Of a lens as named in EXIF or in a profile, used on a camera of this maker (as in EXIF; empty = unknown).
LensfunName lensfun_name(const std::string &lens, const std::string &camera_maker);

// Mount of a lens with this name on a body: that of its name, else that of the body, which is Canon EF for lenses of
// other makers on EF-S; Generic where neither is known.
std::string lensfun_mount(const LensfunName &name, const std::string &camera_mount);

// What names that mean the same lens have in common: without case, blanks and signs, and f/4 the same as F4.0.
std::string comparable_name(const std::string &lens);

}  // namespace lensprof
