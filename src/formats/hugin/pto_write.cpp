// Writing a Hugin project: new values go into the lines as they are, nothing else changes.
#include <algorithm>
#include <cmath>

#include "formats/hugin/pto.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kHuginModes = 5;

// A new value for an item of an `i` line.
struct Edit {
    std::string_view name;
    std::string value;
    bool replaces_link = false;
};

// The EMoR coefficients that Hugin can hold. The modes are orthonormal on the grid, so that the least squares
// projection of the curve on the first five is a dot product with each.
std::array<double, kHuginModes> hugin_modes(const lensprof_response &response) {
    std::array<double, kHuginModes> coefficients;
    bool exact = response.kind == LENSPROF_RESPONSE_EMOR && response.modes <= kHuginModes;
    const double *mean = lensprof_emor_table(0);
    for (uint32_t l = 0; l < kHuginModes; l++) {
        const double *mode = lensprof_emor_table(l + 1);
        double sum = 0;
        for (size_t j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) sum += (response.table[j] - mean[j]) * mode[j];
        coefficients[l] = exact ? response.emor[l] : sum;
    }
    return coefficients;
}

// New text of an `i` line. A link stays a link: the image it leads to receives the value. A missing item is added.
std::string edit_line(std::string_view line, size_t number, const std::vector<Edit> &edits) {
    const std::vector<PtoToken> tokens = split_pto_line(line, number);
    std::vector<std::pair<const PtoToken *, const Edit *>> changes;
    std::string added;
    for (const Edit &edit : edits) {
        const PtoToken *token = find_pto_token(tokens, edit.name);
        if (!token)
            added += " " + std::string(edit.name) + edit.value;
        else if (edit.replaces_link || token->value.empty() || token->value[0] != '=')
            changes.push_back({token, &edit});
    }
    std::sort(changes.begin(), changes.end(),
              [](const auto &a, const auto &b) { return a.first->begin < b.first->begin; });
    std::string text;
    size_t done = 0;
    for (const auto &[token, edit] : changes) {
        text.append(line.substr(done, token->begin - done)).append(edit->value);
        done = token->begin + token->value.size();
    }
    return text.append(line.substr(done)).append(added);
}

// Exposure and white balance of an image in Hugin's terms: relative to the reference, whose own values stay.
std::vector<Edit> exposure_edits(const lensprof_exposure &exposure, const lensprof_exposure &reference,
                                 const PtoImage &written) {
    const auto &value = written.value;
    auto balance = [&](size_t c) {
        return (exposure.white_balance[c] / exposure.white_balance[1])
               / (reference.white_balance[c] / reference.white_balance[1]);
    };
    return {{"Eev", number_text(value[kExposureValue] - (exposure.ev - reference.ev))},
            {"Er", number_text(value[kRed] * balance(0))},
            {"Eb", number_text(value[kBlue] * balance(2))}};
}

// Vm5: radial falloff, corrected by division.
std::vector<Edit> falloff_edits(const lensprof_vignetting &vignetting, const PtoImage &image) {
    const PtoFalloffFrame frame = falloff_frame(image.result);
    std::vector<Edit> edits{{"Va", "1"}};
    double scale = 1.0;
    for (size_t i = 0; i < 3; i++) {
        scale *= frame.scale * frame.scale;
        edits.push_back({kPtoParameterInfo[kVignettingB + i].name, number_text(vignetting.k[i] / scale)});
    }
    for (size_t i = 0; i < 2; i++)
        edits.push_back({kPtoParameterInfo[kCenterX + i].name,
                         number_text(vignetting.center[i] * frame.half_diagonal + frame.offset[i])});
    return edits;
}

std::vector<Edit> response_edits(const std::array<double, kHuginModes> &modes) {
    std::vector<Edit> edits;
    for (size_t i = 0; i < kHuginModes; i++)
        edits.push_back({kPtoParameterInfo[kResponseA + i].name, number_text(modes[i])});
    return edits;
}

// Rt0: EMoR, which is also what a line without Rt means.
std::vector<Edit> model_edits(const std::array<double, kHuginModes> &modes, const lensprof_vignetting &vignetting,
                              const PtoImage &image) {
    std::vector<Edit> edits = response_edits(modes);
    for (const Edit &edit : falloff_edits(vignetting, image)) edits.push_back(edit);
    edits.push_back({"Vm", "5"});
    if (image.result.response_type != 0) edits.push_back({"Rt", "0"});
    return edits;
}

