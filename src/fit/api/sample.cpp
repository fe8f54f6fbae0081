// The C functions of sampling, and what they refuse.
#include <algorithm>
#include <new>
#include <vector>

#include "fit/base/fail.hpp"
#include "fit/sampling/sampler.hpp"

using namespace lensprof;

namespace {

constexpr uint32_t kLargestCount = 1u << 24;

lensprof_status check_image(const lensprof_sample_image &image, uint32_t i, lensprof_error *error) {
    lensprof_status status = lensprof_camera_validate(&image.camera);
    if (status != LENSPROF_OK) return fail(status, error, "image %u: not a valid camera", i);
    return check_view(image, i, error);
}

lensprof_status check_options(const lensprof_sample_options &options, uint32_t count, lensprof_error *error) {
    if (options.struct_size != sizeof options)
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "sample options: call lensprof_sample_options_init first");
    if (count < 2) return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: at least two images are needed");
    if (options.sampling > LENSPROF_SAMPLING_BRACKET || options.pairs > kLargestCount || count > kLargestCount / 300
        || options.reserved)
        return fail(LENSPROF_ERROR_ARGUMENT, error,
                    "sample: unknown sampling, reserved not 0, or too many images or pairs");
    return LENSPROF_OK;
}

// draw(sampler) -> what was found.
template <class Item, class Draw>
lensprof_status sample(const lensprof_sample_options &options, const lensprof_sample_image *images, uint32_t count,
                       Draw draw, std::vector<Item> &items, lensprof_error *error) {
    try {
        auto stop = [&] { return options.progress && options.progress(0.0, options.progress_user) != 0; };
        auto image = [&](uint32_t i) { return images[i]; };
        lensprof_status status = check_finite(image, count, options.threads, stop, error);
        if (status != LENSPROF_OK) return status;
        Sampler sampler(options, images, count);
        items = draw(sampler);
        if (items.empty() && options.sampling == LENSPROF_SAMPLING_BRACKET)
            return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                        "no two images show the same place between black and white: they may be of different scenes, "
                        "too far apart in exposure, masked, or one may be all black or white");
        if (!sampler.overlaps())
            return fail(LENSPROF_ERROR_NO_OVERLAP, error, "no two images overlap; check the alignment of the project");
        if (items.empty())
            return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                        "the images overlap, but every sample there is masked, black or saturated, or does not show "
                        "the same in both; check the alignment of the project");
        return LENSPROF_OK;
    } catch (const Cancelled &) {
        return fail(LENSPROF_ERROR_CANCELLED, error, "sample: cancelled");
    } catch (const std::bad_alloc &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "sample: out of memory");
    } catch (const std::exception &e) {
        return fail(LENSPROF_ERROR_INTERNAL, error, "sample: %s", e.what());
    }
}

// Both samplings: `room` for what is wanted, what `draw` finds into `items`.
template <class Item, class Draw>
lensprof_status sample_into(const lensprof_sample_options *options, const lensprof_sample_image *images, uint32_t count,
                            uint64_t room, Item *items, uint32_t capacity, uint32_t *found, Draw draw,
                            lensprof_error *error) {
    if (capacity == 0) {
        *found = static_cast<uint32_t>(room);
        return LENSPROF_OK;
    }
    if (capacity < room)
        return fail(LENSPROF_ERROR_CAPACITY, error, "sample: room for %u items is needed", static_cast<uint32_t>(room));
    lensprof_status status = LENSPROF_OK;
    for (uint32_t i = 0; i < count && status == LENSPROF_OK; i++) status = check_image(images[i], i, error);
    if (status != LENSPROF_OK) return status;
    std::vector<Item> result;
    status = sample(*options, images, count, draw, result, error);
    if (status != LENSPROF_OK) return status;
    std::copy(result.begin(), result.end(), items);
    *found = static_cast<uint32_t>(result.size());
    return LENSPROF_OK;
}

}  // namespace

extern "C" {

void lensprof_sample_options_init(lensprof_sample_options *options) {
    *options = lensprof_sample_options{};
    options->struct_size = sizeof *options;
    options->seed = 1;
}

lensprof_status lensprof_sample_overlap(const lensprof_sample_options *options, const lensprof_sample_image *images,
                                        uint32_t count, lensprof_pair *pairs, uint32_t capacity, uint32_t *found,
                                        lensprof_error *error) {
    if (error) error->text[0] = 0;
    if (!options || !images || !found || (capacity && !pairs))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: a pointer is NULL");
    lensprof_status status = check_options(*options, count, error);
    if (status != LENSPROF_OK) return status;
    uint32_t wanted = options->pairs ? options->pairs : std::max(2000u, 300 * count);
    auto draw = [&](Sampler &sampler) {
        return options->sampling == LENSPROF_SAMPLING_PAPER ? sampler.paper(wanted) : sampler.balanced(wanted);
    };
    return sample_into(options, images, count, wanted, pairs, capacity, found, draw, error);
}

lensprof_status lensprof_sample_tracks(const lensprof_sample_options *options, const lensprof_sample_image *images,
                                       uint32_t count, lensprof_observation *observations, uint32_t capacity,
                                       uint32_t *found, lensprof_error *error) {
    if (error) error->text[0] = 0;
    if (!options || !images || !found || (capacity && !observations))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "sample: a pointer is NULL");
    lensprof_status status = check_options(*options, count, error);
    if (status != LENSPROF_OK) return status;
    uint32_t wanted = options->pairs ? options->pairs : std::max(2000u, 150 * count);
    auto draw = [&](Sampler &sampler) {
        return options->sampling == LENSPROF_SAMPLING_PAPER ? sampler.paper_tracks(wanted)
                                                            : sampler.balanced_tracks(wanted);
    };
    uint64_t room = uint64_t{wanted} * std::min(count, kLongestTrack);
    return sample_into(options, images, count, room, observations, capacity, found, draw, error);
}

}  // extern "C"
