// Runs of commands on synthetic camera raw files.
#pragma once

#include "cli_runs.hpp"
#include "raw_files.hpp"

namespace raw_runs {

using namespace cli_runs;
using namespace raw_files;

inline void needs_libraw() {
    if (can_read_raw()) return;
    print_message("built without LibRaw\n");
    skip();
}

// Overlapping pictures as rendered by simulate, linear, converted to mosaics.
inline void make_mosaics(const std::string &folder) {
    must_exit(done, {"simulate", "-o", folder, "--images", "6", "--size", "480x360", "--response", "linear",
                     "--vignetting", "-0.4,0.1,-0.05", "--format", "png16", "--set", "test-points=2000"});
    for (const auto &entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() != ".png") continue;
        const Picture picture = read_picture(entry.path().string());
        Dng dng;
        dng.width = picture.width, dng.height = picture.height, dng.bits = 14, dng.packing = Packing::lossless;
        dng.white = 16383, dng.black = {512, 510, 514, 512};
        for (uint32_t y = 0; y < dng.height; y++)
            for (uint32_t x = 0; x < dng.width; x++) {
                const size_t place = y % 2 * 2 + x % 2;
                const auto *row = reinterpret_cast<const uint16_t *>(picture.pixels.data() + y * picture.row_bytes);
                const double value = row[3 * x + dng.pattern[place]] / 65535.0;
                dng.values.push_back(
                    static_cast<uint16_t>(std::lround(dng.black[place] + value * (dng.white - dng.black[place]))));
            }
        save(fs::path(entry.path()).replace_extension(".dng").string(), dng_bytes(dng));
        fs::remove(entry.path());
    }
}

}  // namespace raw_runs
