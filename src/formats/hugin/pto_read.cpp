// Reading a Hugin project: images (`i`), variables (`v`) and masks (`k`). Other lines are kept and not looked at.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/sized.h"
#include "formats/hugin/pto.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr size_t kMaxBytes = size_t{64} << 20;
constexpr size_t kMaxImages = 100000;
constexpr double kMaxSide = 1 << 20;
constexpr double kMaxPlace = 1 << 24;  // of crops and masks, px either way
constexpr uint32_t kVignettingRadial = 1;
constexpr size_t kFirstPtoImage = LP_END_OF(lensprof_pto_image, crop_circular);

// ---- i lines -------------------------------------------------------------------------------------------------

// Value of a token that must be a whole number; `fallback` when the line has no such token.
uint32_t whole_item(const std::vector<PtoToken> &tokens, std::string_view name, double low, double high,
                    double fallback, size_t line) {
    const PtoToken *token = find_pto_token(tokens, name);
    double value = fallback;
    bool good = token ? read_whole(token->value, low, high, value) : value >= low;
    if (!good)
        fail_at_line(line, std::string(name) + (token ? " is " + in_quotes(token->value) : " is missing")
                               + "; write an integer from " + std::to_string(std::lround(low)) + " to "
                               + std::to_string(std::lround(high)));
    return static_cast<uint32_t>(value);
}

void read_parameter(const PtoToken &token, size_t parameter, const std::vector<PtoImage> &before, PtoImage &image) {
    if (token.value.empty() || token.value[0] != '=') {
        if (!read_number(token.value, image.value[parameter]))
            fail_at_line(image.line, std::string(token.name) + " is " + in_quotes(token.value)
                                         + ", not a finite number; write " + std::string(token.name) + " and a number");
        return;
    }
    double target;
    if (!read_whole(token.value.substr(1), 0, static_cast<double>(before.size()) - 1, target))
        fail_at_line(image.line, std::string(token.name) + std::string(token.value.substr(0, 20)) + " in image " +
                                     std::to_string(before.size()) + " is not a link to an earlier image; write a number "
                                     "or = with a smaller image number");
    const PtoImage &linked = before[static_cast<size_t>(target)];
    image.value[parameter] = linked.value[parameter];
    image.root[parameter] = linked.root[parameter];
}

// left,right,top,bottom; an empty rectangle means no crop.
void read_crop(const std::vector<PtoToken> &tokens, size_t line, lensprof_pto_image &result) {
    const lensprof_camera &camera = result.camera;
    int32_t width = static_cast<int32_t>(camera.width), height = static_cast<int32_t>(camera.height);
    const int32_t frame[4] = {0, 0, width, height};
    std::copy(frame, frame + 4, result.crop);
    const PtoToken *token = find_pto_token(tokens, "S");
    if (!token) token = find_pto_token(tokens, "C");
    if (!token) return;
    double side[4];
    std::string_view rest = token->value;
    for (int i = 0; i < 4; i++) {
        size_t comma = i < 3 ? rest.find(',') : rest.size();
        if (comma == std::string_view::npos || !read_number(rest.substr(0, comma), side[i])
            || std::abs(side[i]) > kMaxPlace)
            fail_at_line(line, "crop " + std::string(token->name) + " is " + in_quotes(token->value)
                                   + "; write left,right,top,bottom in pixels");
        rest.remove_prefix(i < 3 ? comma + 1 : comma);
    }
    const int order[4] = {0, 2, 1, 3};
    int32_t crop[4];
    for (int i = 0; i < 4; i++) crop[i] = static_cast<int32_t>(std::lround(side[order[i]]));
    if (crop[0] >= crop[2] || crop[1] >= crop[3] || std::equal(crop, crop + 4, frame)) return;
    std::copy(crop, crop + 4, result.crop);
    result.crop_circular = camera.projection == LENSPROF_PROJECTION_CIRCULAR_FISHEYE
                           || camera.projection == LENSPROF_PROJECTION_ORTHOGRAPHIC
                           || camera.projection == LENSPROF_PROJECTION_THOBY;
}

