// The name of the lens, from EXIF, maker notes and XMP.
#pragma once

#include <string>

#include "photo/pictures/exif_fields.hpp"
#include "photo/pictures/maker_notes.hpp"
#include "photo/pictures/xmp_packet.hpp"

namespace lensprof {

struct LensName {
    std::string name;       // empty: unknown
    std::string ambiguous;  // if nothing identifies the lens: the number stated for it, the lenses that share that
                            // number, or a name of numbers alone
};

// The first of: EXIF's LensModel and Canon's own; the lens with the number in the maker notes; the names in XMP (CIPA's
// LensModel, Adobe's aux:Lens); the lens with the number in aux:LensID; a name of numbers alone ("24.0-70.0 mm f/2.8"),
// which fits many lenses. A number counts only if it means one lens, and that has the stated focal lengths.
LensName read_lens(const Exif &exif, const Xmp &xmp, const MakerNotes &notes);

}  // namespace lensprof
