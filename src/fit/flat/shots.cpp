#include "fit/flat/shots.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr double kOuter = 0.1;      // of the range of grey values, over which a sample's weight falls to 0 at its limit
constexpr double kCardEdge = 0.06;  // step of log E between two cells that ends the card,
constexpr double kSteepestEdge = 3.0;   // or this per half diagonal, which is steeper than a falloff
constexpr double kSmallestCard = 0.01;  // of the frame's cells
constexpr double kDarkCard = 0.5;       // of the brightest region's light: anything darker is not a white card

// Weight of a grey value by its distance from the limits, 0..1.
double trust(double grey, double black, double white) {
    double inside = std::min(grey - black, white - grey) / (white - black);
    return std::clamp(inside / kOuter, 0.0, 1.0);
}

// The light of a cell and channel in one picture.
struct Sample {
    double light = 0.0, variance = 0.0, weight = 0.0;  // weight 0: no information
};

Sample sample_of(const lensprof_flat_image &image, const CellPicture &picture, const Cell &cell, int channel,
                 const Responses &responses) {
    Sample sample;
    const auto c = static_cast<size_t>(channel);
    double grey = cell.value[c], slope, time = std::exp2(image.ev);
    if (cell.state != CellState::used) return sample;
    sample.light = responses.invert(channel, grey, &slope) / time;
    if (!(slope > 0.0) || !(sample.light > 0.0)) return sample;
    sample.variance = picture.noise[c].at(grey) * (slope / time) * (slope / time) / cell.pixels;
    sample.weight = trust(grey, image.black, image.white) / sample.variance;
    return sample;
}

// Sets the state of cells that are beyond the limits in every exposure: white in the lowest, or black in the highest.
// Of a white cell the light is that of the limit, at least; of a black one that of its mean.
void set_beyond(const lensprof_flat_image *images, const std::vector<CellPicture> &pictures, size_t cell, int channels,
                const Responses &responses, const Shot &shot, CellLight &light) {
    uint32_t least = shot.images.front(), greatest = shot.images.back();
    bool white = pictures[least].cells[cell].state == CellState::white;
    bool black = pictures[greatest].cells[cell].state == CellState::black;
    light.state = white ? CellState::white : black ? CellState::black : CellState::masked;
    if (!white && !black) return;
    const auto &image = images[white ? least : greatest];
    for (int c = 0; c < channels; c++) {
        const auto channel = static_cast<size_t>(c);
        const double mean = static_cast<double>(pictures[greatest].cells[cell].value[channel]);
        light.value[channel] = responses.invert(c, white ? image.white : mean, nullptr) / std::exp2(image.ev);
    }
}

double brightness(const CellLight &light, int channels) {
    double sum = 0.0;
    for (int c = 0; c < channels; c++) sum += std::log(std::max(light.value[static_cast<size_t>(c)], 1e-9));
    return sum / channels;
}

// Marks the cells whose neighbours all belong to the group: cells at its rim may be only partly on the card.
void mark_inside(const CellGrid &grid, const std::vector<int> &group, std::vector<bool> &card) {
    std::vector<bool> member(card.size());
    for (int cell : group) member[static_cast<size_t>(cell)] = true;
    auto is_member = [&](int column, int row) {  // the frame's border is not a rim of the card
        column = std::clamp(column, 0, grid.columns - 1), row = std::clamp(row, 0, grid.rows - 1);
        return static_cast<bool>(member[static_cast<size_t>(row * grid.columns + column)]);
    };
    for (int cell : group) {
        int column = cell % grid.columns, row = cell / grid.columns;
        bool inside = true;
        for (int dy = -1; dy <= 1; dy++)
            for (int dx = -1; dx <= 1; dx++) inside = inside && is_member(column + dx, row + dy);
        card[static_cast<size_t>(cell)] = inside;
    }
}

}  // namespace

Responses::Responses(const lensprof_flat_options &options) : given_(options.response), count_(options.responses) {
    lensprof_response_set_linear(&linear_);
}

double Responses::invert(int channel, double grey, double *slope) const {
    return lensprof_response_invert(given_ ? &given_[count_ == 3 ? channel : 0] : &linear_, grey, slope);
}

std::vector<Shot> group_shots(const lensprof_flat_image *images, uint32_t count) {
    std::vector<Shot> shots;
    for (uint32_t i = 0; i < count; i++) {
        auto entry =
            std::find_if(shots.begin(), shots.end(), [&](const Shot &s) { return s.number == images[i].shot; });
        if (entry == shots.end()) entry = shots.emplace(shots.end());
        entry->number = images[i].shot;
        entry->turn = images[i].rotation_deg * kPi / 180.0;
        entry->images.push_back(i);
    }
    for (auto &shot : shots)
        std::stable_sort(shot.images.begin(), shot.images.end(),
                         [&](uint32_t a, uint32_t b) { return images[a].ev < images[b].ev; });
    return shots;
}

