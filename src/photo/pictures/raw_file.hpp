// A camera raw file through LibRaw: private to picture_raw.cpp and raw_*.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lensprof {

namespace codec {

// Colour data for a linear DNG of the picture.
struct RawColour {
    float xyz_to_camera[3][3] = {};        // one row per camera channel; all 0 = unknown
    float as_shot_neutral[3] = {1, 1, 1};  // camera channels of white, the largest 1
    std::string model;                     // maker and model
};

// The sensor values as linear light: (v - black) / (white - black), 0..65535 from black to white, with the black level
// of each channel, of the masked borders, or of the repeating pattern of the file. Saturated samples are 65535, and no
// others.
class RawFile {
public:
    // Identifies the file without decoding pixels. Failure names its kind and the next step.
    RawFile(const std::string &path, const std::string &kind);
    ~RawFile();
    RawFile(const RawFile &) = delete;
    RawFile &operator=(const RawFile &) = delete;

    uint32_t width() const;  // of the visible area, unrotated
    uint32_t height() const;
    bool is_mosaic() const;        // one channel per pixel
    uint32_t channels() const;     // of the picture: 1 or 3
    uint32_t orientation() const;  // EXIF orientation from the flip of the file

    void unpack();  // decodes and linearises; 2 bytes per pixel of a mosaic, 6 or 8 of others

    // Call after unpack(). A row of a mosaic halved in both directions: per channel the mean of its samples in the 2 x
    // 2 cell, else in the surrounding 4 x 4 (X-Trans has cells without red or blue). 65535 if one of them is saturated.
    void halved_row(uint32_t y, uint16_t *rgb) const;

    // Call after unpack(). LibRaw interpolates the missing channels of a mosaic (AHD; X-Trans: Markesteijn) in camera
    // colours; existing samples stay. Then full_row() returns rows. 8 bytes per pixel.
    void demosaic();
    void full_row(uint32_t y, uint16_t *samples) const;

    RawColour colour() const;

private:
    struct Decoder;
    void check_kind() const;
    void check_size() const;
    void check(int status) const;
    uint32_t channel_at(int x, int y) const;  // of the mosaic: 0 red, 1 green, 2 blue

    // Mean of a channel's samples in a square; 65535 if one is saturated.
    uint16_t mean_of(int x0, int y0, int side, uint32_t channel) const;

    void decode();
    void make_linear();
    void make_linear_mosaic();
    void make_linear_pixels();

    std::string path_, kind_;
    std::unique_ptr<Decoder> decoder_;
};

// Bytes of the largest embedded JPEG; Failure if not found.
std::vector<uint8_t> raw_preview_bytes(const std::string &path, const std::string &kind);

}  // namespace codec

}  // namespace lensprof
