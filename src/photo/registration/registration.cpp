#include "photo/registration/registration.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <new>
#include <numeric>
#include <set>
#include <tuple>

#include "fit/base/quantile.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/parallel.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/registration/cameras.hpp"
#include "photo/registration/copies.hpp"
#include "photo/registration/features.hpp"
#include "photo/registration/matching.hpp"

namespace lensprof {
namespace {

constexpr double unfit = 0.005;         // median residual of a link not explained by the cameras, of the longer side
constexpr size_t points_per_link = 10;  // given to a project
// Maximum matches of a link compared at matches, and of all links of a project.
constexpr size_t min_matches_kept = 20, max_matches = 200, max_total_matches = 200000;
constexpr double smallest_turn = 0.05;  // maximum determinant (or inverse) of a map between two pictures of a scene

std::optional<double> hfov_by_metadata(const PictureMetadata &metadata, const Features &picture) {
    const lensprof_profile_key &key = metadata.key;
    if (key.crop_factor == LENSPROF_UNKNOWN || key.focal_mm == LENSPROF_UNKNOWN) return std::nullopt;
    constexpr double full_frame_diagonal_mm = 43.2666;
    const double across =
        full_frame_diagonal_mm / key.crop_factor * picture.width / std::hypot(picture.width, picture.height);
    return 2.0 * std::atan(0.5 * across / key.focal_mm) * 180.0 / M_PI;
}

void add_points(const PictureLink &link, std::vector<ControlPoint> &points) {
    const size_t count = link.matches.size(), wanted = std::min(count, points_per_link);
    for (size_t n = 0; n < wanted; n++) {
        const auto &[from, to] = link.matches[n * count / wanted];
        points.push_back({{link.picture[0], link.picture[1]}, {{from.x, from.y}, {to.x, to.y}}});
    }
}

// The matches of a link, with the derivative of the homography at each: how the surroundings are rotated and scaled.
void add_matches(const PictureLink &link, size_t max_count, std::vector<lensprof_match> &matches) {
    const cv::Matx33d &h = link.homography;
    const size_t count = link.matches.size(), wanted = std::min(count, max_count);
    for (size_t n = 0; n < wanted; n++) {
        const auto &[from, to] = link.matches[n * count / wanted];
        const cv::Vec3d mapped = h * cv::Vec3d(from.x, from.y, 1.0);
        lensprof_match match{{link.picture[0], link.picture[1]}, {{from.x, from.y}, {to.x, to.y}}, {}};
        for (int e = 0; e < 2; e++)
            for (int d = 0; d < 2; d++) match.map[e][d] = (h(e, d) - mapped[e] / mapped[2] * h(2, d)) / mapped[2];
        const double turns = match.map[0][0] * match.map[1][1] - match.map[0][1] * match.map[1][0];
        if (turns > smallest_turn && turns < 1.0 / smallest_turn) matches.push_back(match);
    }
}

// The project of one group; `links` use the group's indices.
FoundScene scene_of(std::vector<uint32_t> numbers, const std::vector<PictureOptics> &optics,
                    const std::vector<PictureLink> &links) {
    FoundScene scene;
    scene.pictures = std::move(numbers);
    for (const PictureOptics &o : optics) scene.lenses.push_back(o.lens);
    FoundCameras found = find_cameras(optics, links);
    const bool is_still =
        std::all_of(links.begin(), links.end(), [](const PictureLink &link) { return link.is_still; });
    scene.kind = is_still ? SceneKind::still : found.kind;
    scene.cameras = std::move(found.cameras);
    std::vector<double> residuals;
    const auto fits_link = [&](size_t n) { return found.link_residuals[n] <= unfit; };
    for (size_t n = 0; n < links.size(); n++)
        scene.links.push_back(
            {{links[n].picture[0], links[n].picture[1]}, static_cast<uint32_t>(links[n].matches.size()), fits_link(n)});
    const size_t max_per_link =
        std::clamp(max_total_matches / std::max<size_t>(1, links.size()), min_matches_kept, max_matches);
    // Scenes are only nearly planar: what stands out is shifted, and matches have the actual positions.
    scene.by_matches = found.kind == SceneKind::plane || !scene.cameras_fit();
    for (size_t n = 0; n < links.size(); n++) {
        const bool fits = fits_link(n);
        if (fits) residuals.push_back(found.link_residuals[n]), add_points(links[n], scene.points);
        if (!fits || scene.by_matches) add_matches(links[n], max_per_link, scene.matches);
    }
    scene.residual = upper_median(residuals);
    return scene;
}

std::vector<PictureLink> links_within(const std::vector<PictureLink> &links, const std::vector<uint32_t> &numbers) {
    std::vector<PictureLink> result;
    const auto place = [&](uint32_t picture) { return std::lower_bound(numbers.begin(), numbers.end(), picture); };
    for (const PictureLink &link : links) {
        const auto a = place(link.picture[0]), b = place(link.picture[1]);
        if (a == numbers.end() || *a != link.picture[0] || b == numbers.end() || *b != link.picture[1]) continue;
        result.push_back(link);
        result.back().picture[0] = static_cast<uint32_t>(a - numbers.begin());
        result.back().picture[1] = static_cast<uint32_t>(b - numbers.begin());
    }
    return result;
}

struct RegisteredPicture {
    Features features;
    PictureMetadata metadata;
    std::string failure;   // reason if it cannot be read
    bool is_copy = false;  // of another picture
};

// How many features at half the size are enough for each of these pictures; 0: any number is too few. Where the camera
// moved, places of the finest features count, as pictures are compared at them; links of frames of a camera that turns
// share its angles. Looks at a few pairs of neighbours.
size_t enough_at_half(const std::vector<std::string> &files, uint32_t max_features, Events &events) {
    constexpr size_t probes = 8, enough = 200;
    if (files.size() <= few_pictures) return 0;
    std::vector<std::pair<Features, Features>> neighbours(probes);
    std::vector<char> is_read(probes);  // not bool: written by several threads
    for_each_parallel(probes, "looking at neighbours", events, [&](uint32_t n) {
        const size_t i = n * (files.size() - 2) / (probes - 1);
        try {
            neighbours[n] = {find_features(files[i], max_features, 1), find_features(files[i + 1], max_features, 1)};
            is_read[n] = true;
        } catch (const Failure &failure) {
            if (failure.group() != LENSPROF_ERROR_READ) throw;
        }
    });
    for (size_t n = probes; n-- > 0;)
        if (!is_read[n]) neighbours.erase(neighbours.begin() + static_cast<ptrdiff_t>(n));
    return !neighbours.empty() && turn_only(neighbours) ? enough : 0;
}

// Metadata and features per picture.
std::vector<RegisteredPicture> read_all(const std::vector<std::string> &files,
                                        const std::vector<PictureMetadata> &metadata, Events &events) {
    std::vector<RegisteredPicture> pictures(files.size());
    const uint32_t max_features = most_features_of(files.size());
    const size_t enough = enough_at_half(files, max_features, events);
    for_each_parallel(static_cast<uint32_t>(files.size()), "finding features", events, [&](uint32_t i) {
        try {
            pictures[i].metadata = metadata.empty() ? read_metadata(files[i]) : metadata[i];
            pictures[i].features = find_features(files[i], max_features, enough);
        } catch (const Failure &failure) {
            if (failure.group() != LENSPROF_ERROR_READ) throw;
            pictures[i].features = {};
            pictures[i].failure = failure.what();
        }
    });
    return pictures;
}

// Numbers cameras: pictures with the same camera, processing and size, upright or not, have one number, in order of
// appearance; with `as_one` all raw files have one, and all others.
std::vector<uint32_t> camera_ids_of(const std::vector<std::string> &files,
                                    const std::vector<RegisteredPicture> &pictures, bool as_one) {
    std::map<std::tuple<bool, std::string, std::string, uint32_t, uint32_t, uint32_t>, uint32_t> found;
    std::vector<uint32_t> camera_ids;
    for (size_t i = 0; i < pictures.size(); i++) {
        const lensprof_profile_key &key = pictures[i].metadata.key;
        const auto [shorter, longer] = std::minmax(pictures[i].features.width, pictures[i].features.height);
        std::tuple body(raw_kind(files[i]).has_value(), std::string(key.camera_maker), std::string(key.camera_model),
                        key.processing, shorter, longer);
        if (as_one) body = {std::get<0>(body), "", "", 0, 0, 0};
        camera_ids.push_back(found.emplace(body, static_cast<uint32_t>(found.size())).first->second);
    }
    return camera_ids;
}

// Numbers lenses: pictures with the same camera, lens, focal length, processing and size have one number, in order of
// appearance.
std::vector<uint32_t> lenses_of(const std::vector<RegisteredPicture> &pictures, const std::vector<uint32_t> &numbers) {
    using Setting = std::tuple<std::string, std::string, std::string, double, uint32_t, uint32_t, uint32_t>;
    std::map<Setting, uint32_t> found;
    std::vector<uint32_t> lenses;
    for (uint32_t i : numbers) {
        const lensprof_profile_key &key = pictures[i].metadata.key;
        const Features &features = pictures[i].features;
        const Setting setting(key.camera_maker, key.camera_model, key.lens, key.focal_mm, key.processing,
                              features.width, features.height);
        lenses.push_back(found.emplace(setting, static_cast<uint32_t>(found.size())).first->second);
    }
    return lenses;
}

// Selects pictures by index.
std::vector<PictureOptics> optics_of(const std::vector<RegisteredPicture> &pictures,
                                     const std::vector<uint32_t> &numbers) {
    const std::vector<uint32_t> lenses = lenses_of(pictures, numbers);
    std::vector<PictureOptics> optics;
    for (size_t n = 0; n < numbers.size(); n++) {
        const RegisteredPicture &p = pictures[numbers[n]];
        optics.push_back({p.features.width, p.features.height, lenses[n], hfov_by_metadata(p.metadata, p.features),
                          p.metadata.orientation});
    }
    return optics;
}

// The pictures in projects, and their groups: a body takes part in a group if two of its pictures in it overlap.
class Grouping {
public:
    Grouping(const std::vector<uint32_t> &camera_ids, const std::vector<PictureLink> &links)
        : takes_(camera_ids.size(), true), groups_(groups_of(camera_ids.size(), links)) {
        while (drop(camera_ids, links))
            groups_ = groups_of(camera_ids.size(), links, [this](const PictureLink &link) { return takes_both(link); });
    }