// The `i` line as it is now.
std::string_view line_of(const lensprof_pto &pto, const PtoImage &image) {
    return image.renamed.empty() ? std::string_view(pto.text).substr(image.begin, image.length)
                                 : std::string_view(image.renamed);
}

// The text with every `i` line replaced by line_text(i).
template <class LineText>
std::string replace_lines(const lensprof_pto &pto, const LineText &line_text) {
    std::string text;
    std::string_view old = pto.text;
    size_t done = 0;
    for (uint32_t i = 0; i < pto.images.size(); i++) {
        const PtoImage &image = pto.images[i];
        text.append(old.substr(done, image.begin - done)).append(line_text(i));
        done = image.begin + image.length;
    }
    return text.append(old.substr(done));
}

// The text with edited `i` lines.
template <class EditsOf>
std::string edit_lines(const lensprof_pto &pto, const EditsOf &edits_of) {
    return replace_lines(
        pto, [&](uint32_t i) { return edit_line(line_of(pto, pto.images[i]), pto.images[i].line, edits_of(i)); });
}

// The text where the first image of every group has the values of edits_of(image), and the others are linked to it.
template <class EditsOf>
std::string link_groups(const lensprof_pto &pto, const uint32_t *group, const EditsOf &edits_of) {
    return edit_lines(pto, [&](uint32_t i) {
        const auto first = static_cast<uint32_t>(std::find(group, group + i, group[i]) - group);
        std::vector<Edit> edits = edits_of(i);
        for (Edit &edit : edits) {
            if (first < i) edit.value = '=' + std::to_string(first);
            edit.replaces_link = true;
        }
        return edits;
    });
}

// A name that can stand between the quotes of a line.
bool is_name(std::string_view name) {
    return !name.empty() && std::none_of(name.begin(), name.end(), [](char c) {
        return c == '"' || static_cast<unsigned char>(c) < 0x20;
    });
}

bool is_left_out(const lensprof_exposure &exposure) { return std::isnan(exposure.ev); }

constexpr PtoParameter kExposureParameters[] = {kExposureValue, kRed, kBlue};  // in the order of exposure_edits

// The image whose result is written into image i: itself, or where that was left out one that is linked to it.
uint32_t source_of(const lensprof_pto &pto, const lensprof_exposure *exposures, uint32_t i, PtoParameter parameter) {
    for (uint32_t j = 0; j < pto.images.size() && is_left_out(exposures[i]); j++)
        if (pto.images[j].root[parameter] == i && !is_left_out(exposures[j])) return j;
    return i;
}

// The text without its marks of images that were left out, and with one of those that are now.
std::string mark_left_out(std::string_view text, const lensprof_exposure *exposures, uint32_t image_count) {
    std::string marked;
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        if (!is_left_out_mark(text.substr(0, end))) marked += text.substr(0, end);
        text.remove_prefix(end);
    }
    std::string numbers;
    for (uint32_t i = 0; i < image_count; i++)
        if (is_left_out(exposures[i])) numbers += ' ' + std::to_string(i);
    if (numbers.empty()) return marked;
    if (!marked.empty() && marked.back() != '\n') marked += '\n';
    return marked + std::string(kLeftOutMark) + numbers + '\n';
}

void check_result(const lensprof_response &response, const lensprof_vignetting &vignetting,
                  const lensprof_exposure *exposures, uint32_t image_count) {
    const auto demand = [](lensprof_status status, const std::string &text) {
        if (status != LENSPROF_OK) throw FormatFailure{status, text};
    };
    demand(lensprof_response_validate(&response), "the response is invalid; see lensprof_response_validate");
    demand(lensprof_vignetting_validate(&vignetting), "the vignetting is invalid; see lensprof_vignetting_validate");
    for (uint32_t i = 0; i < image_count; i++)
        demand(is_left_out(exposures[i]) ? LENSPROF_OK : lensprof_exposure_validate(&exposures[i]),
               "image " + std::to_string(i) + ": its exposure is invalid; see lensprof_exposure_validate");
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lensprof_pto_set_result(lensprof_pto *pto, const lensprof_response *response,
                                        const lensprof_vignetting *vignetting, const lensprof_exposure *exposures,
                                        uint32_t image_count, uint32_t reference, lensprof_error *error) {
    if (pto && exposures && image_count == pto->images.size() && reference < image_count
        && is_left_out(exposures[reference])) {
        set_error(error,
                  "lensprof_pto_set_result: the reference was left out of the fit; give the reference of its result");
        return LENSPROF_ERROR_ARGUMENT;
    }
    if (!pto || !response || !vignetting || !exposures || image_count != pto->images.size()
        || reference >= image_count) {
        set_error(error,
                  "lensprof_pto_set_result: give a project, curves, an exposure per image, and one of the images "
                  "as the reference");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        check_result(*response, *vignetting, exposures, image_count);
        const std::array<double, kHuginModes> modes = hugin_modes(*response);
        const std::string text = edit_lines(*pto, [&](uint32_t i) {
            std::vector<Edit> edits = model_edits(modes, *vignetting, pto->images[i]);
            for (size_t n = 0; n < 3; n++) {
                const uint32_t from = source_of(*pto, exposures, i, kExposureParameters[n]);
                if (!is_left_out(exposures[from]))
                    edits.push_back(exposure_edits(exposures[from], exposures[reference], pto->images[reference])[n]);
            }
            return edits;
        });
        // Parsed again, so that reading and writing cannot disagree.
        *pto = parse_pto(mark_left_out(text, exposures, image_count));
    });
}

