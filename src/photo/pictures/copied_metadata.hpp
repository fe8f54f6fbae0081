// What a copy of a picture keeps of its metadata.
#pragma once

#include "photo/pictures/picture_blocks.hpp"
#include "photo/pictures/xmp_packet.hpp"

namespace lensprof {

// Adds the EXIF of the source to that of a copy, whose fields of the same tags it replaces: without thumbnails, sizes,
// what describes how pixels are stored, and, of a raw file, what describes its mosaic.
void copy_exif(const PictureBlocks &source, bool from_raw, PictureBlocks &copy);

// Edits the XMP of the source for a copy: removes thumbnails and, unless the copy keeps them, references to other parts
// of the file. Size and format are those of the copy.
void edit_copied_xmp(bool keeps_parts, const PictureBlocks &copy, Xmp &xmp);

// Removes references to a gain map from the maker note.
void remove_gain_map(Exif &exif);

}  // namespace lensprof
