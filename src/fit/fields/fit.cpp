#include "fit/fields/fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fit/base/parallel.hpp"
#include "fit/base/quantile.hpp"
#include "fit/fields/dark.hpp"
#include "fit/fields/heldout.hpp"
#include "fit/problem/linear.hpp"

namespace lensprof {
namespace {

constexpr double kFewestCells = 0.5;                             // of its cells that a picture must have
constexpr double kOneStep = 1e-3;                                // of the range: smaller values than this have no light
constexpr float kLeastShading = 0.001f, kMostShading = 1000.0f;  // of a gain grid
constexpr size_t kFewest = 2;                                    // pictures that a fit needs

enum class Kind {
    usable,
    black,
    white
};

Kind kind_of(const FieldPicture &picture, int channels, size_t cells) {
    for (int c = 0; c < channels; c++) {
        std::vector<float> values = finite_of(picture.cells.value[static_cast<size_t>(c)]);
        if (static_cast<double>(values.size()) < kFewestCells * static_cast<double>(cells)) return Kind::white;
        if (!(picture.cells.range > 0.0) || !(quantile(values, 1.0 - kOneStep) > 0.0f)) return Kind::black;
    }
    return Kind::usable;
}

// Compares the cells of two pictures: an order that does not depend on that of the pictures.
int compare(const FieldPicture &a, const FieldPicture &b) {
    for (size_t c = 0; c < 3; c++) {
        const auto &x = a.cells.value[c], &y = b.cells.value[c];
        const int order = x.empty() ? 0 : std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]);
        if (order != 0) return order;
    }
    return 0;
}

// The pictures that take part, each scene once, by rising light: groups of every k-th one then have similar levels.
std::vector<uint32_t> pictures_used(FieldsFit &fit) {
    lensprof_fields_result &r = fit.result;
    std::vector<std::pair<float, uint32_t>> order;
    for (uint32_t i = 0; i < fit.pictures.size(); i++) {
        FieldPicture &picture = fit.pictures[i];
        picture.used = false, picture.same_as = i, picture.level = {NAN, NAN, NAN};
        const Kind kind = kind_of(picture, static_cast<int>(fit.options.channels), fit.grid.count());
        r.black += kind == Kind::black, r.white += kind == Kind::white;
        if (kind != Kind::usable) continue;
        std::vector<float> values = finite_of(picture.cells.value[0]);
        order.emplace_back(median(values), i);
    }
    std::sort(order.begin(), order.end(), [&](const auto &a, const auto &b) {
        if (a.first != b.first) return a.first < b.first;
        const int cells = compare(fit.pictures[a.second], fit.pictures[b.second]);
        return cells != 0 ? cells < 0 : a.second < b.second;
    });
    std::vector<uint32_t> used;
    for (const auto &[level, i] : order) {
        if (!used.empty() && compare(fit.pictures[used.back()], fit.pictures[i]) == 0) {
            fit.pictures[i].same_as = used.back(), r.repeated++;
            continue;
        }
        fit.pictures[i].used = true, r.white_share += fit.pictures[i].cells.white_share;
        used.push_back(i);
    }
    r.used = static_cast<uint32_t>(used.size());
    r.white_share /= std::max<double>(r.used, 1.0);
    return used;
}

void leave_out_dark(FieldsFit &fit, std::vector<uint32_t> &used) {
    const std::vector<uint32_t> dark = dark_pictures(fit, used);
    for (const uint32_t i : dark) fit.pictures[i].used = false;
    used.erase(std::remove_if(used.begin(), used.end(), [&](uint32_t i) { return !fit.pictures[i].used; }), used.end());
    fit.result.black += static_cast<uint32_t>(dark.size()), fit.result.used = static_cast<uint32_t>(used.size());
}

FieldData data_of(const FieldsFit &fit, const std::vector<uint32_t> &used, size_t channel) {
    FieldData data;
    data.pictures = used.size(), data.cells = fit.grid.count();
    for (uint32_t i : used) {
        const auto &cells = fit.pictures[i].cells.value[channel];
        data.value.insert(data.value.end(), cells.begin(), cells.end());
    }
    return data;
}

