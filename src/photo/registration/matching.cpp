#include "photo/registration/matching.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include <opencv2/calib3d.hpp>

#include "photo/base/parallel.hpp"
#include "photo/registration/candidates.hpp"
#include "photo/registration/nearest_features.hpp"

namespace lensprof {
namespace {

constexpr double ratio = 0.8;        // Lowe's ratio of the distances to the nearest and second nearest feature
constexpr double tolerance = 0.003;  // of the longer side: maximum distance of a match from the homography
// Brown & Lowe 2007, equation 13, with our own shares: for unrelated pictures no homography held more than 7 of 90
// matches; for related ones with little overlap 10 to 20.
constexpr size_t min_matches = 10;
constexpr double min_above_chance = 6.0, share_of_matches = 0.1;
constexpr double still = 0.002;       // of the longer side: less than the movement by a camera that moves or rotates
constexpr size_t still_by_moved = 3;  // ratio of stationary to moving matches for a stationary camera
constexpr int max_draws = 3000;       // of four matches for a homography
constexpr int max_rounds = 5;         // of matching: links found determine the next candidates
constexpr int quick_features = 1000;
constexpr size_t plenty_matches = 100;  // of the largest features, which suffice for a link then
constexpr uint32_t max_revisits = 2;    // pictures most like one, of those that are not near by links

enum class Effort {
    quick,
    thorough
};  // with the largest features, or with all

using Match = std::pair<int, int>;

// Every feature of the first picture whose nearest one in the second passes the ratio test and is not nearer to
// another. For descriptors of length 1 the product is 1 - distance^2 / 2.
std::vector<Match> match(const Features &first, const Features &second, Effort effort) {
    std::vector<Match> found;
    if (first.descriptors.rows < 2 || second.descriptors.rows < 2) return found;
    const auto used = [&](const cv::Mat &descriptors) {
        return descriptors.rowRange(
            0, effort == Effort::quick ? std::min(descriptors.rows, quick_features) : descriptors.rows);
    };
    const cv::Mat a = used(first.descriptors), b = used(second.descriptors);
    const std::vector<NearestFeatures> nearest = nearest_features(a.ptr<int16_t>(), a.rows, b.ptr<int16_t>(), b.rows);
    constexpr double one = unit_length * unit_length;
    std::vector<int> taken(static_cast<size_t>(b.rows), -1);
    for (int i = 0; i < a.rows; i++) {
        const NearestFeatures &n = nearest[static_cast<size_t>(i)];
        int &other = taken[static_cast<size_t>(n.number)];
        if (one - n.best < ratio * ratio * (one - n.next)
            && (other < 0 || n.best > nearest[static_cast<size_t>(other)].best))
            other = i;
    }
    for (int to = 0; to < b.rows; to++)
        if (taken[static_cast<size_t>(to)] >= 0) found.emplace_back(taken[static_cast<size_t>(to)], to);
    return found;
}

using Places = std::vector<std::pair<cv::Point2d, cv::Point2d>>;

// The homography supported by most matches; empty if chance explains as many.
std::optional<PictureLink> link_by(const PicturePair &pair, const Places &matches, double longer_side) {
    if (matches.size() < min_matches) return std::nullopt;
    std::vector<cv::Point2d> from, to;
    for (const auto &[a, b] : matches) from.push_back(a), to.push_back(b);
    std::vector<uint8_t> follows;
    const cv::Mat homography =
        cv::findHomography(from, to, cv::USAC_MAGSAC, tolerance * longer_side, follows, max_draws, 0.999);
    if (homography.empty()) return std::nullopt;
    PictureLink found{{pair.first, pair.second}, {}, homography, false};
    for (size_t m = 0; m < matches.size(); m++)
        if (follows[m]) found.matches.push_back(matches[m]);
    const auto count = static_cast<double>(found.matches.size());
    const bool is_chance = found.matches.size() < min_matches
                           || count <= min_above_chance + share_of_matches * static_cast<double>(matches.size());
    return is_chance ? std::nullopt : std::optional(std::move(found));
}

// Positions in the first frame.
cv::Rect2d box_of(const Places &places) {
    cv::Point2d low = places[0].first, high = low;
    for (const auto &[from, to] : places) {
        low = {std::min(low.x, from.x), std::min(low.y, from.y)};
        high = {std::max(high.x, from.x), std::max(high.y, from.y)};
    }
    return {low.x, low.y, high.x - low.x, high.y - low.y};
}

// Whether stationary positions belong to a scene: many more than moved together, spread over the frame and the area of
// the moved ones, which then come from repetitive objects. Something fixed to the frame, such as a dashboard, occupies
// its own part of it.
bool is_still_scene(const Places &stayed, const Places &moved, const Features &picture) {
    if (stayed.size() < min_matches || stayed.size() < still_by_moved * moved.size()) return false;
    const cv::Rect2d box = box_of(stayed);
    const auto outside =
        std::count_if(moved.begin(), moved.end(), [&](const auto &place) { return !box.contains(place.first); });
    return box.width > 0.5 * picture.width && box.height > 0.25 * picture.height
           && 2 * static_cast<size_t>(outside) <= moved.size();
}

// The matches of two pictures, by whether they are at the same position in both frames.
struct Matched {
    Places all, moved, stayed;
    double longer_side;

