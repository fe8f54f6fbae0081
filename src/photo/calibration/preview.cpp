#include "photo/calibration/preview.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "photo/base/parallel.hpp"
#include "photo/pictures/picture_levels.hpp"
#include "photo/pictures/thumbnail.hpp"
#include "photo/scene/exposures.hpp"

namespace lensprof {
namespace {

constexpr uint32_t longer_side = 1600, gap = 8;  // px of a mosaic
constexpr double max_flat_angle = 55.0 * M_PI / 180.0,
                 max_flat_radius = 8.0;  // forward view; px of a plane at distance 1

// The model on a reduced picture, whose position in the frame does not matter: radii are in half diagonals.
Picture applied(const Picture &source, const lensprof_apply_options &options, const std::string &file) {
    lensprof_apply_options plan_options = options;
    plan_options.frame_width = source.width, plan_options.frame_height = source.height;
    plan_options.source_sample = source.sample, plan_options.source_layout = source.layout;
    plan_options.target_sample = LENSPROF_SAMPLE_U8;
    Picture target;
    target.width = source.width, target.height = source.height;
    target.layout = source.layout;
    target.row_bytes = size_t(source.width) * lensprof_layout_samples(source.layout);
    target.pixels.resize(target.row_bytes * target.height);
    std::vector<uint64_t> memory(lensprof_plan_bytes(&plan_options) / 8 + 1);
    const lensprof_plan *plan = nullptr;
    lensprof_error error{};
    check(lensprof_plan_init(memory.data(), memory.size() * 8, &plan_options, &plan, &error), file, &error);
    const lensprof_image from = source.view();
    const lensprof_target to = target.target();
    check(lensprof_apply(plan, &from, &to, 0, 0), file);
    return target;
}

// A picture corrected with a result, and the unchanged picture in the same format.
CorrectedCopy copy_of(const Scene &scene, uint32_t i, const Fitted &fitted, const lensprof_exposure &target,
                      uint32_t max_side) {
    ReadOptions read;
    read.max_side = max_side;
    Picture source = read_picture(scene.files[i], read);
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    options.responses = options.vignettings = 1;
    const lensprof_vignetting none{};
    lensprof_response linear;
    lensprof_response_set_linear(&linear);
    options.response = &linear, options.vignetting = &none;
    if (has_levels(scene.levels)) options.levels = &scene.levels;  // 0 is black in what is shown
    options.input = options.output = LENSPROF_ENCODING_LINEAR;
    CorrectedCopy copy;
    copy.image = i;
    copy.before = applied(source, options, scene.files[i]);
    options.input = options.output = LENSPROF_ENCODING_RESPONSE;
    options.response = &fitted.response_of(i);
    options.output_response = &fitted.response_of(fitted.reference), options.output_responses = 1;
    const std::array<lensprof_vignetting, 3> falloff = fitted.falloff_of(i);
    options.vignettings = fitted.falloff_curves_of(i), options.vignetting = falloff.data();
    options.source = fitted.exposures[i], options.target = target;
    copy.after = applied(source, options, scene.files[i]);
    copy.camera = scene.images[i].camera;
    return copy;
}

// The projection of a mosaic, and the part of it that pictures cover.
struct Canvas {
    bool is_flat = true;
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0, px = 1.0;  // px: of a pixel
    uint32_t width = 0, height = 0;