    bool takes(uint32_t picture) const { return takes_[picture]; }
    uint32_t group(uint32_t picture) const { return groups_[picture]; }

private:
    // Removes pictures of cameras that do not take part in their group; false if not found. This may split groups.
    bool drop(const std::vector<uint32_t> &camera_ids, const std::vector<PictureLink> &links) {
        std::set<std::pair<uint32_t, uint32_t>> parts;  // groups and cameras
        for (const PictureLink &link : links)
            if (takes_both(link) && camera_ids[link.picture[0]] == camera_ids[link.picture[1]])
                parts.insert({groups_[link.picture[0]], camera_ids[link.picture[0]]});
        bool any = false;
        for (uint32_t i = 0; i < takes_.size(); i++) {
            if (!takes_[i] || parts.count({groups_[i], camera_ids[i]})) continue;
            takes_[i] = false, any = true;
        }
        return any;
    }
    bool takes_both(const PictureLink &link) const { return takes_[link.picture[0]] && takes_[link.picture[1]]; }

    std::vector<bool> takes_;
    std::vector<uint32_t> groups_;
};

// Pictures that overlap another.
std::vector<bool> find_linked(size_t pictures, const std::vector<PictureLink> &links) {
    std::vector<bool> is_linked(pictures);
    for (const PictureLink &link : links) is_linked[link.picture[0]] = is_linked[link.picture[1]] = true;
    return is_linked;
}

// Removes links between raw files and others: no project mixes them.
void part_raw(const std::vector<std::string> &files, std::vector<PictureLink> &links) {
    std::vector<bool> is_raw;
    for (const std::string &file : files) is_raw.push_back(raw_kind(file).has_value());
    const auto parts = [&](const PictureLink &link) { return is_raw[link.picture[0]] != is_raw[link.picture[1]]; };
    links.erase(std::remove_if(links.begin(), links.end(), parts), links.end());
}

// Finds overlaps between pictures that are not copies of each other.
class Overlaps {
public:
    Overlaps(const std::vector<std::string> &files, std::vector<RegisteredPicture> &pictures) : pictures_(pictures) {
        for (size_t i = 0; i < pictures.size(); i++) {
            const PictureMetadata &metadata = pictures[i].metadata;
            candidates_.push_back(
                {&pictures[i].features, metadata.captured, metadata.exposure_time_s, raw_kind(files[i]).has_value()});
        }
    }

