// The texts of a contact sheet, drawn by cairo; without it, sheets stay without texts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

constexpr double sheet_text_size = 16;    // px
constexpr uint8_t sheet_background = 40;  // of 255

struct SheetText {
    double left, baseline;  // px
    double widest;          // px: the middle of a longer text is omitted
    std::string text;
};

// In the upper `height` rows of a band, 8 bit RGB, which have the background.
void draw_texts(Picture &band, uint32_t height, const std::vector<SheetText> &texts);

}  // namespace lensprof
