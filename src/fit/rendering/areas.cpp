#include "fit/rendering/areas.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/fail.hpp"

namespace lensprof {
namespace {

constexpr double kSquaresAcross = 240.0;  // on the longer side, if the picture has 4 px for each
constexpr uint32_t kMinSquare = 4;        // px
constexpr int kLevelBins = 24;
constexpr size_t kMaxPerBin = 1200;  // areas
constexpr double kMinAgreement = 0.4, kMinTexture = 0.02;
constexpr uint8_t kFirstWhite = 254;   // JPEG rings at the edge of white
constexpr float kMaxChroma = 0.7f;     // beyond it, a channel may have been clipped at 0 by the colour conversion
constexpr float kMaxRoughness = 1.0f;  // range of the raw green over its mean
constexpr double kLastGrey = 250.0, kMinGrey = 1.5;  // means of a square

// A square that is not left out so far.
struct Candidate {
    Area area;
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

Grid grid_of(const lensprof_image &rendered) {
    const uint32_t longer = std::max(rendered.width, rendered.height);
    const uint32_t side = std::max(kMinSquare, static_cast<uint32_t>(std::lround(longer / kSquaresAcross)));
    return {side, rendered.width / side, rendered.height / side};
}

// Bilinear, at (x, y) px of the stored picture.
void add_sample(const lensprof_image &raw, uint32_t channels, double x, double y, RawPart &part) {
    if (!(x >= 0.0 && y >= 0.0 && x <= raw.width - 1.0 && y <= raw.height - 1.0)) {
        part.is_inside = false;
        return;
    }
    const auto i = std::min(static_cast<uint32_t>(x), raw.width - 2),
               j = std::min(static_cast<uint32_t>(y), raw.height - 2);
    const double u = x - i, v = y - j;
    const auto *upper =
        reinterpret_cast<const uint16_t *>(static_cast<const char *>(raw.data) + j * raw.row_bytes) + i * channels;
    const auto *lower =
        reinterpret_cast<const uint16_t *>(static_cast<const char *>(raw.data) + (j + 1) * raw.row_bytes)
        + i * channels;
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
    Sampler(const lensprof_image &raw, const lensprof_image &rendered, const Alignment &alignment, uint32_t channels)
        : raw_(raw), rendered_(rendered), alignment_(alignment), channels_(channels), grid_(grid_of(rendered)) {
        rho_ = 0.5 * std::hypot(rendered.width, rendered.height);
        raw_rho_ = 0.5 * std::hypot(raw.width, raw.height);
        const double cells = grid_.side * alignment.scale * raw_rho_ / rho_;  // of the raw frame, across a square
        steps_ = std::clamp(static_cast<int>(std::ceil(cells)), 2, 16);
    }

    const Grid &grid() const { return grid_; }

    // An area, or nothing, counting the reasons.
    bool take(uint32_t column, uint32_t row, lensprof_rendering_shot &counts, Candidate &out) {
        out.column = column_ = column, out.row = row_ = row;
        if (!read_rendered(out.area, counts)) return false;
        return read_raw(out, counts);
    }

private:
    bool read_rendered(Area &area, lensprof_rendering_shot &counts) const {
        const size_t step = rendered_.layout == LENSPROF_LAYOUT_GREY ? 1 : 3;
        bool any = false, black = false;
        for (uint32_t c = 0; c < 3; c++) {
            const size_t channel = std::min<size_t>(c, step - 1);
            uint32_t sum = 0;
            uint8_t lowest = 255, highest = 0;
            for (uint32_t y = row_ * grid_.side; y < (row_ + 1) * grid_.side; y++) {
                const uint8_t *sample =
                    static_cast<const uint8_t *>(rendered_.data) + y * rendered_.row_bytes + channel;
                for (uint32_t x = column_ * grid_.side; x < (column_ + 1) * grid_.side; x++) {
                    const uint8_t v = sample[x * step];
                    sum += v, lowest = std::min(lowest, v), highest = std::max(highest, v);
                }
            }
            const double mean = double(sum) / (grid_.side * grid_.side);
            area.grey_value[c] = static_cast<float>(mean / 255.0);
            const bool is_grey = mean <= kLastGrey && highest < kFirstWhite && mean >= kMinGrey && lowest > 0;
            area.use[c] = is_grey ? Area::grey : lowest == 255 ? Area::white : Area::none;
            any |= area.use[c] != Area::none;
            black |= mean < kMinGrey || lowest == 0;
        }
        if (!any) (black ? counts.black : counts.white)++;
        const auto ends = std::minmax_element(area.grey_value.begin(), area.grey_value.end());
        area.chroma = *ends.second > 0.0f ? 1.0f - *ends.first / *ends.second : 0.0f;
        if (area.chroma > kMaxChroma) counts.colourful++;
        return any && area.chroma <= kMaxChroma;
    }

    bool read_raw(Candidate &out, lensprof_rendering_shot &counts) const {
        RawPart part;
        double at[2];
        for (int j = 0; j < steps_; j++)
            for (int i = 0; i < steps_; i++) {
                const double x = (column_ + (i + 0.5) / steps_) * grid_.side - 0.5 - 0.5 * (rendered_.width - 1.0);
                const double y = (row_ + (j + 0.5) / steps_) * grid_.side - 0.5 - 0.5 * (rendered_.height - 1.0);
                alignment_.map(x / rho_, y / rho_, at);
                add_sample(raw_, channels_, 0.5 * (raw_.width - 1.0) + raw_rho_ * at[0],
                           0.5 * (raw_.height - 1.0) + raw_rho_ * at[1], part);
            }
        if (part.is_saturated) counts.saturated++;
        if (part.is_saturated || !part.is_inside) return false;
        for (uint32_t c = 0; c < 3; c++)
            out.area.raw[c] = static_cast<float>(part.mean[std::min(c, channels_ - 1)] / (steps_ * steps_));
        const double middle[2] = {(column_ + 0.5) * grid_.side - 0.5 * rendered_.width,
                                  (row_ + 0.5) * grid_.side - 0.5 * rendered_.height};
        alignment_.map(middle[0] / rho_, middle[1] / rho_, at);
        out.area.r2 = static_cast<float>(at[0] * at[0] + at[1] * at[1]);
        out.area.across = static_cast<float>(0.5 + at[0] * raw_rho_ / raw_.width);
        out.area.down = static_cast<float>(0.5 + at[1] * raw_rho_ / raw_.height);
        out.area.roughness = static_cast<float>((part.highest - part.lowest) / (65535.0 * out.area.raw[1] + 64.0));
        return true;
    }

    const lensprof_image &raw_, &rendered_;
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
    for (const Candidate &c : candidates) green[size_t(c.row) * grid.columns + c.column] = c.area.raw[1];
    for (Candidate &c : candidates) {
        float lowest = c.area.raw[1], highest = lowest;
        for (uint32_t y = std::max(c.row, 1u) - 1; y <= std::min(c.row + 1, grid.rows - 1); y++)
            for (uint32_t x = std::max(c.column, 1u) - 1; x <= std::min(c.column + 1, grid.columns - 1); x++) {
                const float v = green[size_t(y) * grid.columns + x];
                if (v < 0.0f) continue;
                lowest = std::min(lowest, v), highest = std::max(highest, v);
            }
        c.area.roughness = std::max(c.area.roughness, (highest - lowest) / (c.area.raw[1] + 0.001f));
    }
}

// Keeps the smoothest half of every grey level, up to a maximum.
std::vector<Area> smoothest(std::vector<Candidate> &candidates, uint32_t &rough) {
    std::vector<std::vector<const Candidate *>> bins(kLevelBins);
    for (const Candidate &c : candidates) {
        if (c.area.roughness > kMaxRoughness) {
            rough++;
            continue;
        }
        bins[static_cast<size_t>(std::min(c.area.grey_value[1], 0.999f) * kLevelBins)].push_back(&c);
    }
    std::vector<Area> areas;
    for (auto &bin : bins) {
        const size_t keep = std::min(kMaxPerBin, (bin.size() + 1) / 2);
        std::stable_sort(bin.begin(), bin.end(),
                         [](const Candidate *a, const Candidate *b) { return a->area.roughness < b->area.roughness; });
        std::vector<float> chroma;
        for (size_t i = 0; i < keep; i++) chroma.push_back(bin[i]->area.chroma);
        std::sort(chroma.begin(), chroma.end());
        for (size_t i = 0; i < keep; i++) {
            areas.push_back(bin[i]->area);
            areas.back().is_rougher = i >= keep / 2;
            areas.back().is_more_colourful = bin[i]->area.chroma > chroma[keep / 2];
        }
        rough += static_cast<uint32_t>(bin.size() - keep);
    }
    return areas;
}

// The rotation of the rendered picture: that of the frame, unless another fits clearly better.
int find_turn(const lensprof_image &raw, const lensprof_image &rendered, const Stop &stop) {
    const Alignment as_is = align_coarsely(raw, rendered, stop);
    if (as_is.correlation > 0.6 || as_is.texture < kMinTexture) return 0;
    int best = 0;
    double min_correlation = as_is.correlation + 0.1;
    for (int quarters = 1; quarters < 4; quarters++) {
        const double correlation = align_coarsely(raw, rotated(rendered, quarters).view, stop).correlation;
        if (correlation > min_correlation) min_correlation = correlation, best = quarters;
    }
    return best;
}

lensprof_status check_kinds(const lensprof_image &raw, const lensprof_image &rendered, lensprof_error *error) {
    const auto is_grey_or_rgb = [](const lensprof_image &image) {
        return image.layout == LENSPROF_LAYOUT_GREY || image.layout == LENSPROF_LAYOUT_RGB;
    };
    if (raw.sample != LENSPROF_SAMPLE_U16 || rendered.sample != LENSPROF_SAMPLE_U8 || !is_grey_or_rgb(raw)
        || !is_grey_or_rgb(rendered))
        return fail(LENSPROF_ERROR_ARGUMENT, error,
                    "rendering: the raw frame must be U16 and the rendered picture U8, both GREY or RGB");
    if (std::min(raw.width, raw.height) < LENSPROF_RENDERING_RAW_SIDE)
        return fail(LENSPROF_ERROR_SIZE, error, "rendering: a raw frame of %u x %u px is too small (at least %d)",
                    raw.width, raw.height, LENSPROF_RENDERING_RAW_SIDE);
    if (std::max(rendered.width, rendered.height) < LENSPROF_RENDERING_SIDE)
        return fail(LENSPROF_ERROR_SIZE, error,
                    "%u x %u px are too few to compare with the raw file (the longer side needs %d)", rendered.width,
                    rendered.height, LENSPROF_RENDERING_SIDE);
    if (raw.layout != LENSPROF_LAYOUT_GREY && rendered.layout == LENSPROF_LAYOUT_GREY)
        return fail(LENSPROF_ERROR_UNSUPPORTED, error,
                    "is black and white, but the raw file is in colour, and the mixture of its channels is unknown; "
                    "take a picture in a colour style");
    return LENSPROF_OK;
}

// The areas of aligned pictures that are compared.
std::vector<Candidate> find_areas(const Sampler &like, uint32_t picture, const Stop &stop,
                                  lensprof_rendering_shot &found) {
    Sampler sampler = like;
    const Grid grid = sampler.grid();
    found.squares = grid.columns * grid.rows;
    std::vector<Candidate> candidates;
    for (uint32_t row = 0; row < grid.rows; row++) {
        stop.check();
        for (uint32_t column = 0; column < grid.columns; column++) {
            Candidate candidate{};
            if (!sampler.take(column, row, found, candidate)) continue;
            candidate.area.picture = picture;
            candidates.push_back(candidate);
        }
    }
    add_surroundings(grid, candidates);
    return candidates;
}

}  // namespace

lensprof_status compare_pictures(const lensprof_image &raw, const lensprof_image &rendered, uint32_t picture,
                                 const Stop &stop, RenderedShot &shot, lensprof_error *error) {
    const lensprof_status status = check_kinds(raw, rendered, error);
    if (status != LENSPROF_OK) return status;
    lensprof_rendering_shot &found = shot.found;
    lensprof_rendering_shot_init(&found);
    found.channels = raw.layout == LENSPROF_LAYOUT_GREY ? 1 : 3;
    found.quarter_turns = static_cast<uint32_t>(find_turn(raw, rendered, stop));
    const RotatedImage upright = rotated(rendered, static_cast<int>(found.quarter_turns));
    found.width = upright.view.width, found.height = upright.view.height;
    const Alignment alignment = align_pictures(raw, upright.view, stop);
    std::copy_n(alignment.shift, 2, found.shift);
    found.scale = alignment.scale, found.k1 = alignment.k1, found.k2 = alignment.k2;
    found.correlation = alignment.correlation, found.texture = alignment.texture;
    if (found.texture >= kMinTexture && found.correlation < kMinAgreement)
        return fail(LENSPROF_ERROR_NO_OVERLAP, error,
                    "does not match the raw file (correlation of their structure %.2f)", found.correlation);
    std::vector<Candidate> candidates =
        find_areas(Sampler(raw, upright.view, alignment, found.channels), picture, stop, found);
    shot.areas = smoothest(candidates, found.rough);
    return LENSPROF_OK;
}

}  // namespace lensprof
