// Tags of TIFF 6.0, TIFF/EP and DNG by which files are walked.
#pragma once

#include <cstdint>

namespace lensprof {

constexpr uint16_t tag_subfile_type = 254, tag_width = 256, tag_height = 257, tag_compression = 259,
                   tag_photometric = 262, tag_make = 271, tag_strip_offsets = 273, tag_samples = 277,
                   tag_rows_per_strip = 278, tag_strip_bytes = 279, tag_tile_width = 322, tag_tile_height = 323,
                   tag_tile_offsets = 324, tag_tile_bytes = 325, tag_sub_directories = 330, tag_jpeg_offset = 513,
                   tag_cfa_repeat = 33421, tag_cfa_pattern = 33422, tag_kodak_directory = 33424,
                   tag_dng_version = 50706, tag_active_area = 50829;

}  // namespace lensprof
