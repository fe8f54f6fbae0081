// The C interface of sampling and its argument checks.
#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

#include "fit/api/boundary.hpp"
#include "fit/base/sized.hpp"
#include "fit/sampling/sampler.hpp"

using namespace lensprof;

namespace {

constexpr uint32_t kLargestCount = 1u << 24;
constexpr size_t kFirstSampleOptions = LP_END_OF(lensprof_sample_options, progress_user);
constexpr size_t kFirstSampleImage = LP_END_OF(lensprof_sample_image, white);

// `by_cameras`: otherwise only width and height of the camera are checked.
lensprof_status check_image(const lensprof_sample_image &image, uint32_t i, bool by_cameras, lensprof_error *error) {
    if (image.reserved) return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error, "reserved is not 0");
    const lensprof_status status = by_cameras ? lensprof_camera_validate(&image.camera) : LENSPROF_OK;
    if (status != LENSPROF_OK) return fail_at(LENSPROF_ITEM_IMAGE, i, status, error, "the camera is invalid");
    return check_view(image, i, error);
}

lensprof_status check_options(const lensprof_sample_options &options, uint32_t count, lensprof_error *error) {
    if (count < 2) return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: at least two images are needed");
    const Rule rules[] = {
        {options.sampling <= LENSPROF_SAMPLING_BRACKET, "sampling must be one of lensprof_sampling, 0..2"},
        {options.pairs <= kLargestCount, "pairs must be 0..16777216"},
        {!options.reserved && !options.reserved2, "reserved and reserved2 must be 0"},
        {options.links || !options.link_capacity, "links must not be NULL if link_capacity is not 0"},
    };
    if (const char *wrong = first_broken(rules))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample options: %s", wrong);
    if (count > kLargestCount / 300)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: %u images; give at most %u", count, kLargestCount / 300);
    lensprof_status status = options.response ? lensprof_response_validate(options.response) : LENSPROF_OK;
    if (status != LENSPROF_OK)
        return fail(status, error, "sample: the response is invalid; see lensprof_response_validate");
    if (options.vignetting) status = lensprof_vignetting_validate(options.vignetting);
    if (status != LENSPROF_OK)
        return fail(status, error, "sample: the falloff is invalid; see lensprof_vignetting_validate");
    return LENSPROF_OK;
}

// Converts the caller's options to this library's struct version.
lensprof_status take_options(const lensprof_sample_options *given, uint32_t count, lensprof_sample_options &options,
                             lensprof_error *error) {
    lensprof_sample_options_init(&options);
    if (const char *wrong = lp_sized_take(&options, given, kFirstSampleOptions))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "sample options: %s", wrong);
    return check_options(options, count, error);
}

void give_links(const lensprof_sample_options &options, const std::vector<lensprof_link> &links) {
    const size_t capacity = options.links ? std::min<size_t>(links.size(), options.link_capacity) : 0;
    std::copy_n(links.begin(), capacity, options.links);
    if (options.link_count) *options.link_count = static_cast<uint32_t>(links.size());
}

struct Matches {
    const lensprof_match *list = nullptr;
    uint32_t count = 0;
};

lensprof_status check_matches(const Matches &matches, const std::vector<lensprof_sample_image> &images,
                              lensprof_error *error) {
    for (uint32_t m = 0; m < matches.count; m++) {
        const lensprof_match &match = matches.list[m];
        const auto wrong = [&](const char *text) {
            return fail_at(LENSPROF_ITEM_MATCH, m, LENSPROF_ERROR_ARGUMENT, error, "%s", text);
        };
        if (match.image[0] == match.image[1] || std::max(match.image[0], match.image[1]) >= images.size())
            return wrong("image must be two different images of images[]");
        for (int side = 0; side < 2; side++) {
            const lensprof_camera &camera = images[match.image[side]].camera;
            const double *xy = match.xy[side];
            if (!(xy[0] >= -1.0 && xy[1] >= -1.0 && xy[0] <= camera.width && xy[1] <= camera.height))
                return wrong("xy is outside its image");
        }
        const auto &map = match.map;
        const double turns = map[0][0] * map[1][1] - map[0][1] * map[1][0];
        const bool is_given = map[0][0] != 0.0 || map[0][1] != 0.0 || map[1][0] != 0.0 || map[1][1] != 0.0;
        if (is_given && !(turns > 0.0 && turns < HUGE_VAL))
            return wrong("map must have a positive determinant, or be all 0");
    }
    return LENSPROF_OK;
}

Sampler sampler_of(const lensprof_sample_options &options, const std::vector<lensprof_sample_image> &images,
                   const Matches *matches) {
    const auto count = static_cast<uint32_t>(images.size());
    return matches ? Sampler(options, images.data(), count, matches->list, matches->count)
                   : Sampler(options, images.data(), count);
}

