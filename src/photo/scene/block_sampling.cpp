#include "photo/scene/block_sampling.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "photo/base/events.hpp"
#include "photo/base/parallel.hpp"
#include "photo/reconstruction/link_order.hpp"
#include "photo/scene/sampling.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

using ImagePair = std::pair<uint32_t, uint32_t>;

ImagePair images_of(const lensprof_match &match) { return std::minmax(match.image[0], match.image[1]); }

struct Block {
    std::vector<uint32_t> images;
    std::vector<SamplePicture> pictures;  // read when needed
};

// The matches between two blocks, or within one, with block-local image indices.
struct BlockMatches {
    std::vector<uint32_t> images;  // index in the project
    std::vector<lensprof_sample_image> views;
    std::vector<lensprof_match> matches;
    size_t links = 0;
};

class BlockSampler {
public:
    BlockSampler(const Scene &scene, const lensprof_sample_options &options, uint32_t max_side, uint64_t block_bytes,
                 Events &progress);

    void run();

    std::vector<lensprof_pair> pairs;
    std::vector<lensprof_link> links;
    std::vector<uint32_t> points;
    uint32_t channels = 1;

private:
    uint64_t bytes_of(uint32_t image) const;
    void read(Block &block);
    // Samples two blocks, which may be the same, at the matches with these indices.
    BlockMatches matches_between(Block &a, Block &b, const std::vector<uint32_t> &numbers) const;
    void sample(Block &a, Block &b, const std::vector<uint32_t> &numbers);

    const Scene &scene_;
    const lensprof_sample_options options_;
    const uint32_t max_side_;
    Events &progress_;
    LinkWeights matches_of_link_;
    std::vector<Block> blocks_;
    std::vector<uint32_t> block_of_;  // per image
    std::string no_samples_reason_;   // why a sampling found nothing
};

BlockSampler::BlockSampler(const Scene &scene, const lensprof_sample_options &options, uint32_t max_side,
                           uint64_t block_bytes, Events &progress)
    : scene_(scene), options_(options), max_side_(max_side), progress_(progress) {
    for (const lensprof_match &match : scene.matches) matches_of_link_[images_of(match)]++;
    const auto count = static_cast<uint32_t>(scene.images.size());
    block_of_.resize(count);
    uint64_t bytes = block_bytes;  // so that the first image starts a block
    for (const uint32_t image : order_by_links(count, matches_of_link_)) {
        const uint64_t image_bytes = bytes_of(image);
        if (bytes + image_bytes > block_bytes) blocks_.emplace_back(), bytes = 0;
        bytes += image_bytes;
        block_of_[image] = static_cast<uint32_t>(blocks_.size() - 1);
        blocks_.back().images.push_back(image);
    }
}

uint64_t BlockSampler::bytes_of(uint32_t image) const {
    ReadOptions options;
    options.max_side = max_side_;
    return bytes_in_memory(scene_, read_header(scene_.files[image], options));
}

void BlockSampler::read(Block &block) {
    block.pictures.resize(block.images.size());
    for_each_parallel(static_cast<uint32_t>(block.images.size()), "reading pictures", progress_,
                      [&](uint32_t n) { block.pictures[n] = read_sample_picture(scene_, block.images[n], max_side_); });
    channels = std::max(channels, channel_count(block.pictures));
}

BlockMatches BlockSampler::matches_between(Block &a, Block &b, const std::vector<uint32_t> &numbers) const {
    BlockMatches found;
    std::vector<uint32_t> number(scene_.images.size());
    for (Block *block : {&a, &b}) {
        for (size_t n = 0; n < block->images.size(); n++) {
            number[block->images[n]] = static_cast<uint32_t>(found.images.size());
            found.images.push_back(block->images[n]);
            found.views.push_back(sample_image(scene_, block->images[n], block->pictures[n], {}));
        }
        if (&a == &b) break;
    }
    std::set<ImagePair> linked_images;
    for (const uint32_t m : numbers) {
        found.matches.push_back(scene_.matches[m]);
        linked_images.insert(images_of(scene_.matches[m]));
        for (uint32_t &image : found.matches.back().image) image = number[image];
    }
    found.links = linked_images.size();
    return found;
}

