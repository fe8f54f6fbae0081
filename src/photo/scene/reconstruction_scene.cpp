#include "photo/scene/reconstruction_scene.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <set>

#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/lap.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/reconstruction/field_reader.hpp"
#include "photo/reconstruction/link_order.hpp"
#include "photo/reconstruction/match_choice.hpp"
#include "photo/reconstruction/pictures.hpp"
#include "photo/reconstruction/reconstruction_file.hpp"
#include "photo/scene/exposure_reader.hpp"

namespace lensprof {
namespace {

// Pairs drawn per image: in proportion to the total, but not less than the minimum.
constexpr uint32_t kMaxPairsOfImage = 600, kMinPairsOfImage = 150, kMaxPairs = 600000;
constexpr uint32_t kEnds = 2;                             // each pair counts for two images
constexpr double kBlackLevel = 2.0, kWhiteLevel = 250.0;  // colours outside are ignored

std::vector<NewImage> images_of(const Reconstruction &r) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> sizes;  // upright or not
    std::vector<NewImage> images;
    for (const auto &camera : r.cameras) {
        const auto size = std::minmax(camera.width, camera.height);
        const auto lens = sizes.emplace(size, static_cast<uint32_t>(sizes.size())).first->second;
        images.push_back({camera_of_size(camera.width, camera.height), lens, lens});
    }
    return images;
}

// The colours of two observations, if both are unclipped.
bool pair_of_colours(const TrackObservation &a, const TrackObservation &b, lensprof_pair &pair) {
    const TrackObservation *ends[2] = {&a, &b};
    for (int side = 0; side < 2; side++) {
        pair.image[side] = ends[side]->image;
        for (int d = 0; d < 2; d++) pair.xy[side][d] = ends[side]->xy[d];
        for (size_t c = 0; c < 3; c++) {
            const double level = ends[side]->colour[c];
            if (level < kBlackLevel || level > kWhiteLevel) return false;
            pair.value[side][c] = level / 255.0;
        }
    }
    return true;
}

void add_pairs_of_colours(const Reconstruction &r, const std::vector<ObservationPair> &chosen, Scene &scene) {
    for (const ObservationPair &chosen_pair : chosen) {
        lensprof_pair pair{};
        if (!pair_of_colours(r.observations[chosen_pair.first], r.observations[chosen_pair.second], pair)) continue;
        scene.pairs.push_back(pair);
        scene.pair_points.push_back(r.observations[chosen_pair.first].point);
    }
    if (scene.pairs.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE, scene.path + ": the colours of its points are all clipped (black or white); give its pictures "
                                       "with " + option_name("images"),
                      LENSPROF_REASON_FEW_PAIRS);
}

// The linked images of the chosen pairs, which no cameras explain.
std::vector<lensprof_scene_link> links_of(const Reconstruction &r, const std::vector<ObservationPair> &chosen) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> points;
    for (const ObservationPair &pair : chosen)
        points[std::minmax(r.observations[pair.first].image, r.observations[pair.second].image)]++;
    std::vector<lensprof_scene_link> links;
    for (const auto &[images, count] : points) links.push_back({{images.first, images.second}, count, 0});
    return links;
}

uint32_t pairs_of_image(const ReconstructionOptions &options, size_t images) {
    if (options.pairs) return static_cast<uint32_t>((options.pairs + images - 1) / images);
    return std::clamp(static_cast<uint32_t>(kMaxPairs / images), kMinPairsOfImage, kMaxPairsOfImage);
}

void report_read(const Reconstruction &r, const std::string &label, bool has_pictures, Events &events) {
    const auto placed =
        std::count_if(r.images.begin(), r.images.end(), [](const auto &image) { return image.has_centre; });
    events.note(label, format("%s of %zu images, %u points, %zu observations; %s; %s", r.kind.c_str(), r.images.size(),
                              r.point_count(), r.observations.size(),
                              placed ? "pairs weighted by similarity of viewing angle"
                                     : "pairs weighted by the number of shared points",
                              has_pictures ? "comparing the pictures at its points"
                                           : "comparing the colours of its points without reading pictures"));
}

std::vector<std::string> read_names(const std::string &list) {
    FieldReader fields(list, '\0', max_text_bytes);
    std::vector<std::string> names;
    while (fields.next_line_of_values()) names.push_back(fields.rest());
    return names;
}

// Keeps the images listed in a file.
void keep_listed_images(const std::string &list, Reconstruction &r) {
    std::map<std::string, uint32_t> image_of;
    for (uint32_t i = 0; i < r.images.size(); i++) image_of[r.images[i].name] = i;
    std::set<uint32_t> kept;
    for (const std::string &name : read_names(list)) {
        const auto image = image_of.find(name);
        if (image == image_of.end())
            throw Failure(LENSPROF_ERROR_READ, list + ": " + short_name(name) + " is not an image of " + r.path
                                                   + "; give image names as stored there, one per line");
        kept.insert(image->second);
    }
    if (kept.size() < 2)
        throw Failure(LENSPROF_ERROR_READ, list + ": has fewer than two image names; give one name per line");
    keep_images(std::vector<uint32_t>(kept.begin(), kept.end()), r);
}