    // Copies overlap nothing. Which one of two mirrored pictures is the copy shows in what they overlap: a mirrored
    // picture overlaps mirrored ones only.
    std::vector<PictureLink> find(Events &events, std::vector<CopiedPicture> &copies) {
        std::vector<PictureCopy> found = find_copies(candidates_);
        bool has_mirrored = false;
        for (const PictureCopy &copy : found) {
            has_mirrored |= copy.is_mirrored;
            if (!copy.is_mirrored) remove_features(pictures_[copy.copy].features);
        }
        std::vector<Features> features;
        for (const RegisteredPicture &picture : pictures_) features.push_back(picture.features);  // shares descriptors
        std::vector<PictureLink> links = find_links(features, events);
        if (has_mirrored) {
            mark_overlaps(found, links);
            found = find_copies(candidates_);
        }
        for (const PictureCopy &copy : found) {
            pictures_[copy.copy].is_copy = true;
            copies.push_back({copy.copy, copy.original, copy.how});
        }
        const auto has_copy = [&](const PictureLink &link) {
            return pictures_[link.picture[0]].is_copy || pictures_[link.picture[1]].is_copy;
        };
        links.erase(std::remove_if(links.begin(), links.end(), has_copy), links.end());
        return links;
    }

private:
    static void remove_features(Features &features) {
        features.places.clear();
        features.descriptors = cv::Mat();
    }

