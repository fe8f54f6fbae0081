// The report of `lensprof flat --fields`: a JSON object, a table and a web page.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/fitting/fields.hpp"
#include "cli/page/page.hpp"
#include "cli/report/findings.hpp"
#include "photo/base/format.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json smoothnesses_json(const FieldFit &found, uint32_t channel) {
    Json tried = Json::array();
    lensprof_error error{};
    for (uint32_t i = 0; i < found.fit.smoothnesses; i++) {
        lensprof_fields_smoothness smoothness;
        check(lensprof_fields_smoothness_at(found.held.get(), channel, i, &smoothness, &error), "fit", &error);
        tried.push_back({{"order", smoothness.order}, {"weight", smoothness.weight}, {"rms", finite(smoothness.rms)}});
    }
    return tried;
}

Json channels_json(const FieldFit &found) {
    Json channels = Json::array();
    for (uint32_t c = 0; c < found.fit.channels; c++) {
        const lensprof_fields_channel &channel = found.fit.channel[c];
        channels.push_back({{"offset", channel.offset * found.full_scale},
                            {"offset_sigma", finite(channel.offset_sigma * found.full_scale)},
                            {"offset_found", channel.offset_found != 0},
                            {"shading_error", finite(channel.shading_error)},
                            {"heldout_rms", finite(channel.heldout_rms)},
                            {"even_rms", finite(channel.even_rms)},
                            {"smoothness", channel.smoothness},
                            {"smoothnesses", smoothnesses_json(found, c)},
                            {"pattern", channel.pattern},
                            {"pattern_share", channel.pattern_share},
                            {"background_share", channel.background_share},
                            {"background_sigma", channel.background_sigma},
                            {"iterations", channel.iterations},
                            {"converged", channel.converged != 0}});
    }
    return channels;
}

Json field_images_json(const FieldFit &found) {
    Json images = Json::array();
    for (size_t i = 0; i < found.names.size(); i++) {
        const lensprof_fields_image &image = found.images[i];
        Json levels = Json::array();
        for (uint32_t c = 0; c < found.fit.channels; c++) levels.push_back(finite(image.level[c] * found.full_scale));
        images.push_back({{"file", found.names[i]},
                          {"used", image.used != 0},
                          {"same_as", image.same_as == i ? Json() : Json(found.names[image.same_as])},
                          {"level", levels},
                          {"white_share", image.white_share},
                          {"pixel_share", image.pixel_share}});
    }
    return images;
}

struct Extremes {
    double low = 1.0, high = 1.0;
};

Extremes extremes_of(const lensprof_gain_grid &grid, uint32_t channel) {
    const uint32_t nodes = grid.columns * grid.rows;
    if (!nodes) return {};
    const float *first = grid.attenuation + channel * nodes;
    const auto [low, high] = std::minmax_element(first, first + nodes);
    return {static_cast<double>(*low), static_cast<double>(*high)};
}

std::string offset_text(const FieldFit &found, const lensprof_fields_channel &channel) {
    const double offset = channel.offset * found.full_scale, sigma = channel.offset_sigma * found.full_scale;
    const char *const digits = found.full_scale > 1.0 ? "%.1f" : "%.6g";
    if (channel.offset_found) return with_decimals_of(sigma, offset) + " +- " + error_text(sigma);
    return format(digits, offset) + (found.is_black_given ? ", given" : ", not estimated");
}

// The grey value of a pixel, or of its green channel.
double grey_at(const Picture &picture, uint32_t x, uint32_t y) {
    const size_t channel = lensprof_layout_channels(picture.layout) == 3 ? 1 : 0;
    const size_t sample = size_t(x) * lensprof_layout_samples(picture.layout) + channel;
    return sample_value(picture.sample, picture.pixels.data() + y * picture.row_bytes, sample);
}

Picture grey_view(uint32_t width, uint32_t height, const std::vector<double> &values, double white) {
    Picture view;
    view.width = view.frame_width = width, view.height = view.frame_height = height;
    view.layout = LENSPROF_LAYOUT_GREY, view.row_bytes = width;
    for (double value : values)
        view.pixels.push_back(static_cast<uint8_t>(std::clamp(value > 0.0 ? 255.0 * value / white : 0.0, 0.0, 255.0)));
    return view;
}

