#include "photo/cards/card_advice.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <regex>

#include "fit/base/quantile.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/cards/count_samples.hpp"

namespace lensprof {
namespace {

Finding *finding_of(CardFit &found, uint32_t code, uint32_t least_severity) {
    const auto is_it = [=](const Finding &f) { return f.code == code && f.severity >= least_severity; };
    const auto at = std::find_if(found.verdict.findings.begin(), found.verdict.findings.end(), is_it);
    return at == found.verdict.findings.end() ? nullptr : &*at;
}

// The pictures that do not show an even light, unlike others, and that the model describes clearly worse than those. Of
// two shots, it describes neither well.
std::vector<std::string> foreign_pictures(const CardFit &found) {
    constexpr double clearly = 2.0;
    std::vector<double> residuals;
    for (const lensprof_flat_image_quality &quality : found.quality) residuals.push_back(quality.residual);
    const double least = found.fit.shots > 2 ? clearly * upper_median(residuals) : 0.0;
    std::vector<std::string> foreign;
    for (size_t i = 0; i < found.files.size(); i++)
        if (!found.shows_even_light[i] && residuals[i] > least) foreign.push_back(found.files[i]);
    return found.shows_any_even_light() ? foreign : std::vector<std::string>();
}

// A scene among cards leaves texture, or cells that disagree: the refusal names it.
void name_foreign_pictures(CardFit &found) {
    if (found.fit.usable || found.fit.shots < 2) return;
    if (const std::vector<std::string> files = foreign_pictures(found); !files.empty())
        found.verdict.findings.front().text += "; not of an even light: " + joined(files, ", ") + "; leave it out";
}

// One shot, or several at one angle, do not separate the light from the centre: the option that states the light.
void name_light_option(CardFit &found) {
    const bool is_even = found.fit.light == LENSPROF_FLAT_LIGHT_EVEN;
    const std::string other = option_name("light") + (is_even ? " plane" : " even");
    if (Finding *note = finding_of(found, LENSPROF_REASON_FLAT_CENTER_BY_PRIOR, 0); note && found.fit.light_ev > 0.0)
        note->text += " (" + other + ")";
    if (Finding *steep = finding_of(found, LENSPROF_REASON_FLAT_STEEP, 0); steep && !is_even && !found.fit.separated)
        steep->text += "; or state an even light, if it is one, with " + other;
}

// Shots of one light, at one angle as far as anybody stated, that differ.
void name_rotation_options(const CardOptions &o, CardFit &found) {
    if (o.own_light || o.turned || o.several || !o.rotation_deg.empty() || found.fit.shots < 2) return;
    for (const uint32_t code : {LENSPROF_REASON_FLAT_SHOTS_DIFFER, LENSPROF_REASON_FEW_AGREE})
        if (Finding *refusal = finding_of(found, code, LENSPROF_SEVERITY_REFUSAL))
            refusal->text += "; if the camera was rotated between the shots, state it with " + option_name("rotation")
                             + " or " + option_name("turned") + "; if each shot has its own light, use "
                             + option_name("own_light");
}

// EXIF of lenses without contacts, and names, may state what the lens was not set to.
void name_other_settings(CardFit &found) {
    if (Finding *refusal = finding_of(found, LENSPROF_REASON_FLAT_SHOTS_DIFFER, LENSPROF_SEVERITY_REFUSAL))
        refusal->text += "; another aperture or focal length than stated shows as such a difference, too";
}

// Of linear float samples, what exceeds 1 need not be saturated, unless somebody stated it.
bool may_lack_white_level(const CardOptions &o, const CardInput &input) {
    return !o.levels.white && std::any_of(input.pictures.begin(), input.pictures.end(), [](const Picture &picture) {
        return picture.sample == LENSPROF_SAMPLE_F32 && bright_sample(picture) > 1.0;
    });
}

std::string white_level_advice() {
    return "; float samples above 1 count as white: if they are not saturated, state the sample at saturation with "
           + option_name("white_level");
}

double middle_sample(const Picture &picture) {
    std::vector<double> samples;
    const uint32_t per_row = picture.width * lensprof_layout_samples(picture.layout);
    for (uint32_t y = 0; y < picture.height; y += 4)
        for (uint32_t n = 0; n < per_row; n += 4)
            samples.push_back(sample_value(picture.sample, picture.pixels.data() + y * picture.row_bytes, n));
    return median(samples);
}

std::string dark_frame_advice(const std::string &file) {
    return "; if the lens was covered for " + file + ", give it with " + option_name("dark")
           + ", which takes it out of the cards";
}

// The first picture with the name of a dark frame and less than a quarter of the light of the others; empty: none.
std::string dark_frame_among(const CardInput &input) {
    constexpr double far_darker = 0.25;
    if (std::none_of(input.files.begin(), input.files.end(), has_dark_name)) return {};
    std::vector<double> samples;
    for (const Picture &picture : input.pictures) samples.push_back(middle_sample(picture));
    const double brightest = *std::max_element(samples.begin(), samples.end());
    for (size_t i = 0; i < samples.size(); i++)
        if (has_dark_name(input.files[i]) && (samples.size() == 1 || samples[i] < far_darker * brightest))
            return input.files[i];
    return {};
}

// The level of a picture if it is one of a dark frame; unknown if it is bright or uneven.
std::optional<double> dark_level_of(const std::string &file, uint32_t max_side) {
    NoticeList events;
    try {
        return dark_level({file}, max_side, 0, events).brightest;
    } catch (const Failure &failure) {
        if (!is_of_input(failure)) throw;
        return std::nullopt;
    }
}

}  // namespace

void refuse_dark_cards(const std::vector<std::string> &files, const CardOptions &o, const DarkLevel &dark) {
    constexpr double spreads = 4.0, drift = 0.1, least = 0.0005;  // of the blocks; shares of the level; of full scale
    const bool are_codes = dark.form.sample != LENSPROF_SAMPLE_F32;
    const double highest =
        dark.brightest + std::max({spreads * dark.spread, drift * std::fabs(dark.brightest), are_codes ? least : 0.0});
    const auto folder_of = [](const std::string &file) { return std::filesystem::path(file).parent_path(); };
    for (const std::string &file : files) {
        const auto is_near = [&](const std::string &other) { return folder_of(other) == folder_of(file); };
        const auto is_it = [&](const std::string &other) { return is_same_file(other, file); };
        if (is_folder(file) || std::none_of(o.dark_files.begin(), o.dark_files.end(), is_near)
            || std::any_of(o.dark_files.begin(), o.dark_files.end(), is_it))
            continue;
        const auto level = dark_level_of(file, o.max_side);
        const bool is_alike = level && (are_codes || (*level > 1.0) == (dark.brightest > 1.0));  // counts, or shares
        if (is_alike && *level <= highest)
            throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is as dark as " + dark.file
                                                       + ", but is given as a card; repeat " + option_name("dark")
                                                       + " for each file");
    }
}