    Matched(const Features &a, const Features &b, Effort effort)
        : longer_side(std::max(std::max(a.width, a.height), std::max(b.width, b.height))) {
        for (const Match &m : match(a, b, effort)) {
            const cv::Point2d from = a.places[static_cast<size_t>(m.first)],
                              to = b.places[static_cast<size_t>(m.second)];
            all.emplace_back(from, to);
            (cv::norm(to - from) > still * longer_side ? moved : stayed).push_back(all.back());
        }
    }
};

// Uses what moved between frames; or, if that shows nothing, everything: what is fixed to the frame (a date stamp, a
// logo, dirt) matches in every pair of pictures. Nothing moves with a stationary camera, except that matches of
// repetitive objects may agree by chance.
std::optional<PictureLink> link(const std::vector<Features> &pictures, const PicturePair &pair, Effort effort) {
    const Features &a = pictures[pair.first];
    const auto [all, moved, stayed, longer_side] = Matched(a, pictures[pair.second], effort);
    auto by_moved = link_by(pair, moved, longer_side);
    const bool is_scene = is_still_scene(stayed, by_moved ? by_moved->matches : Places(), a);
    if (by_moved && !is_scene) return by_moved;
    auto found = link_by(pair, by_moved ? stayed : all, longer_side);
    if (found) found->is_still = !stayed.empty(), found->is_scene = is_scene;
    return found;
}

// The stationary positions of a picture, by its still link with most matches.
struct Stayed {
    size_t matches = 0;
    cv::Rect2d box;
};

std::vector<Stayed> what_stayed(size_t pictures, const std::vector<PictureLink> &links) {
    std::vector<Stayed> stayed(pictures);
    for (const PictureLink &link : links)
        for (const uint32_t picture : link.picture)  // at the same positions in both
            if (link.is_scene && link.matches.size() > stayed[picture].matches)
                stayed[picture] = {link.matches.size(), box_of(link.matches)};
    return stayed;
}

// Removes moving links between pictures connected by still ones with far more matches at the same positions: chance
// matches of repetitive objects.
void drop_chance(size_t pictures, std::vector<PictureLink> &links) {
    const std::vector<uint32_t> groups =
        groups_of(pictures, links, [](const PictureLink &link) { return link.is_scene; });
    const std::vector<Stayed> stayed = what_stayed(pictures, links);
    const auto is_chance = [&](const PictureLink &link) {
        const Stayed &a = stayed[link.picture[0]], &b = stayed[link.picture[1]];
        if (link.is_still || groups[link.picture[0]] != groups[link.picture[1]]) return false;
        if (still_by_moved * link.matches.size() >= std::min(a.matches, b.matches)) return false;
        const auto within = std::count_if(link.matches.begin(), link.matches.end(), [&](const auto &place) {
            return a.box.contains(place.first) && b.box.contains(place.second);
        });
        return 2 * static_cast<size_t>(within) > link.matches.size();
    };
    links.erase(std::remove_if(links.begin(), links.end(), is_chance), links.end());
}

// Removes still links of pictures connected by moving ones: the camera was not stationary.
void drop_static(size_t pictures, std::vector<PictureLink> &links) {
    std::vector<bool> moves(pictures);
    for (const PictureLink &link : links)
        for (uint32_t picture : link.picture)
            if (!link.is_still) moves[picture] = true;
    const auto is_fixed = [&](const PictureLink &link) {
        return link.is_still && (moves[link.picture[0]] || moves[link.picture[1]]);
    };
    links.erase(std::remove_if(links.begin(), links.end(), is_fixed), links.end());
}

// Matches pairs and keeps their links.
class LinkSearch {
public:
    LinkSearch(const std::vector<Features> &pictures, Events &events)
        : pictures_(pictures), events_(events), linked_(static_cast<uint32_t>(pictures.size())) {}

    // All links that the candidates lead to.
    void find_all() {
        std::vector<PicturePair> tried, linked, pairs = candidate_pairs(pictures_);
        for (int round = 0; round < max_rounds && !pairs.empty(); round++) {
            const size_t before = links.size();
            try_all(pairs, round ? further_step : step,
                    [&](const PicturePair &pair) { return link(pictures_, pair, Effort::thorough); });
            for (size_t n = before; n < links.size(); n++)
                linked.emplace_back(links[n].picture[0], links[n].picture[1]);
            tried.insert(tried.end(), pairs.begin(), pairs.end());
            std::sort(tried.begin(), tried.end());
            pairs = further_pairs(static_cast<uint32_t>(pictures_.size()), linked, tried);
        }
    }

