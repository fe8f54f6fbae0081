#include "photo/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>

#include <sys/resource.h>
#include <unistd.h>

#include "photo/base/events.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

uint32_t find_reference(const Scene &scene) {
    for (uint32_t i = 0; i < scene.images.size(); i++)
        if (!(scene.images[i].free & LENSPROF_FREE_EV)) return i;
    return 0;
}

// Failure if the frame of a picture differs from that of the project.
void check_size(const Scene &scene, uint32_t i, const Picture &header) {
    const auto &camera = scene.images[i].camera;
    if (header.frame_width == camera.width && header.frame_height == camera.height) return;
    throw Failure(
        LENSPROF_ERROR_READ,
        scene.files[i] + format(": is %u x %u pixels, but ", header.frame_width, header.frame_height) + scene.path
            + format(" states %u x %u; use the pictures that the project was made with", camera.width, camera.height));
}

// No file can have such a name: the project is damaged.
void check_name(const Scene &scene, uint32_t i) {
    if (scene.names[i].empty())
        throw Failure(LENSPROF_ERROR_READ, scene.path + ": image " + std::to_string(i)
                                               + " has no file name (its n is empty or missing); correct the project");
    if (is_too_long(scene.files[i]))
        throw Failure(LENSPROF_ERROR_READ, scene.path + ": image " + std::to_string(i) + ": its name "
                                               + short_name(scene.names[i])
                                               + " is too long for a file name; correct the project");
}

// The available memory: project_max_bytes, or less if the machine or its process limit (ulimit -v) has less.
uint64_t available_memory() {
    uint64_t bound = scene_max_bytes;
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    if (pages > 0 && page_bytes > 0) bound = std::min(bound, uint64_t(pages) * uint64_t(page_bytes));
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        bound = std::min(bound, uint64_t(limit.rlim_cur));
    return bound;
}

int on_sampling(double done, void *progress) {
    static_cast<Events *>(progress)->update("sampling", done);
    return is_cancelled();
}

}  // namespace

void check_finite(const lensprof_image &rows, uint32_t first_row, uint32_t reduction, const std::string &file) {
    if (rows.sample != LENSPROF_SAMPLE_F32) return;
    uint32_t samples = lensprof_layout_samples(rows.layout);
    for (uint32_t y = 0; y < rows.height; y++) {
        const auto *row = reinterpret_cast<const float *>(static_cast<const uint8_t *>(rows.data)
                                                          + static_cast<ptrdiff_t>(y) * rows.row_bytes);
        for (uint32_t s = 0; s < rows.width * samples; s++)
            if (!std::isfinite(row[s]))
                throw Failure(LENSPROF_ERROR_READ, file + ": pixel " + std::to_string(s / samples * reduction) + ", "
                                                       + std::to_string((first_row + y) * reduction)
                                                       + " is not a finite number; repair the picture");
    }
}

FalloffFrame falloff_frame_of(const lensprof_pto_image &image) {
    const int32_t *crop = image.crop;
    if (!image.of_crop) return {0.0, 0.0, image.camera.width, image.camera.height};
    return {double(crop[0]), double(crop[1]), static_cast<uint32_t>(crop[2] - crop[0]),
            static_cast<uint32_t>(crop[3] - crop[1])};
}

bool has_crops(const Scene &scene) {
    return std::any_of(scene.images.begin(), scene.images.end(),
                       [](const lensprof_pto_image &image) { return image.of_crop != 0; });
}

void refuse_crops(const Scene &scene, const std::string &option) {
    if (!has_crops(scene)) return;
    throw Failure(LENSPROF_ERROR_ARGUMENT, option + ": does not support " + scene.path
                                       + ", whose images are crops of one file, such as its two circles; use build and "
                                         "apply without it, or give a file per image");
}

void add_image(Scene &scene) {
    lensprof_pto_image image;
    lensprof_pto_image_init(&image);
    lensprof_error error{};
    const auto next = static_cast<uint32_t>(scene.images.size());
    check(lensprof_pto_get_image(scene.pto.get(), next, &image, &error), scene.path, &error);
    scene.images.push_back(image);
}

Scene read_hugin_project(const std::string &path) {
    Scene scene;
    scene.path = path;
    scene.pto = read_pto(path);
    std::filesystem::path folder = std::filesystem::path(path).parent_path();
    for (uint32_t i = 0; i < lensprof_pto_image_count(scene.pto.get()); i++) {
        add_image(scene);
        scene.names.push_back(pto_name(*scene.pto, i));
        scene.files.push_back((folder / scene.names[i]).string());
        check_name(scene, i);
    }
    scene.reference = find_reference(scene);
    return scene;
}

std::string project_text_at(Scene &scene, const std::string &path) {
    const auto folder = std::filesystem::path(absolute_path(path)).parent_path();
    const bool keeps_names =
        is_regular_file(scene.path) && folder == std::filesystem::path(absolute_path(scene.path)).parent_path();
    lensprof_error error{};
    for (uint32_t i = 0; i < scene.files.size() && !keeps_names; i++) {
        const auto file = std::filesystem::path(absolute_path(scene.files[i])).lexically_proximate(folder);
        check(lensprof_pto_set_name(scene.pto.get(), i, file.string().c_str(), &error), scene.files[i], &error);
    }
    return pto_text(*scene.pto);
}

