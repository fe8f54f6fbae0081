#include "photo/reconstruction/pictures.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/orientation.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> candidate_folders(const Reconstruction &r) {
    const fs::path own_folder = is_folder(r.path) ? fs::path(r.path) : fs::path(r.path).parent_path();
    std::vector<std::string> folders;
    if (!r.folder.empty()) folders.push_back(r.folder);
    for (const fs::path &base : {own_folder, own_folder / "..", own_folder / "../.."})
        for (const char *below : {"", "images"}) folders.push_back((base / below).lexically_normal().string());
    return folders;
}

size_t count_found(const Reconstruction &r, const std::string &folder) {
    return static_cast<size_t>(std::count_if(r.images.begin(), r.images.end(), [&](const ReconstructionImage &image) {
        return is_regular_file(picture_of_name(folder, image.name));
    }));
}

// The size after EXIF orientation.
ReconstructionCamera upright_size(const ReconstructionCamera &stored, uint16_t orientation) {
    return swaps_sides(orientation) ? ReconstructionCamera{stored.height, stored.width} : stored;
}

// Converts px of the upright picture to px of the stored one, by EXIF orientation.
void turn_back(const ReconstructionCamera &upright, uint16_t orientation, float xy[2]) {
    const ReconstructionCamera stored = upright_size(upright, orientation);
    double x = xy[0] - 0.5 * (upright.width - 1.0), y = xy[1] - 0.5 * (upright.height - 1.0);
    turn_upright(inverse_orientation(orientation), x, y);
    xy[0] = static_cast<float>(x + 0.5 * (stored.width - 1.0)),
    xy[1] = static_cast<float>(y + 0.5 * (stored.height - 1.0));
}

// Failure if two images have the same file: the subfolders of their names are missing.
void check_each_once(const Reconstruction &r, const std::vector<std::string> &files) {
    std::map<std::string, size_t> image_of;
    for (size_t i = 0; i < files.size(); i++) {
        const auto [other, is_new] = image_of.emplace(file_identity(files[i]), i);
        if (!is_new)
            throw Failure(LENSPROF_ERROR_READ, files[i] + ": would be both " + r.images[other->second].name + " and "
                                                   + r.images[i].name
                                                   + "; give the folder that contains the subfolders of their names");
    }
}

struct Frame {
    ReconstructionCamera stored;
    uint16_t orientation = 1;
};

Frame frame_of(const Reconstruction &r, const ReconstructionImage &image, const std::string &file) {
    const ReconstructionCamera &stated = r.cameras[image.camera];
    if (file.empty()) {
        if (!stated.width)
            throw Failure(LENSPROF_ERROR_READ, r.path + ": does not state the size of " + image.name
                                                   + "; give its pictures with " + option_name("images")
                                                   + ", or put reconstruction.json next to it");
        return {stated, 1};
    }
    const Picture header = read_header(file, {});
    const PictureMetadata metadata = read_metadata(file);
    if (metadata.mark && metadata.mark->falloff == CorrectionMark::Falloff::removed)
        throw Failure(
            LENSPROF_ERROR_READ,
            file + ": already corrected by lensprof; give the folder of the originals with " + option_name("images"));
    Frame frame{{header.frame_width, header.frame_height}, 1};
    if (r.coordinates == ImageCoordinates::upright_centred) frame.orientation = metadata.orientation;
    const ReconstructionCamera size = upright_size(frame.stored, frame.orientation);
    if (stated.width && (stated.width != size.width || stated.height != size.height))
        throw Failure(LENSPROF_ERROR_READ,
                      file + format(": is %u x %u pixels, but ", size.width, size.height) + r.path
                          + format(" states %u x %u: it was resized or rotated since; give the pictures that were "
                                   "matched",
                                   stated.width, stated.height));
    return frame;
}

void convert_to_stored_px(const Reconstruction &r, const Frame &frame, TrackObservation &observation) {
    const ReconstructionCamera upright = upright_size(frame.stored, frame.orientation);
    const float size[2] = {float(upright.width), float(upright.height)};
    const float unit = r.coordinates == ImageCoordinates::upright_centred ? std::max(size[0], size[1]) : 1.0f;
    for (int d = 0; d < 2 && r.coordinates != ImageCoordinates::stored_px; d++)
        observation.xy[d] = observation.xy[d] * unit + (size[d] - 1.0f) / 2.0f;
    for (auto &row : observation.shape)
        for (float &value : row) value *= unit;
    for (int d = 0; d < 2; d++)
        if (!(observation.xy[d] >= -1.0f && observation.xy[d] <= size[d]))
            throw Failure(
                LENSPROF_ERROR_READ,
                r.path
                    + format(": has a feature at %.1f, %.1f in ", double(observation.xy[0]), double(observation.xy[1]))
                    + r.images[observation.image].name
                    + format(", which has only %u x %u pixels; give the pictures that were matched", upright.width,
                             upright.height));
    turn_back(upright, frame.orientation, observation.xy);
}

}  // namespace

std::string picture_of_name(const std::string &folder, const std::string &name) {
    const std::string path = (fs::path(folder) / name).string();  // an absolute name unchanged
    const std::string last = (fs::path(folder) / fs::path(name).filename()).string();
    const bool is_elsewhere = fs::path(name).is_absolute() || !is_regular_file(path);
    return is_elsewhere && is_regular_file(last) ? last : path;
}

std::vector<std::string> find_pictures(const Reconstruction &r, const std::string &folder, bool allow_missing) {
    const std::vector<std::string> folders = folder.empty() ? candidate_folders(r) : std::vector<std::string>{folder};
    std::string best = folders[0];
    size_t max_count = 0;
    for (const std::string &candidate : folders)
        if (const size_t found = count_found(r, candidate); found > max_count) max_count = found, best = candidate;
    if (!max_count && allow_missing) return {};
    std::vector<std::string> files;
    std::string missing;
    for (const ReconstructionImage &image : r.images) {
        files.push_back(picture_of_name(best, image.name));
        if (missing.empty() && !is_regular_file(files.back())) missing = image.name;
    }
    if (missing.empty()) {
        check_each_once(r, files);
        return files;
    }
    const std::string counts =
        format(": %zu of its %zu pictures, the first ", r.images.size() - max_count, r.images.size());
    throw Failure(
        LENSPROF_ERROR_READ,
        r.path + counts + missing + ", are not in "
            + (max_count || !folder.empty() ? best : std::string("its folder or the images folder next to it"))
            + (folder.empty() ? "; give their folder with " + option_name("images")
                              : "; give the folder that contains all")
            + (max_count ? ", or list the images to use with " + option_name("image_list") : ""));
}

void convert_coordinates(Reconstruction &r, const std::vector<std::string> &files) {
    std::vector<Frame> frames;
    for (size_t i = 0; i < r.images.size(); i++) {
        stop_if_cancelled();
        frames.push_back(frame_of(r, r.images[i], files.empty() ? std::string() : files[i]));
    }
    for (TrackObservation &observation : r.observations)
        convert_to_stored_px(r, frames[observation.image], observation);
    r.cameras.clear();
    for (uint32_t i = 0; i < r.images.size(); i++) {
        r.images[i].camera = i;
        r.cameras.push_back(frames[i].stored);
    }
    r.coordinates = ImageCoordinates::stored_px;
}

}  // namespace lensprof
