#include "fit/problem/tracks.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "fit/base/track_pairs.hpp"

namespace lensprof {
namespace {

bool is_measured(const lensprof_observation &o, int channels) {
    for (int c = 0; c < channels; c++)
        if (o.value[c] > kWhite || o.value[c] < kBlack) return false;
    return true;
}

lensprof_observation end_of(const lensprof_pair &pair, int side, int channels) {
    lensprof_observation o{};
    o.image = pair.image[side];
    std::copy(pair.xy[side], pair.xy[side] + 2, o.xy);
    std::copy(pair.value[side], pair.value[side] + channels, o.value);  // the others are undefined
    return o;
}

auto key(const lensprof_observation &o) {
    return std::tuple(o.image, o.xy[0], o.xy[1], o.value[0], o.value[1], o.value[2]);
}

// Numbers the ends; equal ends have equal numbers. 2p and 2p + 1 are those of pair p.
std::vector<uint32_t> number_ends(const std::vector<lensprof_observation> &ends) {
    std::vector<uint32_t> order(ends.size()), number(ends.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(ends[a]) < key(ends[b]); });
    for (size_t n = 0, first = 0; n < order.size(); n++) {
        if (key(ends[order[n]]) != key(ends[order[first]])) first = n;
        number[order[n]] = order[first];
    }
    return number;
}

// Points as lists of ends, to which pairs are added.
class Joiner {
public:
    explicit Joiner(const std::vector<lensprof_observation> &ends) : ends_(ends), point_(ends.size(), kNone) {}

    void join(uint32_t a, uint32_t b) {
        uint32_t p = point_[a], q = point_[b];
        if (p != kNone && p == q) return;
        std::vector<uint32_t> first = p == kNone ? std::vector<uint32_t>{a} : points_[p];
        std::vector<uint32_t> second = q == kNone ? std::vector<uint32_t>{b} : points_[q];
        if (!are_apart(first, second)) return keep_apart(a, b);
        if (p == kNone) p = static_cast<uint32_t>(points_.size()), points_.emplace_back();
        first.insert(first.end(), second.begin(), second.end());
        for (uint32_t end : first) point_[end] = p;
        points_[p] = std::move(first);
        if (q != kNone) points_[q].clear();
    }

    const std::vector<std::vector<uint32_t>> &points() const { return points_; }

private:
    static constexpr uint32_t kNone = 0xFFFFFFFFu;

    bool are_apart(const std::vector<uint32_t> &first, const std::vector<uint32_t> &second) const {
        for (uint32_t a : first)
            for (uint32_t b : second)
                if (ends_[a].image == ends_[b].image) return false;
        return true;
    }
    // Makes a separate point of both ends; an end without a point gets this one.
    void keep_apart(uint32_t a, uint32_t b) {
        for (uint32_t end : {a, b})
            if (point_[end] == kNone) point_[end] = static_cast<uint32_t>(points_.size());
        points_.push_back({a, b});
    }

    const std::vector<lensprof_observation> &ends_;
    std::vector<uint32_t> point_;  // per end
    std::vector<std::vector<uint32_t>> points_;
};

}  // namespace

Tracks tracks_of(const lensprof_observation *observations, uint32_t count) {
    Tracks result;
    auto &all = result.observations;
    all.assign(observations, observations + count);
    std::sort(all.begin(), all.end(), [](const lensprof_observation &a, const lensprof_observation &b) {
        return std::tuple(a.point, a.image) < std::tuple(b.point, b.image);
    });
    for (size_t i = 0; i < all.size(); i++) {
        if (i == 0 || all[i].point != all[i - 1].point) result.tracks.push_back({i, i});
        result.tracks.back().last = i + 1;
    }
    return result;
}

std::vector<lensprof_observation> observations_of(const lensprof_pair *pairs, uint32_t count, int channels) {
    std::vector<lensprof_observation> ends, result;
    for (uint32_t p = 0; p < count; p++)
        for (int side = 0; side < 2; side++) ends.push_back(end_of(pairs[p], side, channels));
    std::vector<uint32_t> number = number_ends(ends);
    Joiner joiner(ends);
    for (uint32_t p = 0; p < count; p++) joiner.join(number[2 * p], number[2 * p + 1]);
    uint32_t point = 0;
    for (const auto &members : joiner.points()) {
        for (uint32_t end : members) {
            result.push_back(ends[end]);
            result.back().point = point;
        }
        point += !members.empty();
    }
    return result;
}

Tracks tracks_within(const Tracks &tracks, const std::function<bool(uint32_t i, uint32_t j)> &holds) {
    Tracks result;
    for (const Range &track : tracks.tracks) {
        const size_t first = result.observations.size();
        for (size_t n = track.first; n < track.last; n++) {
            const uint32_t image = tracks.observations[n].image;
            bool agrees = holds(image, image);
            for (size_t kept = first; kept < result.observations.size() && agrees; kept++)
                agrees = holds(result.observations[kept].image, image);
            if (agrees) result.observations.push_back(tracks.observations[n]);
        }
        if (result.observations.size() < first + 2)
            result.observations.resize(first);
        else
            result.tracks.push_back({first, result.observations.size()});
    }
    return result;
}

std::vector<lensprof_pair> pairs_of(const Tracks &tracks, int channels) {
    std::vector<lensprof_pair> pairs;
    const auto takes = [channels](const lensprof_observation &o) { return is_measured(o, channels); };
    for (const Range &track : tracks.tracks)
        add_track_pairs(&tracks.observations[track.first],
                        &tracks.observations[track.first] + (track.last - track.first), takes, pairs);
    return pairs;
}

}  // namespace lensprof