// The first picture without its offset, and without the shading as well. White is what 0.5 % of its pixels exceed.
Json first_view(const FieldFit &found) {
    ReadOptions read;
    read.max_side = view_side(1);
    read.page = found.first.page, read.page_offset = found.first.offset;
    const Picture picture = read_picture(found.first.file, read);
    const uint32_t channel = found.fit.channels == 3 ? 1 : 0;
    std::vector<double> before, after;
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++) {
            const double light = grey_at(picture, x, y) - found.fit.channel[channel].offset;
            before.push_back(light);
            after.push_back(
                light / lensprof_gain_grid_eval(&found.fit.shading, picture.width, picture.height, x, y, channel));
        }
    std::vector<double> sorted;
    std::copy_if(before.begin(), before.end(), std::back_inserter(sorted), [](double v) { return std::isfinite(v); });
    if (sorted.empty()) return Json();
    const auto white = sorted.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), white, sorted.end());
    const double level = std::max(*white, 1e-9);
    return view_json(found.first.name, grey_view(picture.width, picture.height, before, level),
                     grey_view(picture.width, picture.height, after, level));
}

Json fields_facts(const FieldFit &found) {
    Json facts = Json::array();
    const auto add = [&](const std::string &name, const std::string &value) { facts.push_back({name, value}); };
    add("pictures", format("%u of %zu", found.fit.used, found.names.size()));
    for (uint32_t c = 0; c < found.fit.channels && found.fit.shading.columns; c++) {
        static const char *const names[] = {" (red)", " (green)", " (blue)"};
        const std::string of = found.fit.channels == 3 ? names[c] : "";
        const Extremes range = extremes_of(found.fit.shading, c);
        add("shading" + of, format("%.3f to %.3f", range.low, range.high));
        add("standard error" + of, error_text(100.0 * found.fit.channel[c].shading_error) + " %");
        add("offset" + of, offset_text(found, found.fit.channel[c]));
    }
    return facts;
}

}  // namespace

Json fields_json(const FieldFit &found) {
    const lensprof_fields_result &fit = found.fit;
    Json json;
    json["schema"] = json_schema;
    json["method"] = "fields";
    json["usable"] = fit.usable != 0;
    add_verdict(found.verdict, json);
    json["width"] = found.width, json["height"] = found.height;
    json["full_scale"] = found.full_scale;
    json["used"] = fit.used;
    json["repeated"] = fit.repeated, json["black"] = fit.black, json["white"] = fit.white;
    json["left_out"] = found.left_out;
    json["white_share"] = fit.white_share, json["unseen_share"] = fit.unseen_share;
    json["channels"] = fit.shading.columns ? channels_json(found) : Json::array();
    json["shading"] = gain_grid_json(fit.shading);
    json["images"] = field_images_json(found);
    json["response"] = response_json(found.response.data(), static_cast<uint32_t>(found.response.size()));
    json["seconds"] = {{"load", found.load_s}, {"solve", found.solve_s}};
    json["profile"] = found.profile_id ? Json(found.profile_id) : Json();
    return json;
}

void print_fields(const FieldFit &found, std::ostream &out) {
    const lensprof_fields_result &fit = found.fit;
    out << format("pictures  %u of %zu in %zu file%s, %u x %u px", fit.used, found.names.size(), found.files,
                  found.files == 1 ? "" : "s", found.width, found.height)
        << (found.left_out.empty() ? "" : format("; %zu could not be read", found.left_out.size())) << "\n";
    for (uint32_t c = 0; c < fit.channels && fit.shading.columns; c++) {
        static const char *const names[] = {"red  ", "green", "blue "};
        const lensprof_fields_channel &channel = fit.channel[c];
        const Extremes range = extremes_of(fit.shading, c);
        out << format("shading   %s%.3f to %.3f of the middle, +- %s %%; held-out pictures %.2f %% (%.2f %% if even)\n",
                      fit.channels == 3 ? format("%s ", names[c]).c_str() : "", range.low, range.high,
                      error_text(100.0 * channel.shading_error).c_str(), 100.0 * channel.heldout_rms,
                      100.0 * channel.even_rms);
        out << "offset    " << (fit.channels == 3 ? format("%s ", names[c]) : std::string())
            << offset_text(found, channel)
            << (found.full_scale > 1.0 ? format(" of %.0f", found.full_scale) : std::string()) << "\n";
    }
    out << format("time      load %.2f s, solve %.2f s\n", found.load_s, found.solve_s);
    if (!fit.usable) out << "NOT USABLE: " << found.verdict.headline() << "\n";
    print_findings(found.verdict, out);
}

std::string fields_page(const FieldFit &found, const std::string &title, const std::string &command,
                        const std::vector<std::string> &warnings) {
    Json page = new_page("card", title, "Shading of many pictures", command);
    page["verdict"] = page_verdict(found.fit.usable, false, found.verdict, warnings);
    page["facts"] = fields_facts(found);
    page["falloffs"] = Json::array(), page["falloff_points"] = Json::array(), page["responses"] = Json::array();
    page["images"] = Json::array();
    if (found.fit.shading.columns) page["views"] = Json::array({first_view(found)});
    page["result"] = fields_json(found);
    return page_of(page);
}

}  // namespace lensprof