void fill_camera(const PtoImage &image, lensprof_camera &camera) {
    const auto &value = image.value;
    camera.hfov_deg = value[kHfov];
    camera.yaw_deg = value[kYaw];
    camera.pitch_deg = value[kPitch];
    camera.roll_deg = value[kRoll];
    for (size_t i = 0; i < 3; i++) {
        camera.radial[i] = value[kRadialA + i];
        camera.translation[i] = value[kTranslationX + i];
    }
    for (size_t i = 0; i < 2; i++) {
        camera.shift_px[i] = value[kShiftD + i];
        camera.shear_px[i] = value[kShearG + i];
        camera.plane_deg[i] = value[kPlaneYaw + i];
    }
    lensprof_camera probe = {};  // what is known to be possible, but for the lens type
    probe.projection = camera.projection;
    probe.width = probe.height = 1;
    probe.hfov_deg = 50;
    if (lensprof_camera_validate(&probe) != LENSPROF_OK)
        fail_at_line(image.line,
                     "lens type f" + std::to_string(camera.projection)
                         + " is not supported; use f0, f1, f2, f3, f4, f8, f10, f20 or f21",
                     LENSPROF_ERROR_UNSUPPORTED);
    if (lensprof_camera_validate(&camera) != LENSPROF_OK)
        fail_at_line(image.line, "field of view v" + number_text(camera.hfov_deg)
                                     + ", with this distortion and position, is not possible for lens type f"
                                     + std::to_string(camera.projection) + "; correct v, a b c, g t or Tr*");
}

// Root of a group that Hugin links as one; the image itself when its members are linked to different images.
uint32_t group_root(const PtoImage &image, size_t first, size_t last, uint32_t self) {
    for (size_t i = first; i <= last; i++)
        if (image.root[i] != image.root[first]) return self;
    return image.root[first];
}

void fill_photometry(PtoImage &image, uint32_t self) {
    const auto &value = image.value;
    lensprof_pto_image &result = image.result;
    if (!(value[kRed] > 0) || !(value[kBlue] > 0))
        fail_at_line(image.line, "Er or Eb is not positive; write white balance factors greater than 0");
    result.exposure.ev = value[kExposureValue] == 0 ? 0 : -value[kExposureValue];
    result.exposure.white_balance[0] = value[kRed];
    result.exposure.white_balance[1] = 1;
    result.exposure.white_balance[2] = value[kBlue];
    for (size_t i = 0; i < 5; i++) result.emor[i] = value[kResponseA + i];
    if (image.vignetting_mode & kVignettingRadial) {
        double rho = lensprof_half_diagonal(result.camera.width, result.camera.height);
        if (!(value[kVignettingA] > 0))
            fail_at_line(image.line, "Va is not positive; write Va1 and divide Vb, Vc and Vd by the old value");
        for (size_t i = 0; i < 3; i++) result.vignetting.k[i] = value[kVignettingB + i] / value[kVignettingA];
        for (size_t i = 0; i < 2; i++) result.vignetting.center[i] = value[kCenterX + i] / rho;
    }
    result.response_of = group_root(image, kResponseA, kResponseE, self);
    result.vignetting_of = group_root(image, kVignettingB, kVignettingD, self);
    result.center_of = group_root(image, kCenterX, kCenterY, self);
    result.ev_of = image.root[kExposureValue];
    result.red_of = image.root[kRed];
    result.blue_of = image.root[kBlue];
}