void merge_exposures(const lensprof_flat_options &options, const lensprof_flat_image *images,
                     const std::vector<CellPicture> &pictures, const Responses &responses, Shot &shot) {
    const int channels = static_cast<int>(options.channels);
    shot.light.assign(pictures[shot.images.front()].cells.size(), {});
    for (size_t cell = 0; cell < shot.light.size(); cell++) {
        CellLight &light = shot.light[cell];
        bool complete = true;
        double x = 0.0, y = 0.0, all = 0.0;
        for (int c = 0; c < channels; c++) {
            double sum = 0.0, weight = 0.0, variance = 0.0;
            for (uint32_t i : shot.images) {
                Sample s = sample_of(images[i], pictures[i], pictures[i].cells[cell], c, responses);
                if (!(s.weight > 0.0)) continue;
                sum += s.weight * s.light;
                weight += s.weight;
                x += s.weight * pictures[i].cells[cell].x;
                y += s.weight * pictures[i].cells[cell].y;
                variance += s.weight * s.weight * s.variance;
                light.low_share = std::max(light.low_share, pictures[i].cells[cell].low_share);
            }
            complete = complete && weight > 0.0;
            if (!complete) break;
            all += weight;
            light.value[static_cast<size_t>(c)] = sum / weight;
            light.variance[static_cast<size_t>(c)] = variance / (weight * weight);
        }
        if (complete)
            light.state = CellState::used, light.x = x / all, light.y = y / all;
        else
            set_beyond(images, pictures, cell, channels, responses, shot, light);
    }
}

std::vector<double> exposure_residuals(const lensprof_flat_options &options, const lensprof_flat_image *images,
                                       const std::vector<CellPicture> &pictures, const Responses &responses,
                                       const Shot &shot) {
    const int channels = static_cast<int>(options.channels);
    std::vector<double> residuals;
    for (uint32_t image : shot.images) {
        std::vector<double> log_ratios;
        for (size_t cell = 0; cell < shot.light.size() && shot.images.size() > 1; cell++)
            for (int c = 0; c < channels; c++) {
                Sample sample = sample_of(images[image], pictures[image], pictures[image].cells[cell], c, responses);
                double sum = 0.0, weight = 0.0;
                for (uint32_t i : shot.images) {
                    Sample s = sample_of(images[i], pictures[i], pictures[i].cells[cell], c, responses);
                    if (i != image) sum += s.weight * s.light, weight += s.weight;
                }
                if (shot.card[cell] && sample.weight > 0.0 && weight > 0.0)
                    log_ratios.push_back(std::log2(sample.light * weight / sum));
            }
        residuals.push_back(median(log_ratios));
    }
    return residuals;
}

void mark_card(const CellGrid &grid, bool find, int channels, Shot &shot) {
    std::vector<bool> seen(shot.light.size());
    std::vector<double> bright(shot.light.size());
    for (size_t cell = 0; cell < seen.size(); cell++) {
        seen[cell] = shot.light[cell].state != CellState::masked;
        if (seen[cell]) bright[cell] = brightness(shot.light[cell], channels);
    }
    shot.card = seen;
    if (!find) return;
    double half_diagonal = lensprof_half_diagonal(grid.width, grid.height);
    double edge = std::max(kCardEdge, kSteepestEdge * std::max(grid.cell_width(), grid.cell_height()) / half_diagonal);
    auto joins = [&](int a, int b) {
        return std::abs(bright[static_cast<size_t>(a)] - bright[static_cast<size_t>(b)]) < edge;
    };
    struct Region {
        std::vector<int> cells;
        double bright;
    };
    std::vector<Region> regions;
    double brightest = -1e9;
    for (auto &group : connected_cells(grid, seen, joins)) {
        if (static_cast<double>(group.size()) < kSmallestCard * grid.count()) continue;
        std::vector<double> values;
        for (int cell : group) values.push_back(bright[static_cast<size_t>(cell)]);
        regions.push_back({group, median(values)});
        brightest = std::max(brightest, regions.back().bright);
    }
    shot.card.assign(seen.size(), false);
    const Region *card = nullptr;
    for (const Region &region : regions)
        if (region.bright > brightest + std::log(kDarkCard) && (!card || region.cells.size() > card->cells.size()))
            card = &region;
    if (card) mark_inside(grid, card->cells, shot.card);
}

}  // namespace lensprof