bool has_dark_name(const std::string &file) {
    static const std::regex words(R"((?:.*[^a-z])?(?:darks?|darkframe|bias|cap|capped|lenscap|covered)(?:[^a-z].*)?)",
                                  std::regex::icase);
    return std::regex_match(std::filesystem::path(file).stem().string(), words);
}

void add_advice(const CardOptions &o, const CardInput &input, CardFit &found, Events &events) {
    name_foreign_pictures(found);
    name_light_option(found);
    name_other_settings(found);
    name_rotation_options(o, found);
    if (Finding *white = finding_of(found, LENSPROF_REASON_FLAT_WHITE, 0); white && may_lack_white_level(o, input))
        white->text += white_level_advice();
    const std::string dark = dark_frame_among(input);
    if (dark.empty()) return;
    if (!found.fit.usable)
        found.verdict.findings.front().text += dark_frame_advice(dark);
    else if (input.files.size() > 1)
        events.warn(dark, "is far darker than the other pictures" + dark_frame_advice(dark));
}

std::string advice_without_fit(const CardOptions &o, const CardInput &input) {
    const std::string dark = dark_frame_among(input);
    return (may_lack_white_level(o, input) ? white_level_advice() : "") + (dark.empty() ? "" : dark_frame_advice(dark));
}

}  // namespace lensprof
