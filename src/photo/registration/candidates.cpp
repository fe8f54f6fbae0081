#include "photo/registration/candidates.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "threads/item_loop.hpp"

namespace lensprof {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Descriptors = Eigen::Map<const Eigen::Matrix<int16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

Rows descriptors_of(const Features &picture, int first, int count) {
    return Descriptors(picture.descriptors.ptr<int16_t>(first), count, descriptor_length).cast<float>()
           / static_cast<float>(unit_length);
}

constexpr uint32_t all_pairs_up_to = 8;  // pictures
constexpr uint32_t next_to = 2;          // pictures before and after
constexpr size_t enough_links = 20;      // per picture, of which no further ones are needed
constexpr int words = 64;
constexpr size_t sample_size = 20000;  // descriptors that the visual words are made from
constexpr int rounds = 10;             // of k-means

// The nearest word per row.
std::vector<Eigen::Index> nearest_words(const Rows &centres, const Rows &rows) {
    const Eigen::VectorXf half = 0.5f * centres.rowwise().squaredNorm();
    const Rows scores = (rows * centres.transpose()).rowwise() - half.transpose();
    std::vector<Eigen::Index> nearest(static_cast<size_t>(rows.rows()));
    for (Eigen::Index i = 0; i < rows.rows(); i++) scores.row(i).maxCoeff(&nearest[static_cast<size_t>(i)]);
    return nearest;
}

// Evenly selected descriptors of all pictures.
Rows chosen_descriptors(const std::vector<Features> &pictures) {
    size_t total = 0, number = 0;
    for (const Features &p : pictures) total += static_cast<size_t>(p.descriptors.rows);
    const size_t step = std::max<size_t>(1, total / sample_size);
    Rows chosen(static_cast<Eigen::Index>((total + step - 1) / step), descriptor_length);
    for (const Features &p : pictures)
        for (int i = 0; i < p.descriptors.rows; i++, number++)
            if (number % step == 0) chosen.row(static_cast<Eigen::Index>(number / step)) = descriptors_of(p, i, 1);
    return chosen;
}

// Centres of k-means, starting from evenly selected descriptors.
Rows find_words(const std::vector<Features> &pictures) {
    const Rows sample = chosen_descriptors(pictures);
    Rows centres(words, descriptor_length);
    if (sample.rows() < words) return Rows();
    for (int w = 0; w < words; w++) centres.row(w) = sample.row(w * sample.rows() / words);
    for (int round = 0; round < rounds; round++) {
        const std::vector<Eigen::Index> nearest = nearest_words(centres, sample);
        Rows sum = Rows::Zero(words, descriptor_length);
        Eigen::VectorXf count = Eigen::VectorXf::Zero(words);
        for (Eigen::Index i = 0; i < sample.rows(); i++) {
            sum.row(nearest[static_cast<size_t>(i)]) += sample.row(i);
            count[nearest[static_cast<size_t>(i)]] += 1.0f;
        }
        for (int w = 0; w < words; w++)
            if (count[w] > 0.0f) centres.row(w) = sum.row(w) / count[w];
    }
    return centres;
}

// Sums of the differences from the nearest words, each normalised to length 1, and the whole too.
Eigen::VectorXf aggregate(const Rows &centres, const Features &picture) {
    Rows sum = Rows::Zero(words, descriptor_length);
    if (picture.descriptors.rows > 0) {
        const Rows rows = descriptors_of(picture, 0, picture.descriptors.rows);
        const std::vector<Eigen::Index> nearest = nearest_words(centres, rows);
        for (Eigen::Index i = 0; i < rows.rows(); i++) {
            const Eigen::Index w = nearest[static_cast<size_t>(i)];
            sum.row(w) += rows.row(i) - centres.row(w);
        }
    }
    for (int w = 0; w < words; w++) sum.row(w).normalize();  // a word without descriptors stays 0
    Eigen::VectorXf descriptor = Eigen::Map<Eigen::VectorXf>(sum.data(), sum.size());
    descriptor.normalize();
    return descriptor;
}

}  // namespace

SimilarPictures::SimilarPictures(const std::vector<Features> &pictures) {
    for (const Features &picture : pictures) is_empty_.push_back(picture.descriptors.rows == 0);
    const Rows centres = find_words(pictures);
    if (centres.rows() == 0) return;
    const auto count = static_cast<uint32_t>(pictures.size());
    descriptors_.resize(count, words * descriptor_length);
    for_each_item(count, thread_count(0), [&](uint32_t i, uint32_t) {
        descriptors_.row(i) = aggregate(centres, pictures[i]).transpose();
        return true;
    });
}