    void position_of(const double direction[2], double xy[2]) const {
        xy[0] = is_flat ? std::tan(direction[0]) : direction[0];
        xy[1] = is_flat ? std::tan(direction[1]) / std::cos(direction[0]) : direction[1];
    }
    void direction_of(double x, double y, double direction[2]) const {
        direction[0] = is_flat ? std::atan(x) : x;
        direction[1] = is_flat ? std::atan(y / std::hypot(1.0, x)) : y;
    }
};

struct Box {
    double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
};

// Calls use(direction) for sample positions of a frame, including its edges.
template <class Use>
void for_each_direction(const lensprof_camera &camera, const Use &use) {
    constexpr int steps = 12;
    double direction[2];
    for (int v = 0; v <= steps; v++)
        for (int u = 0; u <= steps; u++)
            if (lensprof_camera_unproject(&camera, u * (camera.width - 1.0) / steps, v * (camera.height - 1.0) / steps,
                                          direction))
                use(direction);
}

// The extent of a picture; the full width if it crosses the edge of an equirectangular canvas.
Box box_of(const Canvas &canvas, const lensprof_camera &camera) {
    Box box;
    for_each_direction(camera, [&](const double direction[2]) {
        double xy[2];
        if (canvas.is_flat && !(std::fabs(direction[0]) < 0.499 * M_PI)) return;
        canvas.position_of(direction, xy);
        if (canvas.is_flat && !(std::hypot(xy[0], xy[1]) < max_flat_radius)) return;
        box.left = std::min(box.left, xy[0]), box.right = std::max(box.right, xy[0]);
        box.top = std::min(box.top, xy[1]), box.bottom = std::max(box.bottom, xy[1]);
    });
    if (!canvas.is_flat && box.right - box.left > M_PI) box.left = -M_PI, box.right = M_PI;
    return box;
}

Canvas canvas_of(const std::vector<CorrectedCopy> &tiles) {
    Canvas canvas;
    for (const CorrectedCopy &tile : tiles) {
        const double *t = tile.camera.translation;
        if (t[0] != 0.0 || t[1] != 0.0 || t[2] != 0.0) break;  // a plane is flat
        for_each_direction(tile.camera, [&](const double direction[2]) {
            if (std::max(std::fabs(direction[0]), std::fabs(direction[1])) > max_flat_angle) canvas.is_flat = false;
        });
    }
    Box all;
    for (const CorrectedCopy &tile : tiles) {
        const Box box = box_of(canvas, tile.camera);
        all.left = std::min(all.left, box.left), all.right = std::max(all.right, box.right);
        all.top = std::min(all.top, box.top), all.bottom = std::max(all.bottom, box.bottom);
    }
    canvas.left = all.left, canvas.top = all.top, canvas.right = all.right, canvas.bottom = all.bottom;
    const double across = all.right - all.left, down = all.bottom - all.top;
    canvas.px = std::max(across, down) / longer_side;
    if (!(across > 0.0 && down > 0.0)) return canvas;
    canvas.width = std::max(1u, static_cast<uint32_t>(std::lround(across / canvas.px)));
    canvas.height = std::max(1u, static_cast<uint32_t>(std::lround(down / canvas.px)));
    return canvas;
}

void copy_pixel(const Picture &from, uint32_t x, uint32_t y, uint8_t *to) {
    const uint32_t samples = lensprof_layout_samples(from.layout);
    const uint8_t *pixel = from.pixels.data() + y * from.row_bytes + size_t(x) * samples;
    for (uint32_t c = 0; c < 3; c++) to[c] = pixel[samples < 3 ? 0 : c];
}

// Draws a tile's pixels into both mosaics, unless another picture's centre is nearer.
void paint(const Canvas &canvas, const CorrectedCopy &tile, std::vector<float> &nearest, Mosaic &out) {
    const lensprof_camera &camera = tile.camera;
    const Box box = box_of(canvas, camera);
    const auto pixel = [&](double position, double from, uint32_t count) {
        return static_cast<uint32_t>(std::clamp((position - from) / canvas.px, 0.0, static_cast<double>(count)));
    };
    const uint32_t right = pixel(box.right + canvas.px, canvas.left, canvas.width),
                   bottom = pixel(box.bottom + canvas.px, canvas.top, canvas.height);
    for (uint32_t v = pixel(box.top, canvas.top, canvas.height); v < bottom; v++)
        for (uint32_t u = pixel(box.left, canvas.left, canvas.width); u < right; u++) {
            double direction[2], xy[2];
            canvas.direction_of(canvas.left + (u + 0.5) * canvas.px, canvas.top + (v + 0.5) * canvas.px, direction);
            if (!lensprof_camera_project(&camera, direction[0], direction[1], xy)) continue;
            const double across = (xy[0] + 0.5) / camera.width, down = (xy[1] + 0.5) / camera.height;
            if (!(across >= 0.0 && across < 1.0 && down >= 0.0 && down < 1.0)) continue;
            const auto distance = static_cast<float>(std::hypot(across - 0.5, down - 0.5));
            float &best = nearest[size_t(v) * canvas.width + u];
            if (!(distance < best)) continue;
            best = distance;
            const auto x = static_cast<uint32_t>(across * tile.before.width),
                       y = static_cast<uint32_t>(down * tile.before.height);
            const size_t place = v * out.before.row_bytes + size_t(3) * u;
            copy_pixel(tile.before, x, y, out.before.pixels.data() + place);
            copy_pixel(tile.after, x, y, out.after.pixels.data() + place);
        }
}

}  // namespace

void check_preview(const std::string &path) {
    if (format_of_name(path) == FileFormat::exr)
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": a mosaic is not written as OpenEXR; give a name ending in .jpg, .png "
                                              "or .tif");
}

