#include "photo/scene/sampling.hpp"
#include "photo/scene/scene_pictures.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "fit/base/track_pairs.hpp"

namespace lensprof {
namespace {

int on_sampling(double done, void *progress) {
    static_cast<Events *>(progress)->update("sampling", done);
    return is_cancelled();
}

}  // namespace

lensprof_sample_image sample_image(const Scene &scene, uint32_t i, SamplePicture &picture, const GreyRange &range) {
    lensprof_sample_image image;
    lensprof_sample_image_init(&image);
    image.view = picture.picture.view();
    image.camera = scene.images[i].camera;
    image.reduction = picture.picture.reduction;
    image.mask = picture.mask.empty() ? nullptr : picture.mask.data();
    image.mask_row_bytes = static_cast<ptrdiff_t>(picture.picture.width);
    image.black = range.black;
    image.white = range.white;
    image.every_pixel = range.every_pixel;
    return image;
}

namespace {

// Samples with lensprof_sample_overlap, lensprof_sample_tracks or lensprof_sample_matches.
template <class Item, class Function>
std::vector<Item> sample(const Scene &scene, std::vector<SamplePicture> &pictures, lensprof_sample_options options,
                         const GreyRange &range, Events &progress, std::vector<lensprof_link> *links,
                         Function function) {
    std::vector<lensprof_sample_image> images;
    for (size_t i = 0; i < pictures.size(); i++) {
        images.push_back(sample_image(scene, static_cast<uint32_t>(i), pictures[i], range));
    }
    lensprof_error error{};
    uint32_t found = 0;
    auto count = static_cast<uint32_t>(images.size());
    check_named(function(&options, images.data(), count, nullptr, 0, &found, &error), scene.path, error,
                LENSPROF_ITEM_IMAGE, scene.names);
    std::vector<Item> items(found);
    options.progress = on_sampling;
    options.progress_user = &progress;
    uint32_t link_count = 0;
    if (links) {
        links->resize(std::min<size_t>(size_t(count) * (count - 1) / 2, 1 << 20));
        options.links = links->data();
        options.link_capacity = static_cast<uint32_t>(links->size());
        options.link_count = &link_count;
    }
    lensprof_status status = function(&options, images.data(), count, items.data(), found, &found, &error);
    stop_if_cancelled();
    check_named(status, scene.path, error, LENSPROF_ITEM_IMAGE, scene.names);
    items.resize(found);
    if (links) links->resize(std::min<size_t>(links->size(), link_count));
    return items;
}

using ImagePair = std::pair<uint32_t, uint32_t>;

template <class Item>
ImagePair images_of(const Item &item) {
    return std::minmax(item.image[0], item.image[1]);
}

// The pairs and links of one way of sampling; empty if it finds nothing, with the reason in `no_samples`.
template <class Sample>
std::vector<lensprof_pair> sample_or_empty(const Sample &sample_pairs, std::vector<lensprof_link> &links,
                                           std::optional<Failure> &no_samples) {
    try {
        return sample_pairs();
    } catch (const Failure &failure) {
        if (failure.group() != LENSPROF_ERROR_NOT_USABLE) throw;
        no_samples = failure;
        links.clear();
        return {};
    }
}

// Pairs at the project's matches, in proportion to the share of their links, and pairs through the cameras between
// other images.
std::vector<lensprof_pair> sample_matches(const Scene &scene, std::vector<SamplePicture> &pictures,
                                          lensprof_sample_options options, const GreyRange &range, Events &progress,
                                          std::vector<lensprof_link> &links) {
    std::set<ImagePair> matched;
    for (const lensprof_match &match : scene.matches) matched.insert(images_of(match));
    std::optional<Failure> no_samples;
    std::vector<lensprof_pair> pairs;
    const auto by_cameras = [&] {
        return sample<lensprof_pair>(scene, pictures, options, range, progress, &links, lensprof_sample_overlap);
    };
    if (!scene.by_matches) pairs = sample_or_empty(by_cameras, links, no_samples);
    const auto is_matched = [&](const auto &item) { return matched.count(images_of(item)) > 0; };
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_matched), pairs.end());
    links.erase(std::remove_if(links.begin(), links.end(), is_matched), links.end());
    const size_t pair_count = options.pairs ? options.pairs : std::max<size_t>(2000, 300 * pictures.size());
    options.pairs =
        static_cast<uint32_t>(std::max<size_t>(1, pair_count * matched.size() / (matched.size() + links.size())));
    std::vector<lensprof_link> match_links;
    const auto by_matches = [&](const lensprof_sample_options *o, const lensprof_sample_image *images, uint32_t count,
                                lensprof_pair *match_pairs, uint32_t capacity, uint32_t *found, lensprof_error *error) {
        return lensprof_sample_matches(o, images, count, scene.matches.data(),
                                       static_cast<uint32_t>(scene.matches.size()), match_pairs, capacity, found,
                                       error);
    };
    const auto at_matches = [&] {
        return sample<lensprof_pair>(scene, pictures, options, range, progress, &match_links, by_matches);
    };
    const auto match_pairs = sample_or_empty(at_matches, match_links, no_samples);
    if (pairs.empty() && match_pairs.empty() && no_samples) throw *no_samples;
    pairs.insert(pairs.end(), match_pairs.begin(), match_pairs.end());
    links.insert(links.end(), match_links.begin(), match_links.end());
    std::sort(links.begin(), links.end(), [](const auto &a, const auto &b) { return images_of(a) < images_of(b); });
    return pairs;
}

}  // namespace

std::vector<lensprof_pair> sample_pairs(const Scene &scene, std::vector<SamplePicture> &pictures,
                                        lensprof_sample_options options, const GreyRange &range, Events &progress,
                                        std::vector<lensprof_link> *links) {
    std::vector<lensprof_link> unused_links;
    if (!scene.matches.empty() && options.sampling == LENSPROF_SAMPLING_BALANCED)
        return sample_matches(scene, pictures, options, range, progress, links ? *links : unused_links);
    auto pairs = sample<lensprof_pair>(scene, pictures, options, range, progress, links, lensprof_sample_overlap);
    move_places(scene, 1.0, pairs);
    return pairs;
}

std::vector<lensprof_observation> sample_tracks(const Scene &scene, std::vector<SamplePicture> &pictures,
                                                lensprof_sample_options options, Events &progress,
                                                std::vector<lensprof_link> *links) {
    auto places = sample<lensprof_observation>(scene, pictures, options, {}, progress, links, lensprof_sample_tracks);
    for (lensprof_observation &place : places) move_place(scene, place.image, 1.0, place.xy);
    return places;
}

std::vector<lensprof_pair> pairs_of_tracks(const std::vector<lensprof_observation> &observations) {
    std::vector<lensprof_pair> pairs;
    const auto takes = [](const lensprof_observation &o) {
        return *std::max_element(o.value, o.value + 3) <= GreyRange{}.white;
    };
    add_track_pairs(observations.data(), observations.data() + observations.size(), takes, pairs);
    return pairs;
}

}  // namespace lensprof
