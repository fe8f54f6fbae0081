#include "photo/pictures/sheet_text.hpp"

namespace lensprof {

void draw_texts(Picture &, uint32_t, const std::vector<SheetText> &) {}

}  // namespace lensprof
