#include "photo/registration/candidates.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include <Eigen/Core>

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
constexpr size_t enough_links = 20;      // maximum further candidates per picture
constexpr uint32_t max_similar = 12;     // pictures most like one
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

void add_most_similar(const std::vector<Features> &pictures, std::set<PicturePair> &pairs) {
    const Rows centres = find_words(pictures);
    if (centres.rows() == 0) return;
    const auto count = static_cast<uint32_t>(pictures.size());
    Rows all(count, words * descriptor_length);
    for_each_item(count, thread_count(0), [&](uint32_t i, uint32_t) {
        all.row(i) = aggregate(centres, pictures[i]).transpose();
        return true;
    });
    std::vector<uint32_t> order(count);
    for (uint32_t i = 0; i < count; i++) {
        Eigen::VectorXf similarity = all * all.row(i).transpose();
        for (uint32_t j = 0; j < count; j++)
            if (pictures[j].descriptors.rows == 0) similarity[j] = -2.0f;  // after all others: it overlaps nothing
        std::iota(order.begin(), order.end(), 0u);
        const auto end = order.begin() + std::min(count, max_similar + 1);  // including itself
        std::partial_sort(order.begin(), end, order.end(), [&](uint32_t a, uint32_t b) {
            return similarity[a] > similarity[b] || (similarity[a] == similarity[b] && a < b);
        });
        for (auto j = order.begin(); j != end; ++j)
            if (*j != i) pairs.insert(std::minmax(i, *j));
    }
}

}  // namespace

std::vector<PicturePair> candidate_pairs(const std::vector<Features> &pictures) {
    const auto count = static_cast<uint32_t>(pictures.size());
    const uint32_t reach = count <= all_pairs_up_to ? count : next_to;
    std::set<PicturePair> pairs;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = i + 1; j < count && j - i <= reach; j++) pairs.emplace(i, j);
    if (count > all_pairs_up_to) add_most_similar(pictures, pairs);
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

}  // namespace lensprof
