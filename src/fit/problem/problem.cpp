#include "fit/problem/problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "core/response.h"
#include "fit/base/joined_sets.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/problem/tracks.hpp"

namespace lensprof {
namespace {

// Sorts the pairs by edge, so that values common to an edge are computed once and sums have a fixed order.
void find_edges(Problem &problem) {
    auto &pairs = problem.pairs;
    for (auto &pair : pairs)
        if (pair.image[0] > pair.image[1]) {
            std::swap(pair.image[0], pair.image[1]);
            for (int n = 0; n < 3; n++) std::swap(pair.value[0][n], pair.value[1][n]);
            for (int n = 0; n < 2; n++) std::swap(pair.xy[0][n], pair.xy[1][n]);
        }
    std::stable_sort(pairs.begin(), pairs.end(), [](const lensprof_pair &a, const lensprof_pair &b) {
        return a.image[0] != b.image[0] ? a.image[0] < b.image[0] : a.image[1] < b.image[1];
    });
    for (size_t p = 0; p < pairs.size(); p++) {
        const uint32_t *image = pairs[p].image;
        if (problem.edges.empty() || problem.edges.back().image[0] != image[0]
            || problem.edges.back().image[1] != image[1])
            problem.edges.push_back({{image[0], image[1]}, p, p});
        problem.edges.back().last = p + 1;
    }
}

size_t chunk_count(size_t items) {
    constexpr size_t kLargestCount = 16, kSmallestSize = 512;
    return std::clamp<size_t>(items / kSmallestSize, 1, kLargestCount);
}

void find_chunks(Problem &problem) {
    size_t pairs = problem.pairs.size(), edge = 0, count = chunk_count(pairs);
    for (size_t k = 0; k < count && pairs; k++) {
        size_t first = pairs * k / count, last = pairs * (k + 1) / count;
        while (problem.edges[edge].last <= first) edge++;
        problem.chunks.push_back({first, last, edge});
    }
}

void find_track_chunks(Problem &problem) {
    size_t tracks = problem.tracks.tracks.size(), count = chunk_count(problem.tracks.observations.size());
    for (size_t k = 0; k < count && tracks; k++)
        problem.track_chunks.push_back({tracks * k / count, tracks * (k + 1) / count});
}

void find_links(Problem &problem) {
    std::vector<std::vector<uint32_t>> above(problem.image_count);
    const auto &observations = problem.tracks.observations;
    for (const Range &track : problem.tracks.tracks)
        for (size_t i = track.first; i < track.last; i++)
            for (size_t j = i + 1; j < track.last; j++) {
                auto &list = above[observations[i].image];
                uint32_t high = observations[j].image;
                auto place = std::lower_bound(list.begin(), list.end(), high);
                if (place == list.end() || *place != high) list.insert(place, high);
            }
    for (uint32_t i = 0; i < problem.image_count; i++) {
        problem.first_link.push_back(static_cast<uint32_t>(problem.links.size()));
        for (uint32_t j : above[i]) problem.links.push_back({i, j});
    }
    problem.first_link.push_back(static_cast<uint32_t>(problem.links.size()));
}

void find_components(Problem &problem) {
    JoinedSets joined(problem.image_count);
    for (const auto &edge : problem.edges) joined.join(edge.image[0], edge.image[1]);
    problem.component = joined.all();
}

// The column of the unknown that image `owner` owns, created on first use; -1 if it is fixed.
int unknown_of(std::vector<int> &columns, uint32_t owner, bool is_free, int &count) {
    if (!is_free) return -1;
    if (columns[owner] < 0) columns[owner] = count++;
    return columns[owner];
}

// Whether every image with a free exposure has white balances that are free and not shared with another image.
bool are_channels_apart(const Problem &problem) {
    std::vector<bool> is_taken(static_cast<size_t>(problem.image_unknowns), false);
    for (uint32_t i = 0; i < problem.image_count && problem.channels == 3; i++)
        for (size_t c : {0, 2}) {
            const int balance = problem.balance_unknown[i][c];
            if (balance < 0 ? problem.ev_unknown[i] >= 0 : is_taken[static_cast<size_t>(balance)]) return false;
            if (balance >= 0) is_taken[static_cast<size_t>(balance)] = true;
        }
    return true;
}

void number_unknowns(Problem &problem) {
    std::vector<int> ev(problem.image_count, -1), red = ev, blue = ev;
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const auto &image = problem.images[i];
        auto is_free = [&](uint32_t owner, uint32_t flag) {
            bool is_reference = owner == problem.reference
                                || (flag == LENSPROF_FREE_EV    ? problem.images[problem.reference].ev_of
                                    : flag == LENSPROF_FREE_RED ? problem.images[problem.reference].red_of
                                                                : problem.images[problem.reference].blue_of)
                                       == owner;
            return !is_reference && (problem.images[owner].free & flag);
        };
        int &n = problem.image_unknowns;
        problem.ev_unknown.push_back(unknown_of(ev, image.ev_of, is_free(image.ev_of, LENSPROF_FREE_EV), n));
        std::array<int, 3> balance{-1, -1, -1};
        if (problem.channels == 3) {
            balance[0] = unknown_of(red, image.red_of, is_free(image.red_of, LENSPROF_FREE_RED), n);
            balance[2] = unknown_of(blue, image.blue_of, is_free(image.blue_of, LENSPROF_FREE_BLUE), n);
        }
        problem.balance_unknown.push_back(balance);
    }
    problem.channels_apart = are_channels_apart(problem);
}

// Numbers the settings in order of first appearance, that of the reference first.
void number_settings(Problem &problem) {
    std::map<uint32_t, int> numbers{{problem.images[problem.reference].setting, 0}};
    problem.setting_number.push_back(problem.images[problem.reference].setting);
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const auto [found, is_new] = numbers.try_emplace(problem.images[i].setting, problem.settings);
        if (is_new) problem.settings++, problem.setting_number.push_back(problem.images[i].setting);
        problem.setting_of.push_back(found->second);
    }
}