    // Enough links per picture: in the sequence, with growing distance, then between similar pictures, then through
    // those found. Last between similar ones that are not near by then: where the camera came back.
    void find_enough() {
        std::vector<PicturePair> pairs = linked_.in_sequence(1);
        for (uint32_t distance = 2; !pairs.empty(); distance *= 2) {
            try_most(pairs, step);
            pairs = linked_.in_sequence(distance);
        }
        const SimilarPictures similar(pictures_);
        pairs = similar.pairs(max_similar, [](uint32_t, uint32_t) { return true; });
        remove(pairs, [&](const PicturePair &pair) { return linked_.are_joined(pair); });
        try_most(pairs, step);
        try_through_common();
        try_most(similar.pairs(max_revisits, [&](uint32_t i, uint32_t j) { return !linked_.are_near(i, j); }),
                 further_step);
        try_through_common();
    }

    std::vector<PictureLink> links;

private:
    static constexpr const char *step = "matching pictures", *further_step = "matching further pictures";

    template <class Is>
    static void remove(std::vector<PicturePair> &pairs, const Is &is) {
        pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is), pairs.end());
    }

    template <class FindLink>
    void try_all(const std::vector<PicturePair> &pairs, const char *what, const FindLink &find_link) {
        std::vector<std::optional<PictureLink>> found(pairs.size());
        for_each_parallel(static_cast<uint32_t>(pairs.size()), what, events_,
                          [&](uint32_t n) { found[n] = find_link(pairs[n]); });
        for (size_t n = 0; n < pairs.size(); n++) {
            if (!found[n]) continue;
            links.push_back(std::move(*found[n]));
            linked_.add_link(pairs[n]);
        }
    }

    // Those not tried before. All features are used if the largest ones match too little, except for two pictures that
    // are joined.
    void try_most(std::vector<PicturePair> pairs, const char *what) {
        remove(pairs, [&](const PicturePair &pair) { return linked_.is_tried(pair); });
        try_all(pairs, what, [&](const PicturePair &pair) {
            std::optional<PictureLink> found = link(pictures_, pair, Effort::quick);
            const bool is_clear = found && !found->is_still && found->matches.size() >= plenty_matches;
            const auto has_more = [&](uint32_t i) { return pictures_[i].descriptors.rows > quick_features; };
            const bool is_all = !has_more(pair.first) && !has_more(pair.second);
            return is_clear || is_all || linked_.are_joined(pair) ? found : link(pictures_, pair, Effort::thorough);
        });
        linked_.add_tried(pairs);
    }

    void try_through_common() {
        for (int round = 0; round < max_rounds; round++) {
            const std::vector<PicturePair> pairs = linked_.through_common();
            if (pairs.empty()) return;
            try_most(pairs, further_step);
        }
    }

    const std::vector<Features> &pictures_;
    Events &events_;
    LinkedPictures linked_;
};

}  // namespace

std::vector<PictureLink> find_links(const std::vector<Features> &pictures, Events &events) {
    LinkSearch search(pictures, events);
    if (pictures.size() <= few_pictures)
        search.find_all();
    else
        search.find_enough();
    std::vector<PictureLink> links = std::move(search.links);
    drop_chance(pictures.size(), links);
    drop_static(pictures.size(), links);
    std::sort(links.begin(), links.end(), [](const PictureLink &a, const PictureLink &b) {
        return std::tie(a.picture[0], a.picture[1]) < std::tie(b.picture[0], b.picture[1]);
    });
    return links;
}

bool turn_only(const std::vector<std::pair<Features, Features>> &neighbours) {
    constexpr double share_of_turn = 0.9;  // more than 0.97 if the camera turns, less than 0.65 if it moves
    size_t matches = 0, follow = 0;
    for (const auto &[first, second] : neighbours) {
        const Matched matched(first, second, Effort::quick);
        matches += matched.moved.size();
        if (const auto found = link_by({0, 1}, matched.moved, matched.longer_side)) follow += found->matches.size();
    }
    return follow >= plenty_matches * neighbours.size()
           && static_cast<double>(follow) > share_of_turn * double(matches);
}

std::vector<uint32_t> groups_of(size_t pictures, const std::vector<PictureLink> &links, const TakesLink &takes) {
    std::vector<uint32_t> first(pictures);
    std::iota(first.begin(), first.end(), 0u);
    const auto root = [&](uint32_t i) {
        while (first[i] != i) i = first[i] = first[first[i]];
        return i;
    };
    for (const PictureLink &link : links) {
        if (!takes(link)) continue;
        const uint32_t a = root(link.picture[0]), b = root(link.picture[1]);
        first[std::max(a, b)] = std::min(a, b);
    }
    std::vector<uint32_t> group(pictures), number(pictures, UINT32_MAX);
    uint32_t count = 0;
    for (uint32_t i = 0; i < pictures; i++) {
        uint32_t &n = number[root(i)];
        if (n == UINT32_MAX) n = count++;
        group[i] = n;
    }
    return group;
}

}  // namespace lensprof
