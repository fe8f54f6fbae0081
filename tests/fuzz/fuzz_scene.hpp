// Common parts of the fuzz targets for reconstructions: a folder with the files of a reconstruction, and the invariants
// of a result. In the corpus, several files are joined into one with a separator line.
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "fuzz_file.hpp"
#include "photo/reconstruction/match_choice.hpp"
#include "photo/reconstruction/pictures.hpp"
#include "photo/reconstruction/readers.hpp"

namespace {

const std::string kNextFile = "\n--- the next file\n";

class Folder {
public:
    Folder() {
        path_ = (std::filesystem::temp_directory_path() / "lensprof-fuzz-XXXXXX").string();
        demand(mkdtemp(path_.data()) != nullptr, "cannot create the folder");
    }
    Folder(const Folder &) = delete;
    Folder &operator=(const Folder &) = delete;
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    const std::string &path() const { return path_; }
    std::string path(const std::string &name) const { return path_ + "/" + name; }

    void write(const std::string &name, const std::string &bytes) const {
        std::filesystem::remove(path(name));  // overwriting it in place would wait for the disk
        std::ofstream file(path(name), std::ios::binary);
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        demand(file.good(), "cannot write the file");
    }
    // The parts of a corpus file; missing parts are not written.
    void write_parts(const std::vector<char> &bytes, const std::vector<std::string> &names) const {
        const std::string text(bytes.begin(), bytes.end());
        size_t at = 0;
        for (const std::string &name : names) {
            std::filesystem::remove(path(name));
            if (at == std::string::npos) continue;
            const size_t end = text.find(kNextFile, at);
            write(name, text.substr(at, end - at));
            at = end == std::string::npos ? end : end + kNextFile.size();
        }
    }

private:
    std::string path_;
};

// True if `call` returns; false if it throws Failure as unreadable or not usable, with a text.
template <typename Call>
[[maybe_unused]] bool is_done(const Call &call) {
    try {
        call();
        return true;
    } catch (const lensprof::Failure &failure) {
        demand(failure.group() == LENSPROF_ERROR_READ || failure.group() == LENSPROF_ERROR_NOT_USABLE, failure.what());
        demand(failure.what()[0], "a failure without a text");
        return false;
    }
}

[[maybe_unused]] void check_scene(const lensprof::Reconstruction &r) {
    std::set<std::string> names;
    for (const auto &image : r.images) {
        demand(!image.name.empty() && names.insert(image.name).second, "empty or repeated image name");
        demand(image.camera < r.cameras.size(), "an image without a camera");
        demand(!image.has_centre || lensprof::is_finite(image.centre), "centre is not finite");
    }
    demand(!r.observations.empty(), "no observation");
    demand(r.points.empty() || r.points.size() == r.point_count(), "number of positions differs");
    for (size_t n = 0; n < r.observations.size(); n++) {
        const auto &own = r.observations[n];
        demand(own.image < r.images.size(), "observation without an image");
        demand(std::isfinite(own.xy[0]) && std::isfinite(own.xy[1]), "observation without a position");
        if (n == 0) continue;
        const auto &last = r.observations[n - 1];
        demand(own.point == last.point ? own.image > last.image : own.point == last.point + 1, "not in order");
        demand(own.point == last.point || n == 1 || r.observations[n - 2].point == last.point, "a point seen once");
    }
}

// Reads, and continues as `build` does, without pictures.
template <typename Read>
[[maybe_unused]] bool try_scene(const Read &read) {
    lensprof::Reconstruction r;
    if (!is_done([&] { r = read(); })) return false;
    check_scene(r);
    lensprof::matches_of(r, lensprof::choose_pairs(r, 2, 1));
    is_done([&] { lensprof::convert_coordinates(r, {}); });
    return true;
}

}  // namespace
