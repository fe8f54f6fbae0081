// Shots: the exposures of one pose merged into one picture of light, and where the card is in it.
#pragma once

#include <array>
#include <vector>

#include "fit/flat/cells.hpp"

namespace lensprof {

// The light that fell on one cell, on the scale of exposure 0 EV.
struct Light {
    CellState state = CellState::masked;  // white or black: in every exposure
    float low_share = 0.0f;               // pixels far darker than the rest
    double x = 0.0, y = 0.0;              // where, px of the frame
    std::array<double, 3> value{};        // E; where white or black, the limit's
    std::array<double, 3> variance{};     // of E, from the noise of its pixels
};

struct Shot {
    uint32_t number = 0;           // the caller's
    double turn = 0.0;             // radians
    std::vector<uint32_t> images;  // by exposure, the least first
    std::vector<Light> light;      // of every cell
    std::vector<bool> card;        // cells of the card
};

// Shots in the order in which their first pictures come.
std::vector<Shot> group_shots(const lensprof_flat_image *images, uint32_t count);

// The response of a channel; a straight line when there is none.
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

// By how much every picture's light differs from that of the others of its shot, EV, median over its cells; 0 where
// there are none. One a picture of the shot.
std::vector<double> exposure_residuals(const lensprof_flat_options &options, const lensprof_flat_image *images,
                                       const std::vector<CellPicture> &pictures, const Responses &responses,
                                       const Shot &shot);

// Marks the cells of the card: all that hold data, or with `find` the largest even region among the bright ones,
// without its rim.
void mark_card(const CellGrid &grid, bool find, int channels, Shot &shot);

// Groups of cells that touch (4 neighbours), each in ascending order; `joins` says whether two neighbours belong
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
            const int near[4] = {column > 0 ? cell - 1 : -1, column + 1 < grid.columns ? cell + 1 : -1,
                                 row > 0 ? cell - grid.columns : -1, row + 1 < grid.rows ? cell + grid.columns : -1};
            for (int other : near)
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