std::vector<PicturePair> SimilarPictures::pairs(uint32_t count, const Takes &takes) const {
    constexpr uint32_t block = 32;  // pictures whose similarities are computed together
    const auto pictures = static_cast<uint32_t>(descriptors_.rows());
    std::vector<std::vector<uint32_t>> similar(pictures);
    for_each_item((pictures + block - 1) / block, thread_count(0), [&](uint32_t number, uint32_t) {
        const uint32_t begin = number * block, end = std::min(begin + block, pictures);
        const Rows similarity = descriptors_.middleRows(begin, end - begin) * descriptors_.transpose();
        for (uint32_t i = begin; i < end; i++) {
            std::vector<uint32_t> &others = similar[i];
            for (uint32_t j = 0; j < pictures; j++)
                if (j != i && !is_empty_[i] && !is_empty_[j]) others.push_back(j);
            const auto row = similarity.row(i - begin);
            std::sort(others.begin(), others.end(),
                      [&](uint32_t a, uint32_t b) { return row[a] > row[b] || (!(row[b] > row[a]) && a < b); });
            size_t taken = 0;
            for (size_t n = 0; n < others.size() && taken < count; n++)
                if (takes(i, others[n])) others[taken++] = others[n];
            others.resize(taken);
        }
        return true;
    });
    std::set<PicturePair> pairs;
    for (uint32_t i = 0; i < pictures; i++)
        for (const uint32_t j : similar[i]) pairs.insert(std::minmax(i, j));
    return {pairs.begin(), pairs.end()};
}

std::vector<PicturePair> candidate_pairs(const std::vector<Features> &pictures) {
    const auto count = static_cast<uint32_t>(pictures.size());
    const uint32_t reach = count <= all_pairs_up_to ? count : next_to;
    std::set<PicturePair> pairs;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = i + 1; j < count && j - i <= reach; j++) pairs.emplace(i, j);
    if (count > all_pairs_up_to) {
        const std::vector<PicturePair> similar =
            SimilarPictures(pictures).pairs(max_similar, [](uint32_t, uint32_t) { return true; });
        pairs.insert(similar.begin(), similar.end());
    }
    return {pairs.begin(), pairs.end()};
}

std::vector<PicturePair> further_pairs(uint32_t pictures, const std::vector<PicturePair> &linked,
                                       const std::vector<PicturePair> &tried) {
    std::vector<std::vector<uint32_t>> others(pictures);
    for (const auto &[a, b] : linked) others[a].push_back(b), others[b].push_back(a);
    std::set<PicturePair> pairs;
    for (const auto &linked_pictures : others) {
        if (linked_pictures.size() >= enough_links) continue;
        for (size_t m = 0; m < linked_pictures.size(); m++)
            for (size_t n = m + 1; n < linked_pictures.size(); n++) {
                const PicturePair pair = std::minmax(linked_pictures[m], linked_pictures[n]);
                if (!std::binary_search(tried.begin(), tried.end(), pair)) pairs.insert(pair);
            }
    }
    return {pairs.begin(), pairs.end()};
}

void LinkedPictures::add_tried(const std::vector<PicturePair> &pairs) {
    tried_.insert(tried_.end(), pairs.begin(), pairs.end());
    std::sort(tried_.begin(), tried_.end());
}

void LinkedPictures::add_link(const PicturePair &pair) {
    for (const auto &[picture, other] : {pair, PicturePair(pair.second, pair.first)}) {
        std::vector<uint32_t> &others = others_[picture];
        others.insert(std::lower_bound(others.begin(), others.end(), other), other);
    }
}

bool LinkedPictures::is_tried(const PicturePair &pair) const {
    return std::binary_search(tried_.begin(), tried_.end(), pair);
}

bool LinkedPictures::is_linked(uint32_t picture, uint32_t other) const {
    return std::binary_search(others_[picture].begin(), others_[picture].end(), other);
}

bool LinkedPictures::is_joined(uint32_t picture) const { return others_[picture].size() >= enough_links; }

bool LinkedPictures::are_near(uint32_t picture, uint32_t other) const {
    return is_linked(picture, other)
           || std::any_of(others_[picture].begin(), others_[picture].end(),
                          [&](uint32_t between) { return is_linked(between, other); });
}

std::vector<PicturePair> LinkedPictures::in_sequence(uint32_t distance) const {
    std::vector<PicturePair> pairs;
    for (uint32_t i = 0; i + distance < count(); i++) {
        const uint32_t middle = i + distance / 2;
        const bool may_overlap = distance <= next_to || (is_linked(i, middle) && is_linked(middle, i + distance));
        if (may_overlap && !are_joined({i, i + distance})) pairs.emplace_back(i, i + distance);
    }
    return pairs;
}

std::vector<PicturePair> LinkedPictures::through_common() const {
    std::set<PicturePair> pairs;
    for (uint32_t i = 0; i < count(); i++) {
        if (is_joined(i)) continue;
        std::map<uint32_t, size_t> common;  // by picture
        for (const uint32_t between : others_[i])
            for (const uint32_t other : others_[between])
                if (other != i && !is_tried(std::minmax(i, other))) common[other]++;
        std::vector<std::pair<uint32_t, size_t>> ranked(common.begin(), common.end());
        std::stable_sort(ranked.begin(), ranked.end(),
                         [](const auto &a, const auto &b) { return a.second > b.second; });
        ranked.resize(std::min(ranked.size(), 2 * (enough_links - others_[i].size())));
        for (const auto &candidate : ranked) pairs.insert(std::minmax(i, candidate.first));
    }
    return {pairs.begin(), pairs.end()};
}

}  // namespace lensprof