uint32_t image_of_word(const Scene &scene, const std::string &word) {
    for (uint32_t i = 0; i < scene.names.size(); i++)
        if (word == scene.names[i] || word == std::to_string(i)) return i;
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  word + ": not an image of " + scene.path + "; give the number or name of one");
}

ImagesByFile::ImagesByFile(const Scene &scene) : scene_(&scene) {
    for (uint32_t i = 0; i < scene.files.size(); i++) images_.emplace(file_identity(scene.files[i]), i);
}

std::optional<uint32_t> ImagesByFile::find(const std::string &file) const {
    const auto found = images_.find(file_identity(file));
    return found == images_.end() ? std::nullopt : std::optional<uint32_t>(found->second);
}

uint32_t ImagesByFile::at(const std::string &file, const std::string &option) const {
    if (const auto found = find(file)) return *found;
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  file + ": is not a picture of " + scene_->path + "; omit it, or omit " + option);
}

void check_pictures(const Scene &scene, uint32_t max_side) {
    ReadOptions options;
    options.max_side = max_side;
    uint64_t needed = 0;
    for (uint32_t i = 0; i < scene.files.size(); i++) {
        stop_if_cancelled();
        const Picture header = read_header(scene.files[i], options);
        check_size(scene, i, header);
        needed += header.row_bytes * header.height;
        if (scene.pto) needed += uint64_t(header.width) * header.height;  // its mask
    }
    const uint64_t bound = available_memory();
    if (needed > bound)
        throw Failure(LENSPROF_ERROR_READ,
                      scene.path
                          + format(": its %zu pictures need %.1f GiB of memory, but at most %.1f are available; give "
                                   "a smaller %s or fewer pictures",
                                   scene.files.size(), double(needed) / (1 << 30), double(bound) / (1 << 30),
                                   option_name("max_side").c_str()));
}

SamplePicture read_sample_picture(const Scene &scene, uint32_t i, uint32_t max_side) {
    const std::string &file = scene.files[i];
    SamplePicture result;
    ReadOptions options;
    options.max_side = max_side;
    result.picture = read_picture(file, options);
    const Picture &p = result.picture;
    check_size(scene, i, p);
    check_finite(result.picture.view(), 0, p.reduction, file);
    if (!scene.pto) return result;
    std::vector<uint8_t> mask(static_cast<size_t>(p.width) * p.height);
    lensprof_error error{};
    check(lensprof_pto_draw_mask(scene.pto.get(), i, mask.data(), p.width, p.height, static_cast<ptrdiff_t>(p.width),
                                 &error),
          file, &error);
    if (std::find(mask.begin(), mask.end(), 0) != mask.end()) result.mask = std::move(mask);
    return result;
}

std::vector<SamplePicture> read_pictures(const Scene &scene, uint32_t max_side, Events &progress) {
    std::vector<SamplePicture> pictures(scene.files.size());
    for_each_parallel(static_cast<uint32_t>(pictures.size()), "reading pictures", progress,
                      [&](uint32_t i) { pictures[i] = read_sample_picture(scene, i, max_side); });
    return pictures;
}

uint32_t channel_count(const std::vector<SamplePicture> &pictures) {
    for (const auto &p : pictures)
        if (lensprof_layout_channels(p.picture.layout) == 3) return 3;
    return 1;
}

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

// Moves a place from pixels of the picture to those of the falloff's frame (`sign` 1), or back (-1).
void move_place(const Scene &scene, uint32_t image, double sign, double xy[2]) {
    const FalloffFrame frame = falloff_frame_of(scene.images[image]);
    xy[0] -= sign * frame.left, xy[1] -= sign * frame.top;
}

void move_places(const Scene &scene, double sign, std::vector<lensprof_pair> &pairs) {
    for (lensprof_pair &pair : pairs)
        for (int side = 0; side < 2; side++) move_place(scene, pair.image[side], sign, pair.xy[side]);
}

using ImagePair = std::pair<uint32_t, uint32_t>;

template <class Item>
ImagePair images_of(const Item &item) {
    return std::minmax(item.image[0], item.image[1]);
}

// The pairs and links of one way of sampling; empty if it finds nothing, with the reason in `nothing`.
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
    const lensprof_observation *last = nullptr;
    for (const auto &next : observations) {
        if (*std::max_element(next.value, next.value + 3) > GreyRange{}.white) continue;
        if (last && last->point == next.point) {
            lensprof_pair pair{};
            const lensprof_observation *ends[2] = {last, &next};
            for (int side = 0; side < 2; side++) {
                pair.image[side] = ends[side]->image;
                std::copy(ends[side]->xy, ends[side]->xy + 2, pair.xy[side]);
                std::copy(ends[side]->value, ends[side]->value + 3, pair.value[side]);
            }
            pairs.push_back(pair);
        }
        last = &next;
    }
    return pairs;
}

