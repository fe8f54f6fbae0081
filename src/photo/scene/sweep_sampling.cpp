#include "photo/scene/sweep_sampling.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "photo/base/format.hpp"
#include "photo/base/lap.hpp"
#include "photo/base/parallel.hpp"
#include "photo/scene/static_camera.hpp"

namespace lensprof {
namespace {

constexpr uint32_t common_pictures = 8;  // of all groups
constexpr uint32_t pairs_per_picture = 10000, enough_pairs = 100000, least_pairs_per_picture = 100;

struct Brightness {
    double mean = 0.0;        // of the samples, 0..1
    double grey_share = 0.0;  // of them, neither black nor white
};

Brightness brightness_of(const Picture &picture, double black) {
    constexpr double white = 254.4 / 255.0;
    const uint32_t step = lensprof_layout_samples(picture.layout), channels = lensprof_layout_channels(picture.layout);
    double sum = 0.0;
    size_t grey = 0;
    for (uint32_t y = 0; y < picture.height; y++) {
        const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
        for (uint32_t n = 0; n < picture.width * step; n++) {
            if (n % step >= channels) continue;
            const double value = sample_value(picture.sample, row, n);
            sum += value;
            grey += value > black && value < white;
        }
    }
    const double count = double(picture.width) * picture.height * channels;
    return {sum / count, double(grey) / count};
}

std::vector<Brightness> measure(const Scene &scene, uint32_t max_side, double black, Events &progress) {
    std::vector<Brightness> all(scene.files.size());
    for_each_parallel(static_cast<uint32_t>(all.size()), "reading pictures", progress, [&](uint32_t i) {
        all[i] = brightness_of(read_sample_picture(scene, i, max_side).picture, black);
    });
    return all;
}

// Pictures that show more than black and white, from dark to bright. Failure (not usable) if there are fewer than two.
std::vector<uint32_t> by_brightness(const std::vector<Brightness> &all, const Scene &scene) {
    constexpr double least_grey = 1e-3;
    std::vector<uint32_t> members;
    for (uint32_t i = 0; i < all.size(); i++)
        if (all[i].grey_share >= least_grey) members.push_back(i);
    if (members.size() < 2)
        throw Failure(LENSPROF_ERROR_NO_SAMPLES,
                      scene.path
                          + format(": of %zu pictures all but %zu are entirely black or white; give pictures of "
                                   "exposures in between",
                                   all.size(), members.size()));
    std::stable_sort(members.begin(), members.end(), [&](uint32_t a, uint32_t b) { return all[a].mean < all[b].mean; });
    return members;
}

// The members of each group; the common ones come first.
std::vector<std::vector<uint32_t>> groups_of(const std::vector<uint32_t> &members) {
    const auto count = static_cast<uint32_t>(members.size());
    if (count <= sweep_in_memory) return {members};
    std::vector<uint32_t> common, others;
    for (uint32_t k = 0; k < common_pictures; k++) common.push_back(members[k * (count - 1) / (common_pictures - 1)]);
    for (const uint32_t member : members)
        if (std::find(common.begin(), common.end(), member) == common.end()) others.push_back(member);
    const uint32_t per_group = sweep_in_memory - common_pictures;
    std::vector<std::vector<uint32_t>> groups((others.size() + per_group - 1) / per_group, common);
    for (size_t n = 0; n < others.size(); n++) groups[n % groups.size()].push_back(others[n]);
    return groups;
}

Scene part_of(const Scene &scene, const std::vector<uint32_t> &members) {
    Scene part;
    part.path = scene.path;
    for (const uint32_t i : members) {
        part.images.push_back(scene.images[i]);
        part.names.push_back(scene.names[i]);
        part.files.push_back(scene.files[i]);
    }
    return part;
}

class GroupSampler {
public:
    GroupSampler(const Scene &scene, uint32_t max_side, double black, Events &progress)
        : scene_(scene), max_side_(max_side), black_(black), progress_(progress) {}

    // Reads the pictures of a group, except those that the group before has at the same place.
    void read(const std::vector<uint32_t> &members) {
        pictures_.resize(members.size());
        std::vector<uint32_t> fresh;
        for (uint32_t n = 0; n < members.size(); n++)
            if (n >= members_.size() || members_[n] != members[n]) fresh.push_back(n);
        for_each_parallel(static_cast<uint32_t>(fresh.size()), "reading pictures", progress_, [&](uint32_t k) {
            pictures_[fresh[k]] = read_sample_picture(scene_, members[fresh[k]], max_side_);
        });
        members_ = members;
    }

    uint32_t channels() const { return channel_count(pictures_); }

    // Adds their pairs; nothing if no two of them share grey values, which `no_pairs` then states.
    void sample(const lensprof_sample_options &options, std::vector<lensprof_pair> &pairs,
                std::optional<Failure> &no_pairs) {
        try {
            for (lensprof_pair pair : sample_still(part_of(scene_, members_), pictures_, options, black_, progress_)) {
                for (uint32_t &image : pair.image) image = members_[image];
                pairs.push_back(pair);
            }
        } catch (const Failure &failure) {
            if (failure.group() != LENSPROF_ERROR_NOT_USABLE) throw;
            no_pairs = failure;
        }
    }

private:
    const Scene &scene_;
    uint32_t max_side_;
    double black_;
    Events &progress_;
    std::vector<uint32_t> members_;
    std::vector<SamplePicture> pictures_;
};

uint32_t pair_count(size_t pictures, uint32_t requested) {
    if (requested) return requested;
    const auto count = static_cast<uint32_t>(pictures);
    if (count <= sweep_in_memory) return count * pairs_per_picture;
    return std::max(std::min(count * pairs_per_picture, enough_pairs), count * least_pairs_per_picture);
}

std::vector<std::vector<uint32_t>> choose_groups(const Scene &scene, uint32_t max_side, double black,
                                                 Events &progress) {
    if (scene.files.size() > sweep_in_memory)
        return groups_of(by_brightness(measure(scene, max_side, black / 255.0, progress), scene));
    std::vector<uint32_t> all(scene.files.size());
    std::iota(all.begin(), all.end(), 0u);
    return {all};
}

}  // namespace

SweepPairs sample_sweep(const Scene &scene, uint32_t max_side, lensprof_sample_options options, double black,
                        Events &progress) {
    auto clock = std::chrono::steady_clock::now();
    SweepPairs result;
    const auto groups = choose_groups(scene, max_side, black, progress);
    options.pairs = std::max(1u, pair_count(scene.files.size(), options.pairs) / static_cast<uint32_t>(groups.size()));
    GroupSampler sampler(scene, max_side, black, progress);
    std::optional<Failure> no_pairs;
    for (const auto &group : groups) {
        sampler.read(group);
        result.channels = std::max(result.channels, sampler.channels());
        result.load_s += lap(clock);
        sampler.sample(options, result.pairs, no_pairs);
        options.seed++;  // other places
        result.sample_s += lap(clock);
    }
    if (result.pairs.empty() && no_pairs) throw *no_pairs;
    return result;
}

}  // namespace lensprof