PtoImage read_image(const LineReader &reader, const std::vector<PtoImage> &before) {
    if (before.size() == kMaxImages)
        fail_at_line(reader.number, "more than 100000 images; split the project", LENSPROF_ERROR_UNSUPPORTED);
    PtoImage image = {};
    lensprof_pto_image_init(&image.result);
    image.line = reader.number;
    image.begin = reader.begin;
    image.length = reader.line.size();
    uint32_t self = static_cast<uint32_t>(before.size());
    image.root.fill(self);
    for (size_t i = 0; i < kPtoParameters; i++) image.value[i] = kPtoParameterInfo[i].fallback;
    const std::vector<PtoToken> tokens = split_pto_line(reader.line, reader.number);
    std::bitset<kPtoParameters> seen;
    for (const PtoToken &token : tokens) {
        size_t parameter = find_pto_parameter(token.name);
        if (parameter == kPtoParameters || seen[parameter]) continue;
        seen.set(parameter);
        read_parameter(token, parameter, before, image);
    }
    lensprof_pto_image &result = image.result;
    result.camera.width = whole_item(tokens, "w", 1, kMaxSide, 0, image.line);
    result.camera.height = whole_item(tokens, "h", 1, kMaxSide, 0, image.line);
    result.camera.projection = whole_item(tokens, "f", 0, 1000, 0, image.line);
    result.response_type = whole_item(tokens, "Rt", 0, 4, 0, image.line);
    image.vignetting_mode = whole_item(tokens, "Vm", 0, 255, 0, image.line);
    if (result.response_type > 1)
        fail_at_line(image.line,
                     "response type Rt" + std::to_string(result.response_type)
                         + " is not supported; use Rt0 (EMoR) or Rt1 (linear)",
                     LENSPROF_ERROR_UNSUPPORTED);
    image.name = find_pto_text(tokens, "n");
    fill_camera(image, result.camera);
    fill_photometry(image, self);
    read_crop(tokens, image.line, result);
    return image;
}

// ---- images that are crops of their file -------------------------------------------------------------------------

bool has_crop(const lensprof_pto_image &image) {
    const int32_t frame[4] = {0, 0, static_cast<int32_t>(image.camera.width),
                              static_cast<int32_t>(image.camera.height)};
    return !std::equal(frame, frame + 4, image.crop);
}

// Whether the circle of a fisheye is far from the middle of its file, where a lens's centre is not.
bool is_off_middle(const lensprof_pto_image &image) {
    constexpr double kFar = 0.2;  // half diagonals of the picture
    if (!image.crop_circular) return false;
    const double x = 0.5 * (image.crop[0] + image.crop[2]) - 0.5 * image.camera.width,
                 y = 0.5 * (image.crop[1] + image.crop[3]) - 0.5 * image.camera.height;
    return std::hypot(x, y) > kFar * lensprof_half_diagonal(image.camera.width, image.camera.height);
}

// From Hugin's terms to those of the crop. Without a falloff, the centre that the line has is that of nothing.
void move_falloff(lensprof_pto_image &image) {
    lensprof_vignetting &v = image.vignetting;
    const PtoFalloffFrame frame = falloff_frame(image);
    const bool has_falloff = std::any_of(v.k, v.k + 3, [](double k) { return k != 0.0; });
    double scale = 1.0;
    for (double &k : v.k) scale *= frame.scale * frame.scale, k *= scale;
    const double rho = frame.half_diagonal / frame.scale;
    for (size_t i = 0; i < 2; i++)
        v.center[i] = has_falloff ? (v.center[i] * rho - frame.offset[i]) / frame.half_diagonal : 0.0;
}

void find_crops(lensprof_pto &pto) {
    std::map<std::string_view, std::set<std::array<int32_t, 4>>> crops;
    const auto crop_of = [](const PtoImage &image) {
        std::array<int32_t, 4> crop;
        std::copy_n(image.result.crop, 4, crop.begin());
        return crop;
    };
    for (const PtoImage &image : pto.images) crops[image.name].insert(crop_of(image));
    for (PtoImage &image : pto.images) {
        lensprof_pto_image &result = image.result;
        result.of_crop = has_crop(result) && (crops[image.name].size() > 1 || is_off_middle(result));
        if (result.of_crop) move_falloff(result);
    }
}

// ---- v and k lines: they may come before the images they name ---------------------------------------------------

struct Line {
    std::string_view text;
    size_t number;
};

std::string image_range(const lensprof_pto &pto) { return "images 0 to " + std::to_string(pto.images.size() - 1); }

