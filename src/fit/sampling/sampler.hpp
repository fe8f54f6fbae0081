// Finds correspondences: candidates from image to image through the geometry, then a choice among them. The search for
// tracks is in track_sampler.cpp, sampling from matches in match_sampler.cpp.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "fit/base/parallel.hpp"
#include "fit/base/random.hpp"
#include "fit/sampling/balance.hpp"
#include "fit/sampling/registration.hpp"
#include "fit/sampling/view.hpp"

namespace lensprof {

constexpr uint32_t kLongestTrack = 16;
constexpr double kSlack = 0.02;  // margin on the cosine of a cone's edge, because projects may be off

class Sampler {
public:
    Sampler(const lensprof_sample_options &options, const lensprof_sample_image *images, uint32_t count);

    // For of_matches: images with matches are neighbours, and cameras are not read. Defined in match_sampler.cpp.
    Sampler(const lensprof_sample_options &options, const lensprof_sample_image *images, uint32_t count,
            const lensprof_match *matches, uint32_t match_count);

    // The candidates of lowest gradient first, balanced over image pairs, radius and grey level.
    std::vector<lensprof_pair> balanced(uint32_t wanted);

    // d'Angelo 5.1: 5n random points, binned by radius; from each of 10 bins the n/10 of lowest gradient.
    std::vector<lensprof_pair> paper(uint32_t wanted);

    // At places that match: the patch with the lowest gradient near each match, balanced as above. `match_of_pair`, if
    // not NULL, receives the index of the match of each pair.
    std::vector<lensprof_pair> of_matches(const lensprof_match *matches, uint32_t count, uint32_t wanted,
                                          uint32_t *match_of_pair);

    // Points spread evenly over the area that the pictures see, each in every picture that sees it (kLongestTrack at
    // most). Saturated channels have the value 1. Takes the point of lowest gradient nearby, balanced over radius and
    // grey level.
    std::vector<lensprof_observation> balanced_tracks(uint32_t wanted);

    // Goldman & Chen, section 5: points uniform in a cylindrical system, without selection.
    std::vector<lensprof_observation> paper_tracks(uint32_t wanted);

    bool overlaps() const { return overlaps_; }

    // For balanced sampling: the neighbours between which pairs were searched.
    std::vector<lensprof_link> links() const;

private:
    // One end of a correspondence. Bins of radius and grey level count from 0.
    struct End {
        Patch patch;
        uint8_t radius, grey;
    };
    // There may be millions, so grey values are not stored; they are measured again for the candidates chosen.
    struct Candidate {
        double x, y;  // in image[0], px of the full frame
        uint32_t image[2];
        float gradient;  // both ends together
        uint8_t radius[2], grey[2];
    };
    // A point of paper sampling: where to look, and in which other image.
    struct Look {
        double x, y;
        uint32_t image[2];
    };

    // A candidate near a match, at the place where its pair is measured.
    struct MatchCandidate : Candidate {
        lensprof_pair pair;
        uint32_t match;  // its index
    };

    // One image's part of a candidate for a track.
    struct Visit {
        double xy[2];
        uint32_t image;
        uint8_t radius, grey;
    };
    struct TrackCandidate {
        std::vector<Visit> visits;  // the first is the anchor, from which the others were found
        float gradient = 0.0f;      // mean of the visits
        uint32_t cell = 0;          // shared by candidates near each other
    };
    // Where to look for a track, and its cell.
    struct Aim {
        double direction[2];
        uint32_t cell;
    };

    // An image sees only directions within `reach` of its axis, radians (with a small margin).
    struct Cone {
        double axis[3], reach;
        double cosine;  // of reach; less than any cosine if the cone is not known
        bool known;
    };

    // Counts of places shared by a pair of neighbours: those with texture, and of these those that may and those that
    // clearly do show the same; for comparison, places displaced from where the other image should show them, and those
    // that clearly do.
    struct Likenesses {
        std::atomic<uint32_t> seen{0}, textured{0}, alike{0}, clearly_alike{0}, displaced{0}, chance{0};
        uint32_t pairs = 0;  // pairs that are used
    };