// Reports the number of pictures in the folder that are not part of the reconstruction and get no exposure.
void report_unused(const std::vector<std::string> &files, Events &events) {
    namespace fs = std::filesystem;
    std::set<std::string> used, folders;
    for (const std::string &file : files) {
        used.insert(file_identity(file));
        folders.insert(fs::path(file).parent_path().string());
    }
    size_t unused = 0;
    std::string first;
    std::error_code error;  // a folder that cannot be listed is not reported
    for (const std::string &folder : folders)
        for (const auto &entry : fs::directory_iterator(folder, error)) {
            const std::string file = entry.path().string();
            if (!is_picture_name(file) || used.count(file_identity(file))) continue;
            if (!unused++ || file < first) first = file;
        }
    if (unused)
        events.note({}, counted(unused, "picture") + " in the folder, the first " + first
                            + ", not part of the reconstruction: no exposure for them");
}

// Keeps the images of a shard, their files and observations; sets `label`.
void keep_shard(const Shard &shard, Reconstruction &r, std::vector<std::string> &files, std::string &label) {
    if (shard.count == 1) return;
    const auto count = static_cast<uint32_t>(r.images.size());
    const std::vector<uint32_t> order = order_by_links(count, common_points(r));
    const auto first = static_cast<std::ptrdiff_t>(shard.first(count)),
               end = static_cast<std::ptrdiff_t>(shard.end(count));
    const std::string part = format("%u/%u", shard.number, shard.count);
    if (end - first < 2)
        throw Failure(LENSPROF_ERROR_ARGUMENT, option_name("shard") + "=" + part + ": contains fewer than two of the "
                                                   + counted(count, "image") + "; use fewer parts");
    std::vector<uint32_t> kept(order.begin() + first, order.begin() + end);
    std::sort(kept.begin(), kept.end());
    keep_images(kept, r);
    for (size_t n = 0; n < kept.size() && !files.empty(); n++) files[n] = files[kept[n]];
    if (!files.empty()) files.resize(kept.size());
    label += " (shard " + part + ")";
}

}  // namespace

void reject_reconstruction_part(const std::string &path) {
    const std::filesystem::path file(path);
    const std::string name = file.filename().string(), stem = file.stem().string(), end = file.extension().string();
    std::string advice;
    if (is_exposure_file(path))
        advice = "a file of exposures" + lensprof::advice("exposures_given");
    else if (name == "reconstruction.json")
        advice = "a part of an OpenSfM reconstruction; give tracks.csv, which lies next to it";
    else if ((stem == "cameras" || stem == "images" || stem == "points3D") && (end == ".bin" || end == ".txt"))
        advice = "a part of a COLMAP model; give its folder";
    if (!advice.empty()) throw Failure(LENSPROF_ERROR_READ, path + ": is " + advice);
}

Scene scene_of_reconstruction(const std::string &path, const ReconstructionOptions &options, Events &events) {
    auto clock = std::chrono::steady_clock::now();
    Reconstruction r = read_reconstruction(path, events);
    if (options.is_by_colours && !r.has_colours)
        throw Failure(LENSPROF_ERROR_ARGUMENT, option_name("track_colours") + ": needs OpenSfM's tracks.csv, but "
                                                   + path + " is a " + r.kind + "; omit the option");
    Scene scene;
    scene.path = path;
    scene.by_matches = scene.is_reconstruction = true;
    scene.sources = files_of_reconstruction(path);
    if (!options.image_list.empty()) keep_listed_images(options.image_list, r);
    std::vector<std::string> files = find_pictures(r, options.images, r.has_colours);
    if (options.image_list.empty()) report_unused(files, events);
    convert_coordinates(r, files);
    keep_shard(options.shard, r, files, scene.path);
    const bool has_pictures = !files.empty() && !options.is_by_colours;
    report_read(r, scene.path, has_pictures, events);
    const auto chosen = choose_pairs(r, kEnds * pairs_of_image(options, r.images.size()), options.seed);
    scene.view_distances = view_distances(r, chosen);
    if (has_pictures) {
        scene.matches = matches_of(r, chosen);
        for (const ObservationPair &chosen_pair : chosen)
            scene.match_points.push_back(r.observations[chosen_pair.first].point);
    } else {
        add_pairs_of_colours(r, chosen, scene);
    }
    for (size_t i = 0; i < r.images.size(); i++) {
        scene.names.push_back(r.images[i].name);
        scene.files.push_back(files.empty() ? r.images[i].name : files[i]);
    }
    set_images(images_of(r), scene);
    scene.links = links_of(r, chosen);
    scene.register_s = lap(clock);
    return scene;
}

}  // namespace lensprof