void read_variables(const Line &line, lensprof_pto &pto) {
    for (const PtoToken &token : split_pto_line(line.text, line.number)) {
        size_t parameter = find_pto_parameter(token.name);
        std::string word = in_quotes(std::string(token.name) + std::string(token.value));
        if (parameter == kPtoParameters || parameter == kStack) {
            std::string names;
            for (size_t i = 0; i < kStack; i++) names += " " + std::string(kPtoParameterInfo[i].name);
            fail_at_line(line.number, "variable " + word + " is unknown; use one of" + names + " and an image number",
                         LENSPROF_ERROR_VARIABLE);
        }
        double number;
        if (!read_whole(token.value, 0, static_cast<double>(pto.images.size()) - 1, number))
            fail_at_line(line.number,
                         "variable " + word + " refers to no image of the project; write " + std::string(token.name)
                             + " with a number, " + image_range(pto) + " exist",
                         LENSPROF_ERROR_VARIABLE);
        const PtoImage &image = pto.images[static_cast<size_t>(number)];
        pto.images[image.root[parameter]].is_variable.set(parameter);
    }
}

void share_variables(lensprof_pto &pto) {
    for (PtoImage &image : pto.images) {
        for (size_t i = 0; i < kPtoParameters; i++)
            if (pto.images[image.root[i]].is_variable[i]) image.result.free |= kPtoParameterInfo[i].free;
    }
}

PtoMask read_mask(const Line &line, const lensprof_pto &pto) {
    const std::vector<PtoToken> tokens = split_pto_line(line.text, line.number);
    double last_image = static_cast<double>(pto.images.size()) - 1;
    PtoMask mask;
    mask.line = line.number;
    mask.image = whole_item(tokens, "i", 0, last_image, -1, line.number);
    mask.type = whole_item(tokens, "t", 0, kMaskTypes - 1, 0, line.number);
    std::string_view rest = find_pto_text(tokens, "p");
    for (;;) {
        std::array<double, 2> corner;
        std::string_view x = next_word(rest), y = next_word(rest);
        if (x.empty()) break;
        if (!read_number(x, corner[0]) || !read_number(y, corner[1]) || std::abs(corner[0]) > kMaxPlace
            || std::abs(corner[1]) > kMaxPlace)
            fail_at_line(line.number, "mask corner " + std::to_string(mask.corners.size()) + " is "
                                          + in_quotes(std::string(x) + " " + std::string(y))
                                          + "; write p\"x y x y ...\" in pixels");
        mask.corners.push_back(corner);
    }
    return mask;
}

}  // namespace

PtoFalloffFrame falloff_frame(const lensprof_pto_image &image) {
    const lensprof_camera &camera = image.camera;
    const double whole = lensprof_half_diagonal(camera.width, camera.height);
    if (!image.of_crop) return {whole, 1.0, {0.0, 0.0}};
    const int32_t *crop = image.crop;
    const double half = 0.5 * std::hypot(crop[2] - crop[0], crop[3] - crop[1]);
    return {half,
            half / whole,
            {0.5 * (crop[0] + crop[2]) - 0.5 * camera.width, 0.5 * (crop[1] + crop[3]) - 0.5 * camera.height}};
}

bool is_left_out_mark(std::string_view line) {
    const size_t end = kLeftOutMark.size();
    const bool ends = line.size() == end || (line.size() > end && (is_blank(line[end]) || line[end] == '\n'));
    return ends && line.substr(0, end) == kLeftOutMark;
}

namespace {

// Numbers without an image are ignored, like the whole comment.
void read_left_out(std::string_view line, lensprof_pto &pto) {
    std::string_view rest = line.substr(kLeftOutMark.size());
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
        double number;
        if (read_whole(word, 0, static_cast<double>(pto.images.size()) - 1, number))
            pto.images[static_cast<size_t>(number)].result.left_out = 1;
    }
}

// 'i' for "i w100 ...", '#' or 0 for lines that are only kept.
char record_of(std::string_view line) {
    if (line.empty() || (line.size() > 1 && !is_blank(line[1]))) return 0;
    return line[0];
}

}  // namespace

lensprof_pto parse_pto(std::string text) {
    lensprof_pto pto;
    pto.text = std::move(text);
    std::vector<Line> variables, masks, left_out;
    LineReader reader(pto.text);
    while (reader.next()) {
        if (reader.line.find('\0') != std::string_view::npos)
            fail_at_line(reader.number, "zero byte in the text; this is not a Hugin project");
        char record = record_of(reader.line);
        if (record == 'i') pto.images.push_back(read_image(reader, pto.images));
        if (record == 'v') variables.push_back({reader.line, reader.number});
        if (record == 'k') masks.push_back({reader.line, reader.number});
        if (is_left_out_mark(reader.line)) left_out.push_back({reader.line, reader.number});
    }
    if (pto.images.empty()) fail_at_line(reader.number + 1, "end of text without an image; a project has `i` lines");
    for (const Line &line : variables) read_variables(line, pto);
    share_variables(pto);
    find_crops(pto);
    for (const Line &line : left_out) read_left_out(line.text, pto);
    for (const Line &line : masks) pto.masks.push_back(read_mask(line, pto));
    return pto;
}

}  // namespace lensprof