// Runs draw(sampler), which returns what was found; by `matches`, or by the cameras if that is NULL.
template <class Item, class Draw>
lensprof_status sample(const lensprof_sample_options &options, const lensprof_sample_image *given, uint32_t count,
                       const Matches *matches, Draw draw, std::vector<Item> &items, lensprof_error *error) {
    return at_boundary("sample", error, [&] {
        std::vector<lensprof_sample_image> images;
        auto init = [](lensprof_sample_image &image, uint32_t) { lensprof_sample_image_init(&image); };
        lensprof_status status = take_all(given, count, kFirstSampleImage, LENSPROF_ITEM_IMAGE, init, images, error);
        for (uint32_t i = 0; i < count && status == LENSPROF_OK; i++)
            status = check_image(images[i], i, !matches, error);
        if (matches && status == LENSPROF_OK) status = check_matches(*matches, images, error);
        if (status != LENSPROF_OK) return status;
        auto stop = [&] { return options.progress && options.progress(0.0, options.progress_user) != 0; };
        auto image = [&](uint32_t i) { return images[i]; };
        status = check_finite(image, count, options.threads, stop, error);
        if (status != LENSPROF_OK) return status;
        Sampler sampler = sampler_of(options, images, matches);
        items = draw(sampler);
        if (items.empty() && options.sampling == LENSPROF_SAMPLING_BRACKET)
            return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                        "no two images show the same place between black and white: they may show different scenes, be "
                        "too far apart in exposure or masked, or one may be entirely black or white");
        if (!sampler.overlaps())
            return fail(LENSPROF_ERROR_NO_OVERLAP, error, "no two images overlap; check their alignment");
        if (items.empty())
            return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                        "the images overlap, but every sample there is masked, black or saturated, or shows "
                        "different content in the two images; check their alignment");
        give_links(options, sampler.links());
        return LENSPROF_OK;
    });
}

// Common to both samplings: writes up to `max_items` results of `draw` into `items`.
template <class Item, class Draw>
lensprof_status sample_into(const lensprof_sample_options &options, const lensprof_sample_image *images,
                            uint32_t image_count, const Matches *matches, uint64_t max_items, Item *items,
                            uint32_t capacity, uint32_t *count, Draw draw, lensprof_error *error) {
    if (options.link_count) *options.link_count = 0;
    if (capacity < max_items) *count = static_cast<uint32_t>(max_items);
    if (capacity == 0) return LENSPROF_OK;
    if (capacity < max_items)
        return fail(LENSPROF_ERROR_CAPACITY, error, "sample: the buffer is too small; provide room for %u items",
                    static_cast<uint32_t>(max_items));
    std::vector<Item> result;
    const lensprof_status status = sample(options, images, image_count, matches, draw, result, error);
    if (status != LENSPROF_OK) return status;
    std::copy(result.begin(), result.end(), items);
    *count = static_cast<uint32_t>(result.size());
    return LENSPROF_OK;
}

uint32_t wanted_pairs(const lensprof_sample_options &options, uint32_t image_count) {
    return options.pairs ? options.pairs : std::max(2000u, 300 * image_count);
}

}  // namespace

extern "C" {

void lensprof_sample_options_init_sized(lensprof_sample_options *options, size_t size) {
    if (lp_sized_begin(options, size, kFirstSampleOptions)) options->seed = 1;
}

void lensprof_sample_image_init_sized(lensprof_sample_image *image, size_t size) {
    if (!lp_sized_begin(image, size, kFirstSampleImage)) return;
    image->reduction = 1;
    image->black = 2.0 / 255.0;
    image->white = 250.0 / 255.0;
}

lensprof_status lensprof_sample_overlap(const lensprof_sample_options *given, const lensprof_sample_image *images,
                                        uint32_t image_count, lensprof_pair *pairs, uint32_t capacity, uint32_t *count,
                                        lensprof_error *error) {
    clear(error);
    if (!given || !images || !count || (capacity && !pairs))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: a pointer is NULL");
    lensprof_sample_options options;
    lensprof_status status = take_options(given, image_count, options, error);
    if (status != LENSPROF_OK) return status;
    const uint32_t wanted = wanted_pairs(options, image_count);
    auto draw = [&](Sampler &sampler) {
        return options.sampling == LENSPROF_SAMPLING_PAPER ? sampler.paper(wanted) : sampler.balanced(wanted);
    };
    return sample_into(options, images, image_count, nullptr, wanted, pairs, capacity, count, draw, error);
}

lensprof_status lensprof_sample_tracks(const lensprof_sample_options *given, const lensprof_sample_image *images,
                                       uint32_t image_count, lensprof_observation *observations, uint32_t capacity,
                                       uint32_t *count, lensprof_error *error) {
    clear(error);
    if (!given || !images || !count || (capacity && !observations))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: a pointer is NULL");
    lensprof_sample_options options;
    lensprof_status status = take_options(given, image_count, options, error);
    if (status != LENSPROF_OK) return status;
    uint32_t wanted = options.pairs ? options.pairs : std::max(2000u, 150 * image_count);
    auto draw = [&](Sampler &sampler) {
        return options.sampling == LENSPROF_SAMPLING_PAPER ? sampler.paper_tracks(wanted)
                                                           : sampler.balanced_tracks(wanted);
    };
    uint64_t max_items = uint64_t{wanted} * std::min(image_count, kLongestTrack);
    return sample_into(options, images, image_count, nullptr, max_items, observations, capacity, count, draw, error);
}

lensprof_status lensprof_sample_matches(const lensprof_sample_options *given, const lensprof_sample_image *images,
                                        uint32_t image_count, const lensprof_match *matches, uint32_t match_count,
                                        lensprof_pair *pairs, uint32_t capacity, uint32_t *count,
                                        lensprof_error *error) {
    clear(error);
    if (!given || !images || !count || (capacity && !pairs) || (match_count && !matches))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: a pointer is NULL");
    lensprof_sample_options options;
    const lensprof_status status = take_options(given, image_count, options, error);
    if (status != LENSPROF_OK) return status;
    if (options.sampling == LENSPROF_SAMPLING_PAPER)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: paper sampling does not support matches; use balanced");
    const uint32_t wanted = wanted_pairs(options, image_count);
    const Matches match_list{matches, match_count};
    auto draw = [&](Sampler &sampler) {
        return sampler.of_matches(matches, match_count, wanted, options.match_of_pair);
    };
    return sample_into(options, images, image_count, &match_list, wanted, pairs, capacity, count, draw, error);
}

}  // extern "C"
