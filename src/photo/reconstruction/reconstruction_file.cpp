#include "photo/reconstruction/reconstruction_file.hpp"

#include <filesystem>
#include <vector>

#include "photo/base/paths.hpp"
#include "photo/reconstruction/readers.hpp"

namespace lensprof {
namespace {

struct Format {
    bool (*is)(const std::string &);
    Reconstruction (*read)(const std::string &);
};

const Format file_formats[] = {{is_colmap_database, read_colmap_database},
                               {is_opensfm_tracks, read_opensfm},
                               {is_bundler, read_bundler},
                               {is_alicevision, read_alicevision},
                               {is_openmvg, read_openmvg}};

const Format *format_of(const std::string &path) {
    for (const Format &format : file_formats)
        if (format.is(path)) return &format;
    return nullptr;
}

std::string below(const std::string &folder, const std::string &name) {
    return (std::filesystem::path(folder) / name).lexically_normal().string();
}

// The largest of the models in folder/0, folder/1, ...; empty if not found. `models` is their number.
std::string numbered_model(const std::string &folder, size_t &models) {
    std::string best;
    uint64_t max_points = 0;
    for (models = 0;; models++) {
        const std::string model_folder = below(folder, std::to_string(models));
        if (!is_colmap_model(model_folder)) return best;
        const uint64_t bytes = file_bytes(model_folder + "/images.bin") + file_bytes(model_folder + "/images.txt");
        if (best.empty() || bytes > max_points) best = model_folder, max_points = bytes;
    }
}

// The model of a folder: in the folder, in its subfolder sparse, or the largest of numbered ones (sparse/0, 0, ...).
std::string model_folder(const std::string &folder, size_t &models) {
    models = 1;
    for (const char *name : {"", "sparse"})
        if (is_colmap_model(below(folder, name))) return *name ? below(folder, name) : folder;
    const std::string model = numbered_model(below(folder, "sparse"), models);
    return model.empty() ? numbered_model(folder, models) : model;
}

// Files of a folder under their usual names, the first of which is used; empty: none.
std::string file_in(const std::string &folder) {
    for (const char *name : {"database.db", "tracks.csv", "opensfm/tracks.csv", "bundle.out", "bundle/bundle.out",
                             "sfm_data.json", "sfm.sfm", "cameras.sfm"}) {
        const std::string file = below(folder, name);
        if (format_of(file)) return file;
    }
    return {};
}

Reconstruction read_model(const std::string &folder, Events &events) {
    Reconstruction model = read_colmap_model(folder);
    for (const char *name : {"database.db", "../database.db", "../../database.db"}) {
        const std::string database = below(folder, name);
        if (!is_colmap_database(database)) continue;
        if (!take_shapes(database, model))
            events.note(database, "not used, because " + folder + " was not made from it");
        break;
    }
    return model;
}

}  // namespace

bool is_reconstruction(const std::string &path) {
    if (!is_folder(path)) return format_of(path) != nullptr || is_database(path);
    size_t models = 0;
    return !model_folder(path, models).empty() || !file_in(path).empty();
}

std::vector<std::string> files_of_reconstruction(const std::string &path) {
    namespace fs = std::filesystem;
    const std::string own_folder = is_folder(path) ? path : fs::path(path).parent_path().string();
    size_t models = 0;
    std::vector<std::string> files{path}, folders{own_folder.empty() ? "." : own_folder};
    for (const char *above : {"..", "../.."}) folders.push_back(below(folders[0], above));
    if (is_folder(path) && !model_folder(path, models).empty()) folders.push_back(model_folder(path, models));
    for (const std::string &folder : folders)
        for (const char *name : {"database.db", "database.db-wal", "database.db-shm", "cameras.bin", "cameras.txt",
                                 "images.bin", "images.txt", "points3D.bin", "points3D.txt", "reconstruction.json",
                                 "tracks.csv", "opensfm/tracks.csv", "opensfm/reconstruction.json", "bundle.out",
                                 "list.txt", "image_list.txt", "sfm_data.json", "sfm.sfm", "cameras.sfm"})
            files.push_back(below(folder, name));
    for (const char *end : {"-wal", "-shm", ".list.txt"}) files.push_back(path + end);
    return files;
}

Reconstruction read_reconstruction(const std::string &path, Events &events) {
    size_t models = 0;
    const bool is_in_folder = is_folder(path);
    const std::string model = is_in_folder ? model_folder(path, models) : std::string();
    if (model.empty()) {
        const std::string file = is_in_folder ? file_in(path) : path;
        const Format *format = format_of(file);
        return format ? format->read(file) : read_colmap_database(file);  // which reports what is missing
    }
    if (models > 1)
        events.note(path, "has " + std::to_string(models) + " models; reading the largest, " + model
                              + ". database.db has all images");
    return read_model(model, events);
}

}  // namespace lensprof
