// Shots: the exposures of one pose, merged into one picture of the light, and the area of the card in it.
#pragma once

#include <array>
#include <vector>

#include "fit/flat/cells.hpp"

namespace lensprof {

// The light received by one cell, on the scale of exposure 0 EV.
struct CellLight {
    CellState state = CellState::masked;  // white or black: in every exposure
    float low_share = 0.0f;               // share of pixels far darker than the rest
    double x = 0.0, y = 0.0;              // centre of these pixels, px of the frame
    std::array<double, 3> value{};        // E; if white, that of the limit; if black, of the mean
    std::array<double, 3> variance{};     // of E, from the noise of its pixels
};

struct Shot {
    uint32_t number = 0;           // the caller's number
    double turn = 0.0;             // radians
    std::vector<uint32_t> images;  // in order of exposure, the lowest first
    std::vector<CellLight> light;  // per cell
    std::vector<bool> card;        // cells on the card
};

// Groups the pictures into shots, in the order of their first pictures.
std::vector<Shot> group_shots(const lensprof_flat_image *images, uint32_t count);

// The response per channel; a straight line if none is given.
class Responses {
public:
    explicit Responses(const lensprof_flat_options &options);
    double invert(int channel, double grey, double *slope) const;

private:
    const lensprof_response *given_;
    uint32_t count_;
    lensprof_response linear_;
};

// E = sum w g(B)/t / sum w (Goldman & Chen, section 6.1). w is the inverse variance of g(B)/t, times a factor that
// falls to 0 at the black and the white limit.
void merge_exposures(const lensprof_flat_options &options, const lensprof_flat_image *images,
                     const std::vector<CellPicture> &pictures, const Responses &responses, Shot &shot);

// Difference of every picture's light from that of the other pictures of its shot, EV: median over its cells; 0 without
// other pictures. One value per picture of the shot.
std::vector<double> exposure_residuals(const lensprof_flat_options &options, const lensprof_flat_image *images,
                                       const std::vector<CellPicture> &pictures, const Responses &responses,
                                       const Shot &shot);

// Marks the cells of the card: all cells with data or, with `find`, the largest even region among the bright cells,
// without its rim.
void mark_card(const CellGrid &grid, bool find, int channels, Shot &shot);

// Groups of connected cells (4 neighbours), each in ascending order; `joins` decides whether two neighbours belong
// together.
template <class Joins>
std::vector<std::vector<int>> connected_cells(const CellGrid &grid, const std::vector<bool> &member, Joins joins) {
    std::vector<std::vector<int>> groups;
    std::vector<bool> seen(member.size());
    for (int start = 0; start < grid.count(); start++) {
        if (!member[static_cast<size_t>(start)] || seen[static_cast<size_t>(start)]) continue;
        std::vector<int> group{start};
        seen[static_cast<size_t>(start)] = true;
        for (size_t i = 0; i < group.size(); i++) {
            int cell = group[i], column = cell % grid.columns, row = cell / grid.columns;
            const int adjacent[4] = {column > 0 ? cell - 1 : -1, column + 1 < grid.columns ? cell + 1 : -1,
                                     row > 0 ? cell - grid.columns : -1,
                                     row + 1 < grid.rows ? cell + grid.columns : -1};
            for (int other : adjacent)
                if (other >= 0 && member[static_cast<size_t>(other)] && !seen[static_cast<size_t>(other)]
                    && joins(cell, other)) {
                    seen[static_cast<size_t>(other)] = true;
                    group.push_back(other);
                }
        }
        groups.push_back(std::move(group));
    }
    return groups;
}

}  // namespace lensprof
