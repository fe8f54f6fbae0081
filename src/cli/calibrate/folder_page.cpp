#include "cli/calibrate/folder_page.hpp"

#include <algorithm>

#include "cli/calibrate/summary.hpp"
#include "cli/page/page.hpp"
#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/preview.hpp"
#include "photo/folder/attempt.hpp"
#include "photo/folder/sheet.hpp"
#include "photo/pictures/thumbnail.hpp"

namespace lensprof {
namespace {

// `unreadable` lists pictures that the page does not show.
Json verdict_json(const Inputs &inputs, const Panoramas &panoramas, const CorrectedPictures &pictures,
                  const Json &summary, const std::vector<std::string> &unreadable) {
    Json details = Json::array();
    const auto doubtful = std::count_if(panoramas.list.begin(), panoramas.list.end(), [](const Panorama &panorama) {
        return !panorama.equalizes() || (!panorama.page.is_null() && panorama.page["verdict"]["level"] != "good");
    });
    if (doubtful)
        details.push_back(counted(static_cast<size_t>(doubtful), "panorama")
                          + " with a warning or without a usable result: see below.");
    for (const std::string &name : unreadable)
        details.push_back(name + ": cannot be read any more; run calibrate again");
    const size_t corrected = pictures.list.size(), left_out = summary["left_out"].size();
    const std::string all =
        corrected == 1 ? "The picture is corrected." : format("All %zu pictures are corrected.", corrected);
    return {{"level", !corrected                     ? "bad"
                      : left_out || !details.empty() ? "warn"
                                                     : "good"},
            {"headline", !corrected ? "No picture is corrected."
                         : left_out ? format("%zu of %zu pictures are corrected.", corrected, inputs.found)
                                    : all},
            {"details", details}};
}

Json facts_json(const Inputs &inputs, const Panoramas &panoramas, const CorrectedPictures &pictures,
                const Json &summary) {
    Json facts = Json::array();
    const auto add = [&](const char *name, const std::string &value) { facts.push_back({name, value}); };
    const auto by_profile = std::count_if(pictures.list.begin(), pictures.list.end(),
                                          [](const CorrectedPicture &picture) { return picture.panorama.empty(); });
    add("pictures found", std::to_string(inputs.found));
    add("panoramas", std::to_string(panoramas.list.size()));
    add("corrected as part of a panorama", std::to_string(pictures.list.size() - static_cast<size_t>(by_profile)));
    add("corrected with a profile of a database", std::to_string(by_profile));
    add("left out", std::to_string(summary["left_out"].size()));
    return facts;
}

// The mosaics, then the pictures.
// Returns the names of pictures that cannot be read.
std::vector<std::string> add_views(const Panoramas &panoramas, const CorrectedPictures &pictures, Events &progress,
                                   Json &page) {
    Json views = Json::array();
    const auto mosaic_side = static_cast<uint32_t>(
        std::clamp<size_t>(12800 / std::max<size_t>(panoramas.list.size(), 1), 200, 1600));  // px: hundreds need 10 MB
    for (const Panorama &panorama : panoramas.list) {
        if (!panorama.equalizes() || views.size() == max_views) continue;
        failure_of([&] {
            Mosaic mosaic = read_preview(panorama.preview);
            views.push_back(view_json(panorama.name + ", unblended", upright_copy(mosaic.before, 1, mosaic_side),
                                      upright_copy(mosaic.after, 1, mosaic_side)));
        });
    }
    const size_t picture_count = pictures.list.size(), view_count = std::min(picture_count, max_views - views.size());
    if (view_count < picture_count) page["views_note"] = views_note(view_count, picture_count);
    const uint32_t side = view_side(view_count);
    std::vector<Json> copies(view_count);
    for_each_parallel(static_cast<uint32_t>(view_count), "report", progress, [&](uint32_t n) {
        const size_t index = n * picture_count / view_count;
        const InputPicture &input = *pictures.list[index].picture;
        const SmallCopies small = small_copies(pictures, index, input.metadata.orientation, side);
        if (small.before.width && small.after.width) copies[n] = view_json(input.name, small.before, small.after);
    });
    std::vector<std::string> unreadable;
    for (size_t n = 0; n < view_count; n++) {
        if (copies[n].is_null())
            unreadable.push_back(pictures.list[n * picture_count / view_count].picture->name);
        else
            views.push_back(std::move(copies[n]));
    }
    page["views"] = std::move(views);
    return unreadable;
}

Json panoramas_json(const Panoramas &panoramas) {
    Json list = Json::array();
    for (const Panorama &panorama : panoramas.list) {
        list.push_back({{"line", panorama_line(panorama)}, {"page", panorama.page}});
    }
    return list;
}

// How the pictures outside panoramas are corrected.
Json looked_up_json(const CorrectedPictures &pictures) {
    Json list = Json::array();
    for (const CorrectedPicture &picture : pictures.list)
        if (picture.panorama.empty())
            list.push_back({{"name", picture.picture->name}, {"correction", correction_note(picture.job)}});
    return list;
}

}  // namespace

std::string folder_page(const Inputs &inputs, const Panoramas &panoramas, const CorrectedPictures &pictures,
                        const Json &summary, const std::string &command, Events &progress) {
    Json page = new_page("folder", inputs.label, "Calibration of a folder of pictures", command);
    const std::vector<std::string> unreadable = add_views(panoramas, pictures, progress, page);
    page["verdict"] = verdict_json(inputs, panoramas, pictures, summary, unreadable);
    page["facts"] = facts_json(inputs, panoramas, pictures, summary);
    page["panoramas"] = panoramas_json(panoramas);
    page["looked_up"] = looked_up_json(pictures);
    page["left_out"] = Json::array();
    for (const Json &left_out : summary["left_out"])
        page["left_out"].push_back({{"name", left_out["file"]}, {"reason", left_out["reason"]}});
    page["result"] = summary;
    return page_of(page);
}

}  // namespace lensprof