void BlockSampler::sample(Block &a, Block &b, const std::vector<uint32_t> &numbers) {
    const BlockMatches input = matches_between(a, b, numbers);
    lensprof_sample_options options = options_;
    const size_t total_pairs = options.pairs ? options.pairs : scene_.matches.size();
    options.pairs =
        static_cast<uint32_t>(std::max<size_t>(1, total_pairs * input.matches.size() / scene_.matches.size()));
    std::vector<lensprof_pair> found(options.pairs);
    std::vector<uint32_t> match_of_pair(options.pairs);
    std::vector<lensprof_link> found_links(input.links);
    uint32_t count = 0, link_count = 0;
    options.match_of_pair = match_of_pair.data();
    options.links = found_links.data(), options.link_capacity = static_cast<uint32_t>(input.links);
    options.link_count = &link_count;
    lensprof_error error{};
    const lensprof_status status = lensprof_sample_matches(
        &options, input.views.data(), static_cast<uint32_t>(input.views.size()), input.matches.data(),
        static_cast<uint32_t>(input.matches.size()), found.data(), options.pairs, &count, &error);
    if (status == LENSPROF_ERROR_NO_SAMPLES || status == LENSPROF_ERROR_NO_OVERLAP) {
        no_samples_reason_ = error.text;
        return;
    }
    std::vector<std::string> names;
    for (const uint32_t image : input.images) names.push_back(scene_.names[image]);
    check_named(status, scene_.path, error, LENSPROF_ITEM_IMAGE, names);
    for (uint32_t p = 0; p < count; p++) {
        for (uint32_t &image : found[p].image) image = input.images[image];
        pairs.push_back(found[p]);
        points.push_back(scene_.match_points[numbers[match_of_pair[p]]]);
    }
    found_links.resize(std::min<size_t>(found_links.size(), link_count));
    for (lensprof_link &link : found_links) {
        const auto [first, second] = std::minmax(input.images[link.image[0]], input.images[link.image[1]]);
        links.push_back({{first, second}, link.state, link.pairs});
    }
}

void BlockSampler::run() {
    std::map<ImagePair, std::vector<uint32_t>> matches_of_blocks;
    for (uint32_t m = 0; m < scene_.matches.size(); m++) {
        const uint32_t *image = scene_.matches[m].image;
        matches_of_blocks[std::minmax(block_of_[image[0]], block_of_[image[1]])].push_back(m);
    }
    size_t done = 0;
    uint32_t loaded = UINT32_MAX;  // the block kept in memory for pairs with later ones
    for (const auto &[numbers, matches] : matches_of_blocks) {
        stop_if_cancelled();
        Block &a = blocks_[numbers.first], &b = blocks_[numbers.second];
        if (loaded != numbers.first) {
            if (loaded != UINT32_MAX) blocks_[loaded].pictures.clear();
            read(a);
            loaded = numbers.first;
        }
        if (&a != &b) read(b);
        sample(a, b, matches);
        if (&a != &b) b.pictures.clear();
        progress_.update("sampling", double(++done) / double(matches_of_blocks.size()));
    }
    if (pairs.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE, scene_.path + ": " + no_samples_reason_, LENSPROF_REASON_FEW_PAIRS);
    std::sort(links.begin(), links.end(), [](const lensprof_link &a, const lensprof_link &b) {
        return std::pair(a.image[0], a.image[1]) < std::pair(b.image[0], b.image[1]);
    });
}

}  // namespace

std::vector<lensprof_pair> sample_in_blocks(const Scene &scene, const lensprof_sample_options &options,
                                            uint32_t max_side, uint64_t block_bytes, Events &progress,
                                            std::vector<lensprof_link> &links, std::vector<uint32_t> &points,
                                            uint32_t *channels) {
    BlockSampler sampler(scene, options, max_side, block_bytes, progress);
    sampler.run();
    links = std::move(sampler.links), points = std::move(sampler.points);
    *channels = sampler.channels;
    return std::move(sampler.pairs);
}

}  // namespace lensprof
