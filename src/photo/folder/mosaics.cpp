// The mosaics of the panoramas.
#include <algorithm>
#include <utility>

#include "photo/base/input_file.hpp"
#include "photo/base/parallel.hpp"
#include "photo/calibration/preview.hpp"
#include "photo/folder/attempt.hpp"
#include "photo/folder/sheet.hpp"

namespace lensprof {
namespace {

constexpr uint16_t as_stored = 1;  // EXIF orientation

// The pictures of a panorama where its project has them.
std::vector<CorrectedCopy> tiles_of(const Panorama &panorama, const CorrectedPictures &pictures, Events &events) {
    const Scene scene = panorama.corrected_scene();
    const ImagesByFile images(scene);
    std::vector<std::pair<size_t, uint32_t>> corrected;  // picture and its image
    for (size_t i = 0; i < pictures.list.size(); i++) {
        if (pictures.list[i].panorama != panorama.name) continue;
        if (const auto image = images.find(pictures.list[i].picture->file)) corrected.emplace_back(i, *image);
    }
    std::vector<CorrectedCopy> tiles(corrected.size());
    for_each_parallel(static_cast<uint32_t>(tiles.size()), "mosaic", events, [&](uint32_t n) {
        const auto [picture, image] = corrected[n];
        SmallCopies small = small_copies(pictures, picture, as_stored, tile_side);
        tiles[n] = {std::move(small.before), std::move(small.after), scene.images[image].camera, image};
    });
    const auto is_missing = [](const CorrectedCopy &tile) { return !tile.before.width || !tile.after.width; };
    tiles.erase(std::remove_if(tiles.begin(), tiles.end(), is_missing), tiles.end());
    std::sort(tiles.begin(), tiles.end(), [](const auto &a, const auto &b) { return a.image < b.image; });
    return tiles;
}

// Shows the current project, which may have been edited since the fit.
void draw(const Panorama &panorama, const CorrectedPictures &pictures, Ledger &ledger, Events &events) {
    std::string text = "preview\n" + read_text(panorama.project, max_text_bytes);
    for (const CorrectedPicture &picture : pictures.list)
        if (picture.panorama == panorama.name) text += "\n" + picture.key;
    const std::string key = digest_of_text(text);
    if (ledger.is_current(panorama.preview, key)) return;
    ledger.begin(panorama.preview, key);
    ledger.save();
    write_mosaic(panorama.preview, mosaic_of(tiles_of(panorama, pictures, events)));
    ledger.finish(panorama.preview);
    ledger.save();
}

}  // namespace

void write_mosaics(Panoramas &panoramas, const CorrectedPictures &pictures, Ledger &ledger, Events &events) {
    for (Panorama &panorama : panoramas.list) {
        stop_if_cancelled();
        if (!panorama.equalizes()) continue;
        const std::string failure = failure_of([&] { draw(panorama, pictures, ledger, events); });
        panorama.summary["preview"] = failure.empty() ? Json(panorama.preview) : Json();
        if (failure.empty()) continue;
        ledger.abandon(panorama.preview);
        panorama.summary["warnings"].push_back(panorama.preview + ": not drawn: " + failure);
    }
}

}  // namespace lensprof
