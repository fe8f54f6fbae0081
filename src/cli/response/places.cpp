#include "cli/response/places.hpp"

#include <algorithm>
#include <cmath>

#include "cli/program/error.hpp"
#include "cli/program/format.hpp"
#include "cli/program/interrupt.hpp"

namespace lensprof {
namespace {

constexpr double squares_across = 240.0;  // on the longer side, if the picture has 4 px for each
constexpr uint32_t min_square = 4;        // px
constexpr int level_bins = 24;
constexpr size_t max_per_bin = 1200;  // places
constexpr double min_agreement = 0.4, min_texture = 0.02;
constexpr uint8_t first_white = 254;   // JPEG rings at the edge of white
constexpr float max_chroma = 0.7f;     // beyond it, a channel may have been clipped at 0 by the colour conversion
constexpr float max_roughness = 1.0f;  // range of the raw green over its mean
constexpr double last_grey = 250.0, min_grey = 1.5;  // means of a square

// A square that is not left out so far.
struct Candidate {
    Place place;
    uint32_t column, row;
};

// The area of the raw frame covered by a square.
struct RawPart {
    double mean[3] = {0, 0, 0};
    double lowest = 1e9, highest = 0.0;  // of green
    bool is_inside = true, is_saturated = false;
};

struct Grid {
    uint32_t side, columns, rows;
};

Grid grid_of(const Picture &rendered) {
    const uint32_t longer = std::max(rendered.width, rendered.height);
    const uint32_t side = std::max(min_square, static_cast<uint32_t>(std::lround(longer / squares_across)));
    return {side, rendered.width / side, rendered.height / side};
}

// Bilinear, at (x, y) px of the stored picture.
void add_sample(const Picture &raw, uint32_t channels, double x, double y, RawPart &part) {
    if (!(x >= 0.0 && y >= 0.0 && x <= raw.width - 1.0 && y <= raw.height - 1.0)) {
        part.is_inside = false;
        return;
    }
    const auto i = std::min(static_cast<uint32_t>(x), raw.width - 2),
               j = std::min(static_cast<uint32_t>(y), raw.height - 2);
    const double u = x - i, v = y - j;
    const auto *upper = reinterpret_cast<const uint16_t *>(raw.pixels.data() + j * raw.row_bytes) + i * channels;
    const auto *lower = reinterpret_cast<const uint16_t *>(raw.pixels.data() + (j + 1) * raw.row_bytes) + i * channels;
    for (uint32_t c = 0; c < channels; c++) {
        const uint16_t corner[4] = {upper[c], upper[c + channels], lower[c], lower[c + channels]};
        part.is_saturated |= *std::max_element(corner, corner + 4) == 65535;
        const double value =
            (corner[0] * (1 - u) + corner[1] * u) * (1 - v) + (corner[2] * (1 - u) + corner[3] * u) * v;
        part.mean[c] += value / 65535.0;
        if (c == channels / 2) part.lowest = std::min(part.lowest, value), part.highest = std::max(part.highest, value);
    }
}

class Sampler {
public:
    Sampler(const Picture &raw, const Picture &rendered, const Alignment &alignment, uint32_t channels)
        : raw_(raw), rendered_(rendered), alignment_(alignment), channels_(channels), grid_(grid_of(rendered)) {
        rho_ = 0.5 * std::hypot(rendered.width, rendered.height);
        raw_rho_ = 0.5 * std::hypot(raw.width, raw.height);
        const double cells = grid_.side * alignment.scale * raw_rho_ / rho_;  // of the raw frame, across a square
        steps_ = std::clamp(static_cast<int>(std::ceil(cells)), 2, 16);
    }

    const Grid &grid() const { return grid_; }