    static Cone cone_of(const lensprof_camera &camera);
    void find_neighbours();
    void number_edges();
    void read_grey_levels();
    void register_neighbours();
    const Correction &correction(uint32_t i, uint32_t j) const;
    bool correspond(uint32_t i, uint32_t j, double x, double y, double xy[2]) const;
    bool shows_same_scene(uint32_t i, uint32_t j, double x, double y);
    bool is_alike(uint32_t i, double x, double y, uint32_t j, Sight expected);
    lensprof_link_state state_of(uint32_t number) const;
    bool measure(uint32_t i, double x, double y, End &end) const;
    void look(uint32_t i, double x, double y, const uint32_t *others, size_t count, std::vector<Candidate> &found);
    Look draw(Random &random) const;
    std::vector<Candidate> candidates(size_t wanted);
    template <class Any>
    std::vector<Any> balanced_choice(std::vector<Any> all, uint32_t wanted);
    bool flattest_place(const lensprof_match &match, MatchCandidate &found);
    std::vector<lensprof_pair> pairs_of(const std::vector<Candidate> &chosen);
    bool are_neighbours(uint32_t i, uint32_t j) const;
    uint32_t edge_of(uint32_t i, uint32_t j) const;  // of neighbours
    Cone cone_of_all() const;
    bool find_track(const Aim &aim, uint32_t number, TrackCandidate &found);
    std::vector<TrackCandidate> track_candidates(size_t wanted, const std::function<Aim(uint32_t)> &aim);
    std::vector<TrackCandidate> in_place(std::vector<TrackCandidate> all) const;
    std::vector<lensprof_observation> observations_of(const std::vector<TrackCandidate> &chosen);
    void report_done();
    void run_parallel(uint32_t count, const std::function<void(uint32_t)> &work, const std::function<double()> &done);

    const lensprof_sample_options &options_;
    std::vector<View> views_;
    std::vector<Cone> cones_;
    std::vector<std::vector<uint32_t>> neighbours_;  // ascending
    std::vector<uint32_t> first_edge_;               // number of every image's first pair with a neighbour
    uint32_t edge_numbers_ = 0;                      // exclusive upper bound of edge_of()
    std::vector<std::unique_ptr<GreyLevels>> grey_;  // per view
    std::vector<Correction> corrections_;            // per pair of neighbours, from the lower image to the other
    std::vector<Likenesses> likenesses_;             // per pair of neighbours
    std::atomic<size_t> refused_{0};                 // pairs of places that do not show the same
    bool patches_ = true;                            // otherwise single points
    bool by_matches_ = false;                        // matches verify links
    bool keep_white_ = false;                        // saturated channels are samples, too
    std::atomic<bool> overlaps_{false};
    double shown_ = 0.0;  // the last fraction reported to the caller
};

// The candidates of lowest gradient of links that are not contradicted, as long as no image pair, radius or grey level
// exceeds its share; the shares grow until enough are found.
template <class Any>
std::vector<Any> Sampler::balanced_choice(std::vector<Any> all, uint32_t wanted) {
    const auto edge = [&](const Candidate &c) { return edge_of(c.image[0], c.image[1]); };
    const auto out_of_place = [&](const Candidate &c) { return state_of(edge(c)) == LENSPROF_LINK_CONTRADICTED; };
    all.erase(std::remove_if(all.begin(), all.end(), out_of_place), all.end());
    const auto chosen = balance(
        all.size(), wanted, 2.0 * wanted, edge_numbers_, [&](uint32_t i) { return all[i].gradient; },
        [&](uint32_t i) { return edge(all[i]); },
        [&](uint32_t i, auto use) {
            for (int side = 0; side < 2; side++) use(all[i].radius[side], all[i].grey[side]);
        });
    std::vector<Any> best;
    for (uint32_t index : chosen) best.push_back(all[index]);
    for (const Candidate &c : best) likenesses_[edge(c)].pairs++;
    return best;
}

}  // namespace lensprof