namespace {

// `number`: 1-based index of the point in its file.
void check_point(const std::string &path, const Scene &scene, const lensprof_pair &pair, int side, size_t number) {
    const uint32_t image = pair.image[side];
    if (image >= scene.images.size())
        throw Failure(LENSPROF_ERROR_READ, path + ": refers to image " + std::to_string(image) + ", but " + scene.path
                                               + " has images 0 to " + std::to_string(scene.images.size() - 1)
                                               + "; give the points of this project");
    const auto &camera = scene.images[image].camera;
    const double *xy = pair.xy[side];
    if (!(xy[0] >= -1.0 && xy[1] >= -1.0 && xy[0] <= camera.width && xy[1] <= camera.height))
        throw Failure(LENSPROF_ERROR_READ, path + ": point " + std::to_string(number) + " is outside "
                                               + scene.names[image] + "; give the points of this project");
}

// Point files may have gigabytes: other files are refused by their first lines.
void check_first_points(const std::string &path) {
    constexpr size_t max_head_bytes = 1 << 16;
    const std::string head = read_head(path, max_head_bytes);
    refuse_other_kind(path);
    const size_t end = head.size() < max_head_bytes ? head.size() : head.rfind('\n') + 1;  // 0 without a line end
    if (end == 0 && !head.empty())
        throw Failure(LENSPROF_ERROR_READ, path + ": line 1 is too long for a point file; check the file name");
    lensprof_error error{};
    uint32_t found = 0;
    check(lensprof_points_read(head.data(), end, nullptr, 0, &found, &error), path, &error);
}

}  // namespace

std::vector<lensprof_pair> read_points(const std::string &path, const Scene &scene) {
    // The maximum number of pairs of --fit pairs, with 17 digits.
    constexpr uint64_t max_points_bytes = uint64_t(1 << 24) * 256;
    check_first_points(path);
    std::string text = read_text(path, max_points_bytes);
    lensprof_error error{};
    uint32_t found = 0;
    check(lensprof_points_read(text.data(), text.size(), nullptr, 0, &found, &error), path, &error);
    std::vector<lensprof_pair> pairs(found);
    if (found == 0) throw Failure(LENSPROF_ERROR_READ, path + ": has no points; give a point file of this project");
    check(lensprof_points_read(text.data(), text.size(), pairs.data(), found, &found, &error), path, &error);
    for (size_t p = 0; p < pairs.size(); p++)
        for (int side = 0; side < 2; side++) check_point(path, scene, pairs[p], side, p + 1);
    move_places(scene, 1.0, pairs);
    return pairs;
}

std::string points_text(std::vector<lensprof_pair> pairs, const Scene &scene) {
    move_places(scene, -1.0, pairs);
    std::vector<lensprof_camera> cameras;
    for (const auto &image : scene.images) cameras.push_back(image.camera);
    return written("points", [&](void *text, size_t capacity, size_t *count, lensprof_error *error) {
        return lensprof_points_write(pairs.data(), static_cast<uint32_t>(pairs.size()), cameras.data(),
                                     static_cast<uint32_t>(cameras.size()), text, capacity, count, error);
    });
}

lensprof_exposure mean_exposure(const std::vector<lensprof_exposure> &exposures) {
    lensprof_exposure mean{};
    double logs[3] = {0, 0, 0}, count = 0.0;
    for (const auto &e : exposures) {
        if (std::isnan(e.ev)) continue;
        mean.ev += e.ev, count++;
        for (int c = 0; c < 3; c++) logs[c] += std::log(e.white_balance[c]);
    }
    mean.ev /= count;
    for (int c = 0; c < 3; c++) mean.white_balance[c] = std::exp(logs[c] / count);
    return mean;
}

std::vector<lensprof_exposure> relative_exposures(std::vector<lensprof_exposure> exposures, uint32_t reference) {
    const lensprof_exposure zero = exposures[reference];
    for (auto &e : exposures) {
        e.ev -= zero.ev;
        for (int c = 0; c < 3; c++) e.white_balance[c] /= zero.white_balance[c];
    }
    return exposures;
}

std::vector<lensprof_exposure> scene_exposures(const Scene &scene) {
    std::vector<lensprof_exposure> exposures;
    for (const auto &image : scene.images) exposures.push_back(image.exposure);
    return relative_exposures(exposures, scene.reference);
}

std::vector<lensprof_fit_image> fit_images(const Scene &scene) {
    std::vector<lensprof_fit_image> images;
    auto exposures = scene_exposures(scene);
    for (const auto &from : scene.images) {
        lensprof_fit_image image;
        const FalloffFrame frame = falloff_frame_of(from);
        lensprof_fit_image_init(&image, static_cast<uint32_t>(images.size()), frame.width, frame.height);
        image.exposure = exposures[images.size()];
        image.free = from.free & (LENSPROF_FREE_EV | LENSPROF_FREE_RED | LENSPROF_FREE_BLUE);
        image.ev_of = from.ev_of;
        image.red_of = from.red_of;
        image.blue_of = from.blue_of;
        images.push_back(image);
    }
    return images;
}

}  // namespace lensprof
