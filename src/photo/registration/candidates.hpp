// Selects pairs of pictures worth matching: similar pictures, and neighbours in the sequence.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "photo/registration/features.hpp"

namespace lensprof {

using PicturePair = std::pair<uint32_t, uint32_t>;  // indices, the lower one first

// How alike pictures are, by VLAD descriptors (Jegou et al. 2010).
class SimilarPictures {
public:
    explicit SimilarPictures(const std::vector<Features> &pictures);

    // Of every picture with each of the `count` most similar ones that it takes. Sorted.
    using Takes = std::function<bool(uint32_t picture, uint32_t other)>;
    std::vector<PicturePair> pairs(uint32_t count, const Takes &takes) const;

private:
    std::vector<bool> is_empty_;  // pictures without features overlap nothing
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> descriptors_;  // one row per picture
};

constexpr uint32_t max_similar = 12;  // pictures most like one that are matched with it

// All pairs if there are few pictures. Else each picture with its neighbours in the sequence and with the most similar
// ones, so that the number of pairs grows linearly. Sorted.
std::vector<PicturePair> candidate_pairs(const std::vector<Features> &pictures);

// Further candidates found through few links: pictures linked to a common picture by few links that were not candidates
// before.
std::vector<PicturePair> further_pairs(uint32_t pictures, const std::vector<PicturePair> &linked,
                                       const std::vector<PicturePair> &tried);

// Which pairs are linked, and which were tried.
class LinkedPictures {
public:
    explicit LinkedPictures(uint32_t pictures) : others_(pictures) {}

    void add_tried(const std::vector<PicturePair> &pairs);
    void add_link(const PicturePair &pair);

    uint32_t count() const { return static_cast<uint32_t>(others_.size()); }
    bool is_tried(const PicturePair &pair) const;
    bool is_linked(uint32_t picture, uint32_t other) const;
    bool is_joined(uint32_t picture) const;  // by as many links as are of use
    bool are_joined(const PicturePair &pair) const { return is_joined(pair.first) && is_joined(pair.second); }
    bool are_near(uint32_t picture, uint32_t other) const;  // linked, or to a common picture

    // Pictures `distance` apart in the sequence; from 4 on those that are linked half way.
    std::vector<PicturePair> in_sequence(uint32_t distance) const;

    // Every picture that is not joined with those that have most linked pictures in common with it, about twice as many
    // as it lacks links.
    std::vector<PicturePair> through_common() const;

private:
    std::vector<std::vector<uint32_t>> others_;  // per picture, ascending
    std::vector<PicturePair> tried_;             // sorted
};

}  // namespace lensprof
