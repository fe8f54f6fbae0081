// A camera raw file through LibRaw: private to picture_raw.cpp and raw_*.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lensprof {

namespace codec {

// What a linear DNG of the picture must state about its colours.
struct RawColour {
    float xyz_to_camera[3][3] = {};        // rows of the camera's channels; all 0 = not known
    float as_shot_neutral[3] = {1, 1, 1};  // the camera's channels for white, the largest 1
    std::string model;                     // maker and model
};

// The picture's sensor values, made linear light: (v - black) / (white - black), 0..65535 from black to white, by the
// black level of each channel, of the masked borders, or of the repeating pattern that the file has. What is saturated
// is 65535, and nothing else is.
class RawFile {
public:
    // Identifies the file and decodes no pixels. Failure names what it is and the next step.
    RawFile(const std::string &path, const std::string &kind);
    ~RawFile();
    RawFile(const RawFile &) = delete;
    RawFile &operator=(const RawFile &) = delete;

    uint32_t width() const;  // of the visible area, unturned
    uint32_t height() const;
    bool is_mosaic() const;        // one channel a pixel
    uint32_t channels() const;     // of the picture: 1 or 3
    uint32_t orientation() const;  // EXIF's, by the file's flip

    void unpack();  // decodes and makes linear; 2 bytes a pixel of a mosaic, 6 or 8 of others

    // After unpack(). A row of a mosaic halved in both directions: of every channel the mean of its samples in the 2 x
    // 2 cell, else in the 4 x 4 about it (X-Trans has cells without red or blue). 65535 where one of them is saturated.
    void halved_row(uint32_t y, uint16_t *rgb) const;

    // After unpack(). LibRaw interpolates the missing channels of a mosaic (AHD; X-Trans: Markesteijn), in the camera's
    // own colours; the samples that are there stay. Then full_row() gives rows. 8 bytes a pixel.
    void demosaic();
    void full_row(uint32_t y, uint16_t *samples) const;

    RawColour colour() const;

private:
    struct Decoder;
    void refuse_odd_kinds() const;
    void check_size() const;
    void check(int status) const;
    uint32_t channel_at(int x, int y) const;  // of the mosaic: 0 red, 1 green, 2 blue

    // Of the samples of a channel in a square; 65535 where one is saturated.
    uint16_t mean_of(int x0, int y0, int side, uint32_t channel) const;

    void decode();
    void make_linear();
    void make_linear_mosaic();
    void make_linear_pixels();

    std::string path_, kind_;
    std::unique_ptr<Decoder> decoder_;
};

// Bytes of the largest embedded JPEG; Failure where there is none.
std::vector<uint8_t> raw_preview_bytes(const std::string &path, const std::string &kind);

}  // namespace codec

}  // namespace lensprof
