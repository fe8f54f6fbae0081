#include "photo/pictures/even_light.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "photo/pictures/picture.hpp"
#include "photo/pictures/thumbnail.hpp"

namespace lensprof {
namespace {

constexpr uint32_t cells_along = 24, read_side = 240;  // of the longer side
constexpr double largest_bend = 0.05;  // second difference of neighbouring cells, share of their value: falloffs of up
                                       // to three stops have less, and photographs ten times as much
constexpr double share_of_cells = 0.9;

void add_bend(double a, double b, double c, std::vector<double> &bends) {
    bends.push_back(std::fabs(a - 2.0 * b + c) / (2.0 * std::max(b, 1.0)));
}

}  // namespace

bool shows_even_light(const std::string &file) {
    ReadOptions read;
    read.max_side = read_side;
    return shows_even_light(read_picture(file, read));
}

bool shows_even_light(const Picture &picture) {
    const Picture cells = upright_copy(picture, 1, cells_along);  // 8 bit RGB
    if (std::min(cells.width, cells.height) < 8) return false;
    const auto value = [&](uint32_t x, uint32_t y) {
        return double(cells.pixels[y * cells.row_bytes + size_t(3) * x + 1]);
    };
    std::vector<double> bends;
    for (uint32_t y = 1; y + 1 < cells.height; y++)
        for (uint32_t x = 1; x + 1 < cells.width; x++) {
            add_bend(value(x - 1, y), value(x, y), value(x + 1, y), bends);
            add_bend(value(x, y - 1), value(x, y), value(x, y + 1), bends);
        }
    const auto at = bends.begin() + static_cast<std::ptrdiff_t>(share_of_cells * static_cast<double>(bends.size() - 1));
    std::nth_element(bends.begin(), at, bends.end());
    return *at < largest_bend;
}

}  // namespace lensprof