using namespace lensprof;

lensprof_status lensprof_pto_read(const void *data, size_t size, lensprof_pto **pto, lensprof_error *error) {
    if (!data || !pto) {
        set_error(error, "lensprof_pto_read: data or pto is NULL; pass a project and the address of a handle");
        return LENSPROF_ERROR_ARGUMENT;
    }
    if (size > kMaxBytes) {
        set_error(error, "the project is larger than 64 MiB; check that it is a Hugin project");
        return LENSPROF_ERROR_SIZE;
    }
    return at_boundary(error, [&] { *pto = new lensprof_pto(parse_pto(std::string(view_of(data, size)))); });
}

void lensprof_pto_destroy(lensprof_pto *pto) { delete pto; }

uint32_t lensprof_pto_image_count(const lensprof_pto *pto) {
    return pto ? static_cast<uint32_t>(pto->images.size()) : 0;
}

namespace lensprof {

lensprof_status fail_at_image(const lensprof_pto *pto, uint32_t index, const char *message, lensprof_error *error) {
    char text[sizeof error->text];
    if (has_image(pto, index) || !pto)
        std::snprintf(text, sizeof text, "pto or %s is NULL; pass both", message);
    else
        std::snprintf(text, sizeof text, "image %u: the project has %zu images; count from 0", index,
                      pto->images.size());
    set_error(error, text);
    return LENSPROF_ERROR_ARGUMENT;
}

}  // namespace lensprof

lensprof_status lensprof_pto_get_image(const lensprof_pto *pto, uint32_t index, lensprof_pto_image *image,
                                       lensprof_error *error) {
    if (!image || !has_image(pto, index)) return fail_at_image(pto, index, "image", error);
    if (const char *wrong = lp_sized_wrong(image, kFirstPtoImage, sizeof *image)) {
        set_error(error, wrong);
        return LENSPROF_ERROR_STRUCT_SIZE;
    }
    set_error(error, "");
    lp_sized_copy(image, &pto->images[index].result);
    return LENSPROF_OK;
}

lensprof_status lensprof_pto_get_response(const lensprof_pto *pto, uint32_t index, lensprof_response *response,
                                          lensprof_error *error) {
    if (!response || !has_image(pto, index)) return fail_at_image(pto, index, "response", error);
    set_error(error, "");
    const lensprof_pto_image &image = pto->images[index].result;
    if (image.response_type == 1) {
        lensprof_response_set_linear(response);
        return LENSPROF_OK;
    }
    if (lensprof_response_set_emor(response, image.emor, 5) == LENSPROF_OK) return LENSPROF_OK;
    double table[LENSPROF_RESPONSE_SAMPLES], highest = 0.0;
    for (uint32_t j = 0; j + 1 < LENSPROF_RESPONSE_SAMPLES; j++) {
        double value = lensprof_emor_table(0)[j];
        for (uint32_t l = 0; l < 5; l++) value += image.emor[l] * lensprof_emor_table(l + 1)[j];
        table[j] = highest = std::min(std::max(highest, value), 1.0);
    }
    table[0] = 0.0;
    table[LENSPROF_RESPONSE_SAMPLES - 1] = 1.0;
    return lensprof_response_set_table(response, table, LENSPROF_RESPONSE_SAMPLES);
}

lensprof_status lensprof_pto_get_name(const lensprof_pto *pto, uint32_t index, char *name, size_t capacity,
                                      size_t *count, lensprof_error *error) {
    if ((!name && capacity) || !has_image(pto, index)) return fail_at_image(pto, index, "name", error);
    set_error(error, "");
    return copy_bytes(pto->images[index].name, name, capacity, count, error);
}
