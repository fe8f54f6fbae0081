// The library of the page in the browser: cards and profile files in; the falloff, corrected pixels and files out.
//
// worker.js calls these functions, one at a time. What they answer is JSON, valid until the next call: a result, or
// {"error": "one sentence"}, and the state is then as before. Pixels are RGBA, rows without gaps.
#include <lensprof/flat.h>
#include <lensprof/formats.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#define PAGE_API __attribute__((used))  // exported by Emscripten

namespace {

using Json = nlohmann::json;

constexpr uint32_t kMaxSide = 1600;  // px of a card as it is measured; 50 cells across need no more
constexpr uint32_t kCurvePoints = 61;

// A card, reduced.
struct Card {
    std::vector<uint8_t> pixels;
    lensprof_flat_image image;
};

std::vector<Card> cards;
std::vector<lensprof_profile> profiles;
std::vector<uint8_t> file;

void check(lensprof_status status, const lensprof_error &error) {
    if (status == LENSPROF_OK) return;
    throw std::runtime_error(*error.text ? error.text : lensprof_status_name(status));
}

// What `work` returns, or why it failed.
template <class Work>
const char *answer(Work &&work) noexcept {
    static std::string text;
    try {
        const Json json = work();
        text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    } catch (const std::bad_alloc &) {
        text = R"({"error": "there is not enough memory; use smaller pictures, or fewer"})";
    } catch (const std::exception &failure) {
        text = Json{{"error", failure.what()}}.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    return text.c_str();
}

// ---- Cards ----

// One stored pixel is the mean of a square; of a square with a saturated or black sample it is that sample, so that the
// fit leaves it out. Alpha is the least of the square.
template <class Sample>
void reduce(const Sample *from, uint32_t width, uint32_t side, double black, double white, Card &card) {
    const lensprof_image &view = card.image.view;
    auto *to = reinterpret_cast<Sample *>(card.pixels.data());
    const double count = double(side) * side;
    for (uint32_t y = 0; y < view.height; y++)
        for (uint32_t x = 0; x < view.width; x++)
            for (uint32_t c = 0; c < 4; c++) {
                double sum = 0.0, least = INFINITY, largest = -INFINITY;
                for (uint32_t v = 0; v < side; v++)
                    for (uint32_t u = 0; u < side; u++) {
                        const double value = from[(size_t(y * side + v) * width + size_t(x) * side + u) * 4 + c];
                        sum += value, least = std::min(least, value), largest = std::max(largest, value);
                    }
                const double mean = c == 3 || least < black ? least : largest > white ? largest : sum / count;
                *to++ = static_cast<Sample>(std::is_integral<Sample>::value ? std::floor(mean + 0.5) : mean);
            }
}

Card card_of(const void *rgba, uint32_t width, uint32_t height, uint32_t sample, double ev, double rotation_deg) {
    Card card;
    lensprof_flat_image &image = card.image;
    lensprof_flat_image_init(&image);
    const uint32_t side = std::max(1u, std::min({std::max(width, height) / kMaxSide, width, height}));
    const size_t row_bytes = size_t(width / side) * 4 * lensprof_sample_type_bytes(sample);
    card.pixels.resize(row_bytes * (height / side));
    image.width = width, image.height = height, image.reduction = side;
    image.ev = ev, image.rotation_deg = rotation_deg;
    image.view = {card.pixels.data(),  static_cast<ptrdiff_t>(row_bytes), width / side, height / side, sample,
                  LENSPROF_LAYOUT_RGBA};
    const double black = image.black, white = image.white;
    if (sample == LENSPROF_SAMPLE_U8)
        reduce(static_cast<const uint8_t *>(rgba), width, side, 255.0 * black, 255.0 * white, card);
    else if (sample == LENSPROF_SAMPLE_U16)
        reduce(static_cast<const uint16_t *>(rgba), width, side, 65535.0 * black, 65535.0 * white, card);
    else
        reduce(static_cast<const float *>(rgba), width, side, black, white, card);
    return card;
}

// ---- Responses ----

// "linear", "srgb", "gamma:G", or "typical": that of the camera's kind, with what it leaves unknown in the provenance.
lensprof_response response_of(const std::string &name, lensprof_profile_key key, lensprof_provenance *provenance) {
    lensprof_response response;
    lensprof_response_set_linear(&response);
    lensprof_error error{};
    if (name == "srgb") {
        lensprof_response_set_srgb(&response);
    } else if (name.rfind("gamma:", 0) == 0) {
        if (lensprof_response_set_gamma(&response, std::strtod(name.c_str() + 6, nullptr)) != LENSPROF_OK)
            throw std::runtime_error(name.substr(6) + ": is not a gamma; give one from 0.1 to 10");
    } else if (name == "typical") {
        key.processing = LENSPROF_PROCESSING_JPEG;
        double gamma_sigma = 0.0;
        check(lensprof_response_set_typical(&response, lensprof_camera_kind_of(&key), nullptr, &gamma_sigma), error);
        if (provenance) {
            provenance->gamma_sigma = gamma_sigma;
            std::strcpy(provenance->doubt, LENSPROF_DOUBT_RESPONSE);
        }
    } else if (name != "linear") {
        throw std::runtime_error(name + ": is not a response; use linear, srgb, typical or gamma:G");
    }
    return response;
}

// ---- Profiles as JSON ----

Json number(double value) { return value == LENSPROF_UNKNOWN || !std::isfinite(value) ? Json() : Json(value); }

Json json_of(const lensprof_profile_key &key) {
    return {{"maker", key.camera_maker},
            {"camera", key.camera_model},
            {"lens", key.lens},
            {"crop", number(key.crop_factor)},
            {"focal_mm", number(key.focal_mm)},
            {"aperture", number(key.aperture)},
            {"distance_m", number(key.distance_m)},
            {"rendered", key.processing != LENSPROF_PROCESSING_RAW}};
}

template <size_t Room>
void take_text(const Json &json, const char *name, char (&field)[Room]) {
    const std::string text = json.value(name, std::string());
    if (text.size() >= Room)
        throw std::runtime_error(std::string(name) + ": is longer than " + std::to_string(Room - 1)
                                 + " bytes; shorten it");
    std::memset(field, 0, Room);
    text.copy(field, Room - 1);
}

void take_number(const Json &json, const char *name, double &field) {
    const Json value = json.value(name, Json());
    field = value.is_number() ? value.get<double>() : LENSPROF_UNKNOWN;
    if (value.is_number() && !(field > 0.0))
        throw std::runtime_error(std::string(name) + ": must be above 0; correct it, or leave it empty");
}

lensprof_profile_key key_of(const Json &json, lensprof_profile_key key) {
    take_text(json, "maker", key.camera_maker);
    take_text(json, "camera", key.camera_model);
    take_text(json, "lens", key.lens);
    take_number(json, "crop", key.crop_factor);
    take_number(json, "focal_mm", key.focal_mm);
    take_number(json, "aperture", key.aperture);
    take_number(json, "distance_m", key.distance_m);
    if (lensprof_profile_key_validate(&key) != LENSPROF_OK)
        throw std::runtime_error(
            "camera, lens or setting has a control character, or a number out of range; correct it");
    return key;
}

// The light at `share` of the way from the middle of the frame to its corners, mean of the four, and its standard
// error, with that of an uncertain response: ln M changes by the factor 1 +- gamma_sigma. Empty outside of the image
// circle.
Json point_of(const lensprof_profile &profile, uint32_t channel, uint32_t width, uint32_t height, double share) {
    double light = 0.0, sigma = 0.0;
    for (int corner = 0; corner < 4; corner++) {
        const double x = 0.5 * (width - 1.0) * (1.0 + (corner % 2 ? share : -share));
        const double y = 0.5 * (height - 1.0) * (1.0 + (corner / 2 ? share : -share));
        if (profile.image_circle.radius > 0.0
            && !lensprof_image_circle_contains(&profile.image_circle, width, height, x, y))
            return Json();
        double own = 0.0;
        light += 0.25 * lensprof_profile_falloff(&profile, channel, width, height, x, y, &own);
        sigma = own == LENSPROF_UNKNOWN || sigma == LENSPROF_UNKNOWN ? LENSPROF_UNKNOWN : std::max(sigma, own);
    }
    if (sigma != LENSPROF_UNKNOWN)
        sigma = std::hypot(sigma, light * std::log(light) * std::max(profile.provenance.gamma_sigma, 0.0));
    return {share, light, number(sigma)};
}

Json curves_of(const lensprof_profile &profile, uint32_t width, uint32_t height) {
    Json curves = Json::array();
    for (uint32_t channel = 0; channel < profile.vignettings; channel++) {
        Json curve = Json::array();
        for (uint32_t i = 0; i < kCurvePoints; i++) {
            Json point = point_of(profile, channel, width, height, double(i) / (kCurvePoints - 1));
            if (!point.is_null()) curve.push_back(std::move(point));
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

const lensprof_profile &profile_at(uint32_t index) {
    if (index >= profiles.size()) throw std::runtime_error("there is no profile yet; give cards, or a profile file");
    return profiles[index];
}

Json findings_of(const lensprof_flat *flat, const lensprof_flat_result &result) {
    static const char *const kinds[] = {"passed", "note", "warning", "refusal"};
    Json findings = Json::array();
    for (uint32_t i = 0; i < result.findings; i++) {
        lensprof_finding finding;
        lensprof_finding_init(&finding);
        lensprof_error error{};
        check(lensprof_flat_finding_at(flat, i, &finding, &error), error);
        findings.push_back({{"kind", kinds[std::min(finding.severity, 3u)]}, {"text", finding.text}});
    }
    return findings;
}

Json fit(const Json &wanted) {
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    key = key_of(wanted.at("key"), key);
    const std::string name = wanted.at("response");
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    lensprof_provenance doubted = profile.provenance;
    const lensprof_response response = response_of(name, key, &doubted);
    if (name == "linear") key.processing = LENSPROF_PROCESSING_RAW;

    lensprof_flat_options options;
    lensprof_flat_options_init(&options);
    options.response = &response;
    options.responses = 1;
    options.threads = 1;
    options.vignettings = wanted.value("lossy", false) ? 1 : 0;  // JPEG rounds colours over blocks of pixels
    if (wanted.value("radial", false)) options.grid = LENSPROF_FLAT_GRID_NONE;
    options.own_light = 1;
    std::vector<lensprof_flat_image> images;
    for (const Card &card : cards) {
        images.push_back(card.image);
        images.back().shot = static_cast<uint32_t>(images.size() - 1);
        if (card.image.rotation_deg != 0.0) options.own_light = 0;  // one light, which the rotation separates
    }
    lensprof_error error{};
    lensprof_flat *made = nullptr;
    check(lensprof_fit_flat(&options, images.data(), static_cast<uint32_t>(images.size()), nullptr, 0, &made, &error),
          error);
    const std::unique_ptr<lensprof_flat, void (*)(lensprof_flat *)> flat(made, lensprof_flat_destroy);
    auto result = std::make_unique<lensprof_flat_result>();
    lensprof_flat_result_init(result.get());
    check(lensprof_flat_get(made, result.get(), &error), error);
    check(lensprof_flat_profile(made, &profile, &error), error);
    profile.key = key;
    profile.provenance.gamma_sigma = doubted.gamma_sigma;
    std::memcpy(profile.provenance.doubt, doubted.doubt, sizeof doubted.doubt);
    const Json found = {{"usable", result->usable != 0}, {"findings", findings_of(made, *result)}};
    profiles.assign(1, profile);
    return found;
}

lensprof_status keep_profile(void *user, const lensprof_import_entry *entry) {
    if (!entry->usable || entry->holds == LENSPROF_HOLDS_RESPONSE) return LENSPROF_OK;
    lensprof_profile profile;
    lensprof_profile_init(&profile);
    const lensprof_status status = lensprof_profile_copy(&profile, entry->profile);
    if (status == LENSPROF_OK) static_cast<std::vector<lensprof_profile> *>(user)->push_back(profile);
    return status;
}

uint32_t format_named(const std::string &name) {
    for (uint32_t format = 1; const lensprof_format_info *info = lensprof_format_get_info(format); format++)
        if (name == info->name && info->is_written) return format;
    throw std::runtime_error(name + ": is not a format that can be written");
}

}  // namespace

extern "C" {

/* Forgets the cards. */
PAGE_API void page_clear_cards() { cards.clear(); }

/* Adds a card: its width and height, px, lensprof_sample_type, exposure, EV, and rotation of the camera, degrees. */
PAGE_API const char *page_add_card(const void *rgba, uint32_t width, uint32_t height, uint32_t sample, double ev,
                                   double rotation_deg) {
    return answer([&]() -> Json {
        if (cards.size() == LENSPROF_FLAT_IMAGES)
            throw std::runtime_error("there are " + std::to_string(cards.size()) + " cards already; use fewer");
        if (!width || !height || sample > LENSPROF_SAMPLE_F32)
            throw std::runtime_error("the picture is empty; use another");
        cards.push_back(card_of(rgba, width, height, sample, ev, rotation_deg));
        return {{"cards", cards.size()}};
    });
}

/* Measures the cards, each of which may have a gradient of light of its own unless the camera was rotated.
 * {"response": "linear", "key": {...}, "lossy": false, "radial": false} -> {"usable": true, "findings": [{"kind",
 * "text"}]} */
PAGE_API const char *page_fit(const char *options) {
    return answer([&] { return fit(Json::parse(options)); });
}

/* Reads a profile file -> {"profiles": [key, ...]}. */
PAGE_API const char *page_import(const void *data, size_t size, const char *name) {
    return answer([&]() -> Json {
        if (lensprof_format_detect(data, size, name) == LENSPROF_FORMAT_AUTO)
            throw std::runtime_error(
                "is neither a picture that this page reads (JPEG, PNG, TIFF, WebP, AVIF) nor a profile");
        std::vector<lensprof_profile> read;
        lensprof_import_options options;
        lensprof_import_options_init(&options);
        options.name = name;
        lensprof_error error{};
        check(lensprof_import(data, size, &options, keep_profile, &read, &error), error);
        if (read.empty()) throw std::runtime_error("has no falloff that can be used; use another file");
        profiles = std::move(read);
        Json keys = Json::array();
        for (const lensprof_profile &profile : profiles) keys.push_back(json_of(profile.key));
        return {{"profiles", std::move(keys)}};
    });
}

/* Profile `index` for a frame of width x height px -> {"key", "doubt", "curves": [[[r, light, sigma], ...], ...]}. */
PAGE_API const char *page_profile(uint32_t index, uint32_t width, uint32_t height) {
    return answer([&]() -> Json {
        const lensprof_profile &profile = profile_at(index);
        return {{"key", json_of(profile.key)},
                {"doubt", profile.provenance.doubt},
                {"curves", curves_of(profile, width, height)}};
    });
}

/* Names camera, lens and setting of a profile. */
PAGE_API const char *page_set_key(uint32_t index, const char *key) {
    return answer([&]() -> Json {
        profiles[index].key = key_of(Json::parse(key), profile_at(index).key);
        return Json::object();
    });
}

/* Corrects 8 bit pixels in place. `response` as in page_fit is that of a picture whose profile has none ("linear"
 * falloffs of raw data). */
PAGE_API const char *page_correct(uint32_t index, void *rgba, uint32_t width, uint32_t height, const char *response,
                                  double strength) {
    return answer([&]() -> Json {
        lensprof_profile profile = profile_at(index);
        if (profile.key.processing == LENSPROF_PROCESSING_RAW) {
            profile.response[0] = response_of(response, profile.key, nullptr);
            profile.responses = 1;
        }
        lensprof_apply_options options;
        lensprof_apply_options_init(&options);
        lensprof_error error{};
        check(lensprof_apply_options_set_profile(&options, &profile), error);
        options.frame_width = width, options.frame_height = height;
        options.source_layout = LENSPROF_LAYOUT_RGBA;
        options.strength = strength;
        std::vector<uint64_t> memory(lensprof_plan_bytes(&options) / 8 + 1);
        const lensprof_plan *plan = nullptr;
        check(lensprof_plan_init(memory.data(), memory.size() * 8, &options, &plan, &error), error);
        const lensprof_target picture = {rgba,   ptrdiff_t(width) * 4, width,
                                         height, LENSPROF_SAMPLE_U8,   LENSPROF_LAYOUT_RGBA};
        check(lensprof_apply(plan, nullptr, &picture, 0, 0), error);
        return Json::object();
    });
}

/* Formats of files that are written -> [{"name", "about"}]. */
PAGE_API const char *page_formats() {
    return answer([&]() -> Json {
        Json formats = Json::array();
        for (uint32_t format = 1; const lensprof_format_info *info = lensprof_format_get_info(format); format++)
            if (info->is_written && format != LENSPROF_FORMAT_MAP && format != LENSPROF_FORMAT_DNG_OPCODES)
                formats.push_back({{"name", info->name}, {"about", info->about}});
        return formats;
    });
}

/* Writes a profile -> {"bytes": number}, at page_file until the next call. */
PAGE_API const char *page_export(uint32_t index, const char *format, uint32_t width, uint32_t height) {
    return answer([&]() -> Json {
        const lensprof_profile *const profile = &profile_at(index);
        lensprof_export_options options;
        lensprof_export_options_init(&options);
        options.format = format_named(format);
        options.width = width, options.height = height;
        size_t count = 0;
        lensprof_error error{};
        check(lensprof_export(&profile, 1, &options, nullptr, 0, &count, &error), error);
        std::vector<uint8_t> made(count);
        check(lensprof_export(&profile, 1, &options, made.data(), made.size(), &count, &error), error);
        file = std::move(made);
        return {{"bytes", count}};
    });
}

PAGE_API const void *page_file() { return file.data(); }

PAGE_API const char *page_version() { return lensprof_version(); }
}