Problem empty_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count) {
    Problem problem;
    problem.channels = static_cast<int>(options.channels);
    problem.reference = options.reference;
    problem.free = options.free;
    problem.moving_camera = options.moving_camera;
    problem.images = images;
    problem.image_count = image_count;
    problem.threads = options.threads;
    number_settings(problem);
    return problem;
}

// Computes everything that depends on the pairs.
void complete(Problem &problem) {
    find_edges(problem);
    find_chunks(problem);
    find_components(problem);
    number_unknowns(problem);
}

}  // namespace

uint32_t Problem::link_of(uint32_t low, uint32_t high) const {
    auto first = links.begin() + first_link[low], last = links.begin() + first_link[low + 1];
    return static_cast<uint32_t>(std::lower_bound(first, last, std::array<uint32_t, 2>{low, high}) - links.begin());
}

std::array<int, 2> Problem::columns_of(uint32_t image, int channel) const {
    const int ev = ev_unknown[image], balance = balance_unknown[image][static_cast<size_t>(channel)];
    return {channels_apart && balance >= 0 ? -1 : ev, balance};
}

uint32_t Problem::component_count() const {
    uint32_t count = 0;
    for (uint32_t i = 0; i < image_count; i++) count += component[i] == i;
    return count;
}

uint32_t place_in_frame(const lensprof_fit_image &image, const double xy[2], int across) {
    const auto step = [&](double value, uint32_t size) {
        return static_cast<uint32_t>(std::clamp((value + 0.5) / size * across, 0.0, across - 1.0));
    };
    return step(xy[0], image.width) + static_cast<uint32_t>(across) * step(xy[1], image.height);
}

bool is_static(const Problem &problem) {
    return std::all_of(problem.pairs.begin(), problem.pairs.end(), [](const lensprof_pair &pair) {
        constexpr double kSame = 0.01;  // px
        return std::abs(pair.xy[0][0] - pair.xy[1][0]) < kSame && std::abs(pair.xy[0][1] - pair.xy[1][1]) < kSame;
    });
}

lensprof_exposure given_exposure(const lensprof_fit_image *images, uint32_t i) {
    lensprof_exposure exposure = images[i].exposure;
    exposure.ev = images[images[i].ev_of].exposure.ev;
    exposure.white_balance[0] = images[images[i].red_of].exposure.white_balance[0];
    exposure.white_balance[2] = images[images[i].blue_of].exposure.white_balance[2];
    return exposure;
}

Problem make_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                     const lensprof_pair *pairs, const std::vector<uint32_t> &keep) {
    Problem problem = empty_problem(options, images, image_count);
    problem.pairs.reserve(keep.size());
    for (uint32_t p : keep) problem.pairs.push_back(pairs[p]);
    complete(problem);
    return problem;
}

Problem make_problem(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                     const Tracks &tracks, const std::vector<uint32_t> &keep) {
    Problem problem = empty_problem(options, images, image_count);
    problem.by_radiance = true;
    auto &kept = problem.tracks;
    for (uint32_t t : keep) {
        const Range &track = tracks.tracks[t];
        size_t first = kept.observations.size();
        for (size_t i = track.first; i < track.last; i++) kept.observations.push_back(tracks.observations[i]);
        kept.tracks.push_back({first, kept.observations.size()});
    }
    problem.pairs = pairs_of(kept, problem.channels);
    find_track_chunks(problem);
    find_links(problem);
    complete(problem);
    return problem;
}

void Curve::renew_guide() {
    uint16_t j = 0;
    for (int k = 0; k <= kGuide; k++) {
        while (j + 1 < LENSPROF_RESPONSE_SAMPLES && table[j + 1] < static_cast<double>(k) / kGuide) j++;
        guide[k] = j;
    }
}