lensprof_status lensprof_pto_set_settings(lensprof_pto *pto, const uint32_t *setting, uint32_t image_count,
                                          const lensprof_vignetting *vignetting, uint32_t setting_count,
                                          lensprof_error *error) {
    if (!pto || !setting || !vignetting || image_count != pto->images.size()
        || std::any_of(setting, setting + image_count, [&](uint32_t s) { return s >= setting_count; })) {
        set_error(error,
                  "lensprof_pto_set_settings: give a project, a setting per image, and a vignetting per "
                  "setting");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        for (uint32_t s = 0; s < setting_count; s++)
            if (const auto status = lensprof_vignetting_validate(&vignetting[s]); status != LENSPROF_OK)
                throw FormatFailure{
                    status, "vignetting " + std::to_string(s) + " is invalid; see lensprof_vignetting_validate"};
        *pto = parse_pto(link_groups(
            *pto, setting, [&](uint32_t i) { return falloff_edits(vignetting[setting[i]], pto->images[i]); }));
    });
}

lensprof_status lensprof_pto_set_cameras(lensprof_pto *pto, const uint32_t *camera, uint32_t image_count,
                                         const lensprof_response *response, uint32_t camera_count,
                                         lensprof_error *error) {
    if (!pto || !camera || !response || image_count != pto->images.size()
        || std::any_of(camera, camera + image_count, [&](uint32_t k) { return k >= camera_count; })) {
        set_error(error, "lensprof_pto_set_cameras: give a project, a camera per image, and a response per camera");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        std::vector<std::array<double, kHuginModes>> modes;
        for (uint32_t k = 0; k < camera_count; k++) {
            if (const auto status = lensprof_response_validate(&response[k]); status != LENSPROF_OK)
                throw FormatFailure{status,
                                    "response " + std::to_string(k) + " is invalid; see lensprof_response_validate"};
            modes.push_back(hugin_modes(response[k]));
        }
        *pto = parse_pto(link_groups(*pto, camera, [&](uint32_t i) { return response_edits(modes[camera[i]]); }));
    });
}

lensprof_status lensprof_pto_set_name(lensprof_pto *pto, uint32_t index, const char *name, lensprof_error *error) {
    if (!name || !has_image(pto, index)) return fail_at_image(pto, index, "name", error);
    if (!is_name(name)) {
        set_error(error, "the name of an image is empty, or has quotes or control characters; give another one");
        return LENSPROF_ERROR_ARGUMENT;
    }
    // Only this line is made and read again: a project may have thousands, all of which get a new name.
    return at_boundary(error, [&] {
        PtoImage &image = pto->images[index];
        std::string line = edit_line(line_of(*pto, image), image.line, {{"n", '"' + std::string(name) + '"'}});
        std::string written(find_pto_text(split_pto_line(line, image.line), "n"));
        image.renamed = std::move(line);
        image.name = std::move(written);
    });
}

lensprof_status lensprof_pto_write(const lensprof_pto *pto, void *data, size_t capacity, size_t *count,
                                   lensprof_error *error) {
    if (!pto || (!data && capacity)) {
        set_error(error, "lensprof_pto_write: pto or data is NULL; pass a project and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] {
        return replace_lines(*pto, [&](uint32_t i) { return line_of(*pto, pto->images[i]); });
    });
}