    // An area, or nothing, counting the reasons.
    bool take(uint32_t column, uint32_t row, PlacesOf &counts, Candidate &out) {
        out.column = column_ = column, out.row = row_ = row;
        if (!read_rendered(out.place, counts)) return false;
        return read_raw(out, counts);
    }

private:
    bool read_rendered(Place &place, PlacesOf &counts) const {
        const size_t step = rendered_.layout == LENSPROF_LAYOUT_GREY ? 1 : 3;
        bool any = false, black = false;
        for (uint32_t c = 0; c < 3; c++) {
            const size_t channel = std::min<size_t>(c, step - 1);
            uint32_t sum = 0;
            uint8_t lowest = 255, highest = 0;
            for (uint32_t y = row_ * grid_.side; y < (row_ + 1) * grid_.side; y++) {
                const uint8_t *sample = rendered_.pixels.data() + y * rendered_.row_bytes + channel;
                for (uint32_t x = column_ * grid_.side; x < (column_ + 1) * grid_.side; x++) {
                    const uint8_t v = sample[x * step];
                    sum += v, lowest = std::min(lowest, v), highest = std::max(highest, v);
                }
            }
            const double mean = double(sum) / (grid_.side * grid_.side);
            place.grey_value[c] = static_cast<float>(mean / 255.0);
            const bool is_grey = mean <= last_grey && highest < first_white && mean >= min_grey && lowest > 0;
            place.use[c] = is_grey ? Place::grey : lowest == 255 ? Place::white : Place::none;
            any |= place.use[c] != Place::none;
            black |= mean < min_grey || lowest == 0;
        }
        if (!any) (black ? counts.black : counts.white)++;
        const auto ends = std::minmax_element(place.grey_value.begin(), place.grey_value.end());
        place.chroma = *ends.second > 0.0f ? 1.0f - *ends.first / *ends.second : 0.0f;
        if (place.chroma > max_chroma) counts.colourful++;
        return any && place.chroma <= max_chroma;
    }

    bool read_raw(Candidate &out, PlacesOf &counts) const {
        RawPart part;
        double place[2];
        for (int j = 0; j < steps_; j++)
            for (int i = 0; i < steps_; i++) {
                const double x = (column_ + (i + 0.5) / steps_) * grid_.side - 0.5 - 0.5 * (rendered_.width - 1.0);
                const double y = (row_ + (j + 0.5) / steps_) * grid_.side - 0.5 - 0.5 * (rendered_.height - 1.0);
                alignment_.map(x / rho_, y / rho_, place);
                add_sample(raw_, channels_, 0.5 * (raw_.width - 1.0) + raw_rho_ * place[0],
                           0.5 * (raw_.height - 1.0) + raw_rho_ * place[1], part);
            }
        if (part.is_saturated) counts.saturated++;
        if (part.is_saturated || !part.is_inside) return false;
        for (uint32_t c = 0; c < 3; c++)
            out.place.raw[c] = static_cast<float>(part.mean[std::min(c, channels_ - 1)] / (steps_ * steps_));
        const double middle[2] = {(column_ + 0.5) * grid_.side - 0.5 * rendered_.width,
                                  (row_ + 0.5) * grid_.side - 0.5 * rendered_.height};
        alignment_.map(middle[0] / rho_, middle[1] / rho_, place);
        out.place.r2 = static_cast<float>(place[0] * place[0] + place[1] * place[1]);
        out.place.across = static_cast<float>(0.5 + place[0] * raw_rho_ / raw_.width);
        out.place.down = static_cast<float>(0.5 + place[1] * raw_rho_ / raw_.height);
        out.place.roughness = static_cast<float>((part.highest - part.lowest) / (65535.0 * out.place.raw[1] + 64.0));
        return true;
    }