std::vector<uint32_t> images_with_exposure(const Fitted &fitted) {
    std::vector<uint32_t> joined;
    for (uint32_t i = 0; i < fitted.exposures.size(); i++)
        if (!std::isnan(fitted.exposures[i].ev)) joined.push_back(i);
    return joined;
}

std::vector<CorrectedCopy> corrected_copies(const Scene &scene, const Fitted &fitted,
                                            const std::vector<uint32_t> &images, uint32_t max_side, Events &progress) {
    const lensprof_exposure target = mean_exposure(fitted.exposures);  // as `apply --pto` has it
    std::vector<CorrectedCopy> copies(images.size());
    for_each_parallel(static_cast<uint32_t>(copies.size()), "preview", progress,
                      [&](uint32_t n) { copies[n] = copy_of(scene, images[n], fitted, target, max_side); });
    return copies;
}

Mosaic mosaic_of(const std::vector<CorrectedCopy> &copies) {
    const Canvas canvas = canvas_of(copies);
    Picture empty;
    empty.width = std::max(canvas.width, 1u), empty.height = std::max(canvas.height, 1u);
    empty.row_bytes = size_t(3) * empty.width;
    empty.pixels.assign(empty.row_bytes * empty.height, 128);
    Mosaic mosaic{empty, empty};
    std::vector<float> nearest(size_t(canvas.width) * canvas.height, std::numeric_limits<float>::max());
    for (const CorrectedCopy &copy : copies) paint(canvas, copy, nearest, mosaic);
    return mosaic;
}

void write_preview(const std::string &path, const Scene &scene, const Fitted &fitted, Events &progress) {
    write_mosaic(path, mosaic_of(corrected_copies(scene, fitted, images_with_exposure(fitted), tile_side, progress)));
}

void write_mosaic(const std::string &path, const Mosaic &mosaic) {
    Picture out = mosaic.before;
    out.height = 2 * mosaic.before.height + gap;
    out.pixels.resize(out.row_bytes * out.height, 128);
    std::copy(mosaic.after.pixels.begin(), mosaic.after.pixels.end(),
              out.pixels.begin() + static_cast<std::ptrdiff_t>((mosaic.before.height + gap) * out.row_bytes));
    write_picture(path, out);
}

Mosaic read_preview(const std::string &path) {
    ReadOptions read;
    read.max_side = 2 * longer_side;  // somebody may have replaced the file by any picture
    Picture stored = read_picture(path, read);
    const Picture both = upright_copy(stored, 1, std::max(stored.width, stored.height));  // 8 bit RGB
    if (both.height < gap + 2)
        throw Failure(LENSPROF_ERROR_READ, path + ": is not a mosaic before and after correction");
    Picture half = both;
    half.height = half.frame_height = (both.height - gap) / 2;
    half.pixels.resize(half.row_bytes * half.height);
    Mosaic mosaic{half, half};
    const auto second = both.pixels.begin() + static_cast<std::ptrdiff_t>((half.height + gap) * half.row_bytes);
    std::copy_n(second, half.pixels.size(), mosaic.after.pixels.begin());
    return mosaic;
}

}  // namespace lensprof
