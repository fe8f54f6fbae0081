// Tags of EXIF (CIPA DC-008, chapter 4), TIFF and DNG that lensprof reads or writes.
#pragma once

#include "photo/pictures/exif_fields.hpp"

namespace lensprof {

namespace exif_tags {

constexpr ExifTag image(uint16_t tag) { return {ExifGroup::image, tag}; }
constexpr ExifTag photo(uint16_t tag) { return {ExifGroup::photo, tag}; }

constexpr ExifTag subfile_type = image(254), image_width = image(256), image_length = image(257),
                  bits_per_sample = image(258), make = image(271), model = image(272), orientation = image(274),
                  x_resolution = image(282), software = image(305), sample_format = image(339), xmp = image(700),
                  iptc = image(33723), photoshop = image(34377), colour_profile = image(34675),
                  dng_version = image(50706), black_level = image(50714), white_level = image(50717),
                  camera_serial_number = image(50735), dng_private_data = image(50740), opcode_list_2 = image(51009),
                  opcode_list_3 = image(51022);
constexpr ExifTag exposure_time = photo(0x829a), f_number = photo(0x829d), exposure_program = photo(0x8822),
                  iso_speed_ratings = photo(0x8827), sensitivity_type = photo(0x8830),
                  output_sensitivity = photo(0x8831), exposure_index = photo(0x8832), iso_speed = photo(0x8833),
                  captured = photo(0x9003), shutter_speed = photo(0x9201), aperture = photo(0x9202),
                  max_aperture = photo(0x9205), subject_distance = photo(0x9206), focal_length = photo(0x920a),
                  maker_note = photo(maker_note_tag), captured_fraction = photo(0x9291), pixel_width = photo(0xa002),
                  pixel_height = photo(0xa003), pitch_x = photo(0xa20e), pitch_y = photo(0xa20f),
                  pitch_unit = photo(0xa210), exposure_mode = photo(0xa402), focal_length_35mm = photo(0xa405),
                  body_serial_number = photo(0xa431), lens_specification = photo(0xa432), lens_model = photo(0xa434),
                  lens_serial_number = photo(0xa435);

// The same tag in the main directory, where some programs write those of the exposure.
constexpr ExifTag in_image(ExifTag tag) { return image(tag.tag); }

}  // namespace exif_tags

}  // namespace lensprof