    const Picture &raw_, &rendered_;
    const Alignment &alignment_;
    uint32_t channels_;
    Grid grid_;
    double rho_, raw_rho_;
    int steps_;
    uint32_t column_ = 0, row_ = 0;
};

// The surroundings of a square count too: sharpening halos reach that far.
void add_surroundings(const Grid &grid, std::vector<Candidate> &candidates) {
    std::vector<float> green(size_t(grid.columns) * grid.rows, -1.0f);
    for (const Candidate &c : candidates) green[size_t(c.row) * grid.columns + c.column] = c.place.raw[1];
    for (Candidate &c : candidates) {
        float lowest = c.place.raw[1], highest = lowest;
        for (uint32_t y = std::max(c.row, 1u) - 1; y <= std::min(c.row + 1, grid.rows - 1); y++)
            for (uint32_t x = std::max(c.column, 1u) - 1; x <= std::min(c.column + 1, grid.columns - 1); x++) {
                const float v = green[size_t(y) * grid.columns + x];
                if (v < 0.0f) continue;
                lowest = std::min(lowest, v), highest = std::max(highest, v);
            }
        c.place.roughness = std::max(c.place.roughness, (highest - lowest) / (c.place.raw[1] + 0.001f));
    }
}

// Keeps the smoothest half of every grey level, up to a maximum.
std::vector<Place> smoothest(std::vector<Candidate> &candidates, uint32_t &rough) {
    std::vector<std::vector<const Candidate *>> bins(level_bins);
    for (const Candidate &c : candidates) {
        if (c.place.roughness > max_roughness) {
            rough++;
            continue;
        }
        bins[static_cast<size_t>(std::min(c.place.grey_value[1], 0.999f) * level_bins)].push_back(&c);
    }
    std::vector<Place> places;
    for (auto &bin : bins) {
        const size_t keep = std::min(max_per_bin, (bin.size() + 1) / 2);
        std::stable_sort(bin.begin(), bin.end(), [](const Candidate *a, const Candidate *b) {
            return a->place.roughness < b->place.roughness;
        });
        std::vector<float> chroma;
        for (size_t i = 0; i < keep; i++) chroma.push_back(bin[i]->place.chroma);
        std::sort(chroma.begin(), chroma.end());
        for (size_t i = 0; i < keep; i++) {
            places.push_back(bin[i]->place);
            places.back().is_rougher = i >= keep / 2;
            places.back().is_more_colourful = bin[i]->place.chroma > chroma[keep / 2];
        }
        rough += static_cast<uint32_t>(bin.size() - keep);
    }
    return places;
}

// The rotation of the rendered picture: that of the frame, unless another fits clearly better.
int find_turn(const Picture &raw, const Picture &rendered) {
    const Alignment as_is = align_coarsely(raw, rendered);
    if (as_is.correlation > 0.6 || as_is.texture < min_texture) return 0;
    int best = 0;
    double min_correlation = as_is.correlation + 0.1;
    for (int quarters = 1; quarters < 4; quarters++) {
        const double correlation = align_coarsely(raw, rotated(rendered, quarters)).correlation;
        if (correlation > min_correlation) min_correlation = correlation, best = quarters;
    }
    return best;
}

void check_kinds(const Picture &raw, const Picture &rendered, const std::string &name) {
    if (std::max(rendered.width, rendered.height) < min_rendered_side)
        throw Failure(ExitCode::not_usable,
                      name
                          + format(": %u x %u px are too few to compare with the raw file (the longer side needs %u); "
                                   "give the camera's JPEG of the same picture with --jpeg",
                                   rendered.width, rendered.height, min_rendered_side),
                      LENSPROF_REASON_FEW_PAIRS);
    if (raw.layout != LENSPROF_LAYOUT_GREY && rendered.layout == LENSPROF_LAYOUT_GREY)
        throw Failure(ExitCode::not_usable,
                      name + ": is black and white, but the raw file is in colour, and the mixture of its channels is "
                             "unknown; take a picture in a colour style", LENSPROF_REASON_UNDETERMINED);
}

}  // namespace

PlacesOf places_of(const Picture &raw, Picture rendered, uint32_t picture, const std::string &name) {
    check_kinds(raw, rendered, name);
    PlacesOf found;
    found.channels = raw.layout == LENSPROF_LAYOUT_GREY ? 1 : 3;
    found.quarter_turns = find_turn(raw, rendered);
    rendered = rotated(rendered, found.quarter_turns);
    found.width = rendered.width, found.height = rendered.height;
    found.alignment = align_pictures(raw, rendered);
    if (found.alignment.texture >= min_texture && found.alignment.correlation < min_agreement)
        throw Failure(ExitCode::not_usable,
                      name
                          + format(": does not match the raw file (correlation of their structure %.2f); give the "
                                   "camera's JPEG of the same picture with --jpeg",
                                   found.alignment.correlation),
                      LENSPROF_REASON_IMAGE_GROUPS);
    Sampler sampler(raw, rendered, found.alignment, found.channels);
    const Grid grid = sampler.grid();
    found.squares = grid.columns * grid.rows;
    std::vector<Candidate> candidates;
    for (uint32_t row = 0; row < grid.rows; row++) {
        stop_if_interrupted();
        for (uint32_t column = 0; column < grid.columns; column++) {
            Candidate candidate{};
            if (!sampler.take(column, row, found, candidate)) continue;
            candidate.place.picture = picture;
            candidates.push_back(candidate);
        }
    }
    add_surroundings(grid, candidates);
    found.places = smoothest(candidates, found.rough);
    return found;
}

}  // namespace lensprof