    void mark_overlaps(const std::vector<PictureCopy> &copies, const std::vector<PictureLink> &links) {
        std::vector<uint32_t> original(pictures_.size());
        std::iota(original.begin(), original.end(), 0u);
        for (const PictureCopy &copy : copies) original[copy.copy] = copy.original;
        for (const PictureLink &link : links)
            if (original[link.picture[0]] != original[link.picture[1]])
                candidates_[link.picture[0]].overlaps = candidates_[link.picture[1]].overlaps = true;
    }

    std::vector<RegisteredPicture> &pictures_;
    std::vector<CopyCandidate> candidates_;
};

// Pictures in no project, by what they overlap.
void name_single(const Grouping &grouping, const std::vector<uint32_t> &camera_ids, const std::vector<bool> &is_linked,
                 const std::vector<RegisteredPicture> &pictures, Registration &result) {
    std::set<uint32_t> taken;  // cameras
    for (uint32_t i = 0; i < camera_ids.size(); i++)
        if (grouping.takes(i)) taken.insert(camera_ids[i]);
    for (uint32_t i = 0; i < camera_ids.size(); i++) {
        if (grouping.takes(i) || !pictures[i].failure.empty() || pictures[i].is_copy) continue;
        (!is_linked[i]                ? result.isolated
         : taken.count(camera_ids[i]) ? result.disconnected
                                      : result.other_camera)
            .push_back(i);
    }
}

Registration registered(const std::vector<std::string> &files, const std::vector<PictureMetadata> &metadata,
                        bool as_one, Events &events) {
    std::vector<RegisteredPicture> pictures = read_all(files, metadata, events);
    Registration result;
    for (uint32_t i = 0; i < pictures.size(); i++)
        if (!pictures[i].failure.empty()) result.unreadable.emplace_back(i, pictures[i].failure);
    for (const RegisteredPicture &picture : pictures) result.metadata.push_back(picture.metadata);
    std::vector<PictureLink> links = Overlaps(files, pictures).find(events, result.copies);
    const std::vector<uint32_t> camera_ids = camera_ids_of(files, pictures, as_one);
    const std::vector<uint32_t> components = groups_of(pictures.size(), links);
    const std::vector<bool> is_linked = find_linked(pictures.size(), links);
    part_raw(files, links);
    const Grouping grouping(camera_ids, links);
    name_single(grouping, camera_ids, is_linked, pictures, result);
    std::map<uint32_t, std::vector<uint32_t>> members;
    for (uint32_t i = 0; i < pictures.size(); i++)
        if (grouping.takes(i)) members[grouping.group(i)].push_back(i);
    for (const auto &[group, numbers] : members) {
        events.update("finding cameras", static_cast<double>(group) / static_cast<double>(members.size()));
        result.scenes.push_back(scene_of(numbers, optics_of(pictures, numbers), links_within(links, numbers)));
        result.scenes.back().connected_group = components[numbers[0]];
        for (const uint32_t i : numbers) result.scenes.back().camera_ids.push_back(camera_ids[i]);
    }
    std::stable_sort(result.scenes.begin(), result.scenes.end(), [](const FoundScene &a, const FoundScene &b) {
        const bool a_still = a.kind == SceneKind::still, b_still = b.kind == SceneKind::still;
        return a_still != b_still ? b_still : a.pictures.size() > b.pictures.size();
    });
    return result;
}

}  // namespace

bool can_register() { return true; }

Registration register_pictures(const std::vector<std::string> &files, const std::vector<PictureMetadata> &metadata,
                               bool as_one, Events &events) {
    cv::setNumThreads(1);  // each of our threads processes one picture
    try {
        return registered(files, metadata, as_one, events);
    } catch (const cv::Exception &error) {
        if (error.code == cv::Error::StsNoMem) throw std::bad_alloc();
        throw Failure(LENSPROF_ERROR_WRITE,
                      "OpenCV failed to find overlaps: " + std::string(error.what()) + "; please report this");
    }
}

}  // namespace lensprof
