#include "photo/calibration/lens_settings.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <utility>

#include "photo/pictures/orientation.hpp"
#include "photo/report/report.hpp"

namespace lensprof {
namespace {

constexpr double kSameStop = 0.17;       // log2 of squared f-numbers: a sixth of a stop, the rounding of EXIF
constexpr double kSameFocal = 0.02;      // relative
constexpr double kSameExtension = 0.02;  // focal length over focus distance, which determines the falloff change by
                                         // focusing

bool are_known(double a, double b) { return a != LENSPROF_UNKNOWN && b != LENSPROF_UNKNOWN; }

}  // namespace

bool is_same_setting(const lensprof_profile_key &a, const lensprof_profile_key &b) {
    if (*a.lens && *b.lens && std::strcmp(a.lens, b.lens) != 0) return false;
    if (are_known(a.aperture, b.aperture) && std::fabs(2.0 * std::log2(a.aperture / b.aperture)) > kSameStop)
        return false;
    if (!are_known(a.focal_mm, b.focal_mm)) return true;
    if (std::fabs(a.focal_mm / b.focal_mm - 1.0) > kSameFocal) return false;
    const auto extension = [](const lensprof_profile_key &key) { return 1e-3 * key.focal_mm / key.distance_m; };
    return !are_known(a.distance_m, b.distance_m) || std::fabs(extension(a) - extension(b)) < kSameExtension;
}

namespace {

// Crops at other places of a file are circles of other lenses.
bool is_same_crop(const lensprof_pto_image &a, const lensprof_pto_image &b) {
    return a.of_crop == b.of_crop && (!a.of_crop || std::equal(a.crop, a.crop + 4, b.crop));
}

// How many fields of the setting a key states.
int stated(const lensprof_profile_key &key) {
    return (key.aperture != LENSPROF_UNKNOWN) + (key.focal_mm != LENSPROF_UNKNOWN)
           + (key.distance_m != LENSPROF_UNKNOWN) + (*key.lens != '\0');
}

// Fields given on the command line for all pictures do not distinguish any.
lensprof_profile_key stated_key(lensprof_profile_key key, const StoreOptions &store) {
    if (store.aperture != LENSPROF_UNKNOWN) key.aperture = store.aperture;
    if (store.focal != LENSPROF_UNKNOWN) key.focal_mm = store.focal;
    if (store.distance != LENSPROF_UNKNOWN) key.distance_m = store.distance;
    if (!store.lens.empty()) *key.lens = '\0';
    return key;
}

// Numbers settings, or cameras, in the order of their images.
LensSettings in_order(const std::vector<uint32_t> &found, const std::vector<uint32_t> &first) {
    LensSettings settings;
    std::vector<uint32_t> number(first.size(), UINT32_MAX);
    for (uint32_t setting : found) {
        if (number[setting] == UINT32_MAX) {
            number[setting] = static_cast<uint32_t>(settings.first.size());
            settings.first.push_back(first[setting]);
        }
        settings.of_image.push_back(number[setting]);
    }
    return settings;
}

// Whether two images are from one camera: as crops of one file, or according to EXIF, unless sizes or processings
// differ, or to the project, unless EXIF contradicts. `is_given`: the command line gives the camera of all.
bool is_same_camera(const Scene &scene, const std::vector<PictureMetadata> &metadata, bool is_given, uint32_t i,
                    uint32_t j) {
    const lensprof_profile_key &a = metadata[i].key, &b = metadata[j].key;
    const bool is_stated = is_given || (*a.camera_model && *b.camera_model);
    const bool is_alike =
        is_given
        || (std::strcmp(a.camera_model, b.camera_model) == 0 && std::strcmp(a.camera_maker, b.camera_maker) == 0);
    if (is_stated && !is_alike) return false;
    if (scene.images[i].of_crop && scene.files[i] == scene.files[j]) return true;
    if (scene.images[i].response_of == scene.images[j].response_of) return true;
    const lensprof_camera &frame = scene.images[i].camera, &other_frame = scene.images[j].camera;
    const bool is_one_kind =
        a.processing == b.processing
        && std::minmax(frame.width, frame.height) == std::minmax(other_frame.width, other_frame.height);
    return is_stated && is_one_kind;
}

// Numbers cameras in the order of their first images. Images that state their camera come first, so that others do not
// connect what EXIF separates.
void number_cameras(const Scene &scene, const std::vector<PictureMetadata> &metadata, bool is_given,
                    LensSettings &settings) {
    const auto count = static_cast<uint32_t>(scene.images.size());
    std::vector<uint32_t> order(count), found(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_partition(order.begin(), order.end(), [&](uint32_t i) { return *metadata[i].key.camera_model != 0; });
    std::vector<std::vector<uint32_t>> members;
    for (const uint32_t i : order) {
        const auto same = std::find_if(members.begin(), members.end(), [&](const std::vector<uint32_t> &camera_images) {
            return std::any_of(camera_images.begin(), camera_images.end(),
                               [&](uint32_t j) { return is_same_camera(scene, metadata, is_given, i, j); });
        });
        found[i] = static_cast<uint32_t>(same - members.begin());
        if (same == members.end()) members.emplace_back();
        members[found[i]].push_back(i);
    }
    std::vector<uint32_t> first;
    for (const std::vector<uint32_t> &camera_images : members)
        first.push_back(*std::min_element(camera_images.begin(), camera_images.end()));
    const LensSettings cameras = in_order(found, first);
    settings.camera_of_image = cameras.of_image, settings.first_of_camera = cameras.first;
}

bool is_portrait(const lensprof_pto_image &image) { return image.camera.height > image.camera.width; }

// The turns of all images, unless that of some image of a setting is unknown while others are not. Pictures that may
// all have been rotated stay as they are.
void set_turns(const Scene &scene, const std::vector<PictureMetadata> &metadata, LensSettings &settings) {
    std::vector<uint16_t> &turns = settings.turn_of_image;
    for (size_t i = 0; i < metadata.size(); i++) {
        const lensprof_camera &frame = scene.images[i].camera;
        turns.push_back(sensor_orientation(frame.width, frame.height, metadata[i].orientation));
    }
    for (uint32_t setting = 0; setting < settings.first.size(); setting++) {
        bool has_unknown = false, has_known = false;
        for (size_t i = 0; i < turns.size(); i++)
            if (settings.of_image[i] == setting) (turns[i] ? has_known : has_unknown) = true;
        settings.are_centres_unknown |= has_unknown && has_known;
        settings.is_turn_unknown.push_back(has_unknown);
        for (size_t i = 0; i < turns.size(); i++)
            if (settings.of_image[i] == setting && has_unknown) turns[i] = 1;
    }
}

}  // namespace

bool LensSettings::has_rotated_images() const {
    return std::any_of(turn_of_image.begin(), turn_of_image.end(), [](uint16_t turn) { return turn != 1; });
}

FalloffGroups falloff_groups(const LensSettings &settings) {
    FalloffGroups groups;
    std::map<std::pair<uint32_t, uint16_t>, uint32_t> numbers;
    for (uint32_t i = 0; i < settings.of_image.size(); i++) {
        const uint32_t setting = settings.of_image[i];
        const uint16_t turn = settings.turn_of_image[i];
        const auto [number, is_new] = numbers.emplace(std::pair(setting, turn), static_cast<uint32_t>(numbers.size()));
        groups.of_image.push_back(number->second);
        const uint32_t most_complete = settings.first[setting];
        if (is_new) groups.first.push_back(settings.turn_of_image[most_complete] == turn ? most_complete : i);
    }
    return groups;
}

// Images that state most come first; one that states less joins the only setting it may belong to or, if there are
// several, that of images stating as little.
LensSettings lens_settings(const Scene &scene, const std::vector<PictureMetadata> &metadata, const StoreOptions &store,
                           bool one_lens) {
    const auto count = static_cast<uint32_t>(scene.images.size());
    const std::vector<uint32_t> all(count, 0), reference{scene.reference};
    if (one_lens) {
        LensSettings one;
        one.of_image = one.camera_of_image = all, one.first = one.first_of_camera = reference;
        set_turns(scene, metadata, one);
        return one;
    }
    std::vector<lensprof_profile_key> keys;
    for (const PictureMetadata &entry : metadata) keys.push_back(stated_key(entry.key, store));
    LensSettings cameras;
    number_cameras(scene, metadata, !store.camera.empty(), cameras);
    std::vector<uint32_t> order(count), found(count), first;
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return stated(keys[a]) > stated(keys[b]); });
    for (uint32_t i : order) {
        const auto is_possible = [&](uint32_t other) {
            const auto &a = scene.images[i], &b = scene.images[other];
            // Hugin does not link portrait and landscape frames.
            const bool is_linked = a.vignetting_of == b.vignetting_of || is_portrait(a) != is_portrait(b);
            return cameras.camera_of_image[i] == cameras.camera_of_image[other] && is_linked && is_same_crop(a, b)
                   && is_same_setting(keys[i], keys[other]);
        };
        std::vector<uint32_t> possible;
        for (uint32_t n = 0; n < first.size(); n++)
            if (is_possible(first[n])) possible.push_back(n);
        const auto equally_detailed = std::find_if(
            possible.begin(), possible.end(), [&](uint32_t n) { return stated(keys[first[n]]) == stated(keys[i]); });
        found[i] = possible.size() == 1                 ? possible[0]
                   : equally_detailed != possible.end() ? *equally_detailed
                                                        : static_cast<uint32_t>(first.size());
        if (found[i] == first.size()) first.push_back(i);
    }
    if (first.size() > LENSPROF_SETTINGS_MAX)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      scene.path + ": its pictures have " + std::to_string(first.size())
                          + " lens settings, but a fit takes at most " + std::to_string(LENSPROF_SETTINGS_MAX)
                          + "; give fewer pictures, or use " + option_name("one_lens") + " to treat all as one");
    LensSettings settings = in_order(found, first);
    settings.camera_of_image = cameras.camera_of_image, settings.first_of_camera = cameras.first_of_camera;
    set_turns(scene, metadata, settings);
    return settings;
}

void join_cameras(LensSettings &settings) {
    settings.camera_of_image.assign(settings.camera_of_image.size(), 0);
    settings.first_of_camera.resize(1);
}

std::string describe_camera(const lensprof_profile_key &key, const std::string &first_image) {
    const std::string name = camera_name(key.camera_maker, key.camera_model);
    return name.empty() ? "camera of " + first_image : name;
}

std::string describe_setting(const lensprof_profile_key &key, const std::string &first_image) {
    const KeyParts parts = key_parts(key);
    std::string text;
    for (size_t part : {2, 3, 4})  // focal length, aperture, focus
        if (!parts[part].empty()) text += (text.empty() ? "" : ", ") + parts[part];
    return text.empty() ? "setting of " + first_image : text;
}

}  // namespace lensprof