double Curve::invert(double b, double *slope) const {
    if (!(b > table.front()) || b > table.back()) return lp_curve_invert(table.data(), b, slope);
    auto k = static_cast<uint32_t>(b * kGuide);
    uint32_t next = std::min<uint32_t>(k + 1, kGuide);
    return lp_curve_invert_between(table.data(), b, guide[k], std::min(guide[next] + 1, LP_CURVE_LAST), slope);
}

void set_response(Estimate &estimate, const double *emor, int modes) {
    estimate.modes = modes;
    std::array<double, kMaxModes> copy{};
    std::copy(emor, emor + modes, copy.begin());
    estimate.emor = copy;
    lp_emor_curve(copy.data(), static_cast<uint32_t>(modes), estimate.curve.table.data());
    estimate.curve.renew_guide();
}

void set_table(Estimate &estimate, const double *curve) {
    auto &f = estimate.curve.table;
    std::copy(curve, curve + f.size(), f.begin());
    f.front() = 0.0, f.back() = 1.0;
    for (size_t j = 1; j < f.size(); j++) f[j] = std::max(f[j], f[j - 1] + kSmallestRise);
    f.back() = 1.0;  // a curve that reached 1 before its end was raised above it
    for (size_t j = f.size() - 1; j-- > 1;) f[j] = std::min(f[j], f[j + 1] - kSmallestRise);
    set_fixed(estimate, table_response(estimate));
    estimate.is_refined = true;
}

void set_fixed(Estimate &estimate, const lensprof_response &response) {
    estimate.modes = -1;
    estimate.fixed = response;
    std::copy(response.table, response.table + LENSPROF_RESPONSE_SAMPLES, estimate.curve.table.begin());
    estimate.curve.renew_guide();
}

Estimate estimate_of(const lensprof_response &response, const std::vector<Falloffs> &vignetting,
                     const lensprof_exposure *exposures, uint32_t image_count, int channels) {
    Estimate estimate;
    set_fixed(estimate, response);
    estimate.vignetting = vignetting;
    for (uint32_t i = 0; i < image_count; i++) {
        std::array<double, 3> a{};
        for (size_t c = 0; c < 3; c++)
            a[c] = exposures[i].ev * kLn2 + (channels == 1 ? 0.0 : std::log(exposures[i].white_balance[c]));
        estimate.log_exposure.push_back(a);
    }
    return estimate;
}

lensprof_response table_response(const Estimate &estimate) {
    lensprof_response response;
    if (lensprof_response_set_table(&response, estimate.curve.table.data(), LENSPROF_RESPONSE_SAMPLES) != LENSPROF_OK)
        throw std::runtime_error("the fitted response is not monotone");
    return response;
}

Eigen::VectorXd shared_vector(const Estimate &estimate) {
    const int settings = static_cast<int>(estimate.vignetting.size());
    Eigen::VectorXd full(shared_size(settings));
    std::copy(estimate.emor.begin(), estimate.emor.end(), full.data());
    for (int s = 0; s < settings; s++) {
        const Falloffs &curves = estimate.vignetting[static_cast<size_t>(s)];
        for (int c = 0; c < 3; c++) std::copy(curves[c].k, curves[c].k + 3, full.data() + falloff_column(s) + 3 * c);
        std::copy(curves[0].center, curves[0].center + 2, full.data() + center_column(s));
    }
    return full;
}

void set_shared(Estimate &estimate, const Eigen::VectorXd &full, int vignettings) {
    if (estimate.modes >= 0) set_response(estimate, full.data(), estimate.modes);
    for (int s = 0; s < static_cast<int>(estimate.vignetting.size()); s++)
        for (int c = 0; c < 3; c++) {
            lensprof_vignetting &curve = estimate.vignetting[static_cast<size_t>(s)][c];
            const double *k = full.data() + falloff_column(s) + (vignettings == 3 ? 3 * c : 0);
            const double *center = full.data() + center_column(s);
            std::copy(k, k + 3, curve.k);
            std::copy(center, center + 2, curve.center);
        }
}

std::vector<int> free_columns(const Problem &problem, int modes) {
    std::vector<int> columns;
    if (problem.free & LENSPROF_FREE_RESPONSE)
        for (int l = 0; l < modes; l++) columns.push_back(l);
    const uint32_t flags[3] = {LENSPROF_FREE_K1, LENSPROF_FREE_K2, LENSPROF_FREE_K3};
    for (int s = 0; s < problem.settings; s++) {
        for (int c = 0; c < problem.vignettings; c++)
            for (int n = 0; n < 3; n++)
                if (problem.free & flags[n]) columns.push_back(falloff_column(s) + 3 * c + n);
        if (problem.free & LENSPROF_FREE_CENTER)
            for (int d = 0; d < 2; d++) columns.push_back(center_column(s) + d);
    }
    return columns;
}

}  // namespace lensprof