// The nodes of a channel of the grid, 1 in the middle of the frame; returns ln S there.
double set_nodes(const FieldsFit &fit, const Shading &shading, uint32_t channel, lensprof_gain_grid &grid) {
    const uint32_t nodes = grid.columns * grid.rows;
    float *const first = grid.attenuation + channel * nodes;
    for (uint32_t i = 0; i < nodes; i++) first[i] = static_cast<float>(std::exp(shading.nodes[i]));
    const uint32_t width = fit.grid.width, height = fit.grid.height;
    const double middle =
        lensprof_gain_grid_eval(&grid, width, height, 0.5 * (width - 1.0), 0.5 * (height - 1.0), channel);
    for (uint32_t i = 0; i < nodes; i++)
        first[i] = std::clamp(first[i] / static_cast<float>(middle), kLeastShading, kMostShading);
    return std::log(middle);
}

lensprof_fields_channel channel_of(const Shading &shading) {
    lensprof_fields_channel channel{};
    channel.offset = shading.offset, channel.offset_sigma = shading.offset_sigma;
    channel.offset_found = shading.is_offset_found;
    channel.smoothness = static_cast<uint32_t>(shading.smoothness_index);
    channel.shading_error = shading.error;
    channel.heldout_rms = shading.heldout_rms, channel.even_rms = shading.even_rms;
    channel.pattern = shading.pattern, channel.pattern_share = shading.pattern_share;
    channel.background_share = shading.background_share, channel.background_sigma = shading.content_sigma;
    channel.iterations = shading.iterations, channel.converged = shading.converged;
    return channel;
}

}  // namespace

bool is_linear(const FieldsFit &fit) {
    return are_linear(fit.options.response ? fit.response.data() : nullptr, fit.options.responses);
}

namespace {

void fit_channels(FieldsFit &fit, const std::vector<uint32_t> &used) {
    const lensprof_fields_options &o = fit.options;
    lensprof_fields_result &r = fit.result;
    const Surface surface(fit.grid);
    r.shading.columns = surface.columns(), r.shading.rows = surface.rows(), r.shading.channels = o.channels;
    double done = 0.0, fraction = 0.0;
    for (uint32_t c = 0; c < o.channels; c++) {
        const FieldStep step = [&] {
            done += 1.0;
            fraction = std::max(fraction, std::min(done / kFieldSteps, c + 1.0) / o.channels);
            return o.progress && o.progress(fraction, o.progress_user) != 0;
        };
        const FieldData data = data_of(fit, used, c);
        const std::optional<double> offset = o.given_offset    ? std::optional<double>(o.offset[c])
                                             : !is_linear(fit) ? std::optional<double>(0.0)  // encoded: no pedestal
                                                               : std::nullopt;
        const Shading shading = fit_shading(data, surface, offset, o.threads, step);
        const double middle = set_nodes(fit, shading, c, r.shading);
        for (size_t i = 0; i < used.size(); i++) fit.pictures[used[i]].level[c] = std::exp(shading.level[i] + middle);
        r.channel[c] = channel_of(shading);
        fit.heldout[c] = shading.heldout;
        const auto unseen = static_cast<double>(std::count(shading.seen.begin(), shading.seen.end(), 0.0));
        r.unseen_share = std::max(r.unseen_share, unseen / static_cast<double>(fit.grid.count()));
        done = std::max(done, (c + 1.0) * kFieldSteps);
    }
}

}  // namespace

bool fit_fields(FieldsFit &fit) {
    lensprof_fields_result &r = fit.result;
    fit.is_fitted = false;
    lensprof_fields_result_init(&r);
    r.images = static_cast<uint32_t>(fit.pictures.size());
    r.channels = fit.options.channels;
    r.columns = static_cast<uint32_t>(fit.grid.columns), r.rows = static_cast<uint32_t>(fit.grid.rows);
    r.smoothnesses = kSmoothnesses;
    std::vector<uint32_t> used = pictures_used(fit);
    leave_out_dark(fit, used);
    if (used.empty()) return false;
    for (auto &heldout : fit.heldout) heldout.assign(kSmoothnesses, NAN);
    if (used.size() >= kFewest) fit_channels(fit, used);
    judge_fields(fit);
    fit.is_fitted = true;
    return true;
}

}  // namespace lensprof
