#include "cli/calibrate/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <cairo.h>

#include "cli/calibrate/attempt.hpp"
#include "cli/pictures/contact_sheet.hpp"
#include "cli/pictures/upright.hpp"
#include "cli/program/format.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/parallel.hpp"
#include "cli/program/paths.hpp"
#include "cli/program/utf8.hpp"

namespace lensprof {
namespace {

constexpr uint32_t cell = 320, gap = 12, columns = 5, line = 22, label = 2 * line, per_page = 60;  // px
constexpr double text_size = 16;                                                                   // px
constexpr uint8_t background = 40;

// A small copy, 8 bit RGB, upright.
struct Small {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

// Empty for an unreadable file: the copy may have been edited since.
Small small_of(const std::string &file, uint16_t orientation) {
    ReadOptions read;
    read.max_side = cell;
    Picture picture;
    if (!why_not([&] { picture = read_picture(file, read); }).empty()) return {};
    Thumbnail thumbnail(picture.width, picture.height);
    thumbnail.add(picture.view());
    Small small{thumbnail.width, thumbnail.height, std::move(thumbnail.rgb)};
    turn_upright(orientation, small.width, small.height, small.rgb);
    return small;
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

double width_of(cairo_t *cr, const std::string &text) {
    cairo_text_extents_t extents;
    cairo_text_extents(cr, text.c_str(), &extents);
    return extents.x_advance;
}

// Text at most as wide as a cell: the middle of a longer one is omitted.
void draw_text(cairo_t *cr, double x, double y, const std::string &text) {
    std::string valid = one_line(text);
    for (size_t at = 0; at < valid.size();) {
        const size_t length = utf8_length(valid, at);
        if (!length) valid[at] = '?';
        at += std::max<size_t>(length, 1);
    }
    std::string shown = valid;
    for (size_t kept = valid.size(); kept > 4 && width_of(cr, shown) > cell; kept--) {
        size_t end = valid.size() - kept / 2;
        while (end < valid.size() && !utf8_length(valid, end)) end++;
        shown = valid.substr(0, utf8_cut(valid, kept / 2)) + "..." + valid.substr(end);
    }
    cairo_move_to(cr, x, y);
    cairo_show_text(cr, shown.c_str());
}

void put(const Small &small, uint32_t left, uint32_t top, Picture &page) {
    for (uint32_t y = 0; y < small.height; y++)
        std::copy_n(&small.rgb[size_t(y) * small.width * 3], size_t(small.width) * 3,
                    &page.pixels[(top + y) * page.row_bytes + size_t(left) * 3]);
}

std::string second_line(const CorrectedPicture &one) {
    if (one.ev) return format("%+.2f EV  ", *one.ev) + one.panorama;
    if (one.job.profile_id) return format("falloff by profile %lld", static_cast<long long>(one.job.profile_id));
    return "falloff predicted by a lookup";
}

// Draws the labels with cairo, whose pixels are blue, green, red and an unused byte, in native order.
void draw_labels(const CorrectedPicture *first, size_t count, uint32_t band, Picture &page) {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(page.width), int(page.height)),
                          cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_t *cr = context.get();
    cairo_set_source_rgb(cr, background / 255.0, background / 255.0, background / 255.0);
    cairo_paint(cr);
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, text_size);
    cairo_set_source_rgb(cr, 0.95, 0.95, 0.95);
    for (size_t i = 0; i < count; i++) {
        const double x = double(gap + i % columns * (cell + gap)), y = double(gap + i / columns * band);
        draw_text(cr, x, y + text_size, first[i].picture->name);
        draw_text(cr, x, y + line + text_size, second_line(first[i]));
    }
    cairo_surface_flush(surface.get());
    if (cairo_status(cr) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
    const uint8_t *data = cairo_image_surface_get_data(surface.get());
    const auto stride = static_cast<size_t>(cairo_image_surface_get_stride(surface.get()));
    for (uint32_t y = 0; y < page.height; y++)
        for (uint32_t x = 0; x < page.width; x++) {
            const uint32_t pixel = reinterpret_cast<const uint32_t *>(data + y * stride)[x];
            uint8_t *to = &page.pixels[y * page.row_bytes + size_t(x) * 3];
            to[0] = uint8_t(pixel >> 16), to[1] = uint8_t(pixel >> 8), to[2] = uint8_t(pixel);
        }
}

void write_sheet(const std::string &path, const CorrectedPicture *first, size_t count, Progress &progress) {
    std::vector<std::pair<Small, Small>> pairs(count);
    for_each_parallel(static_cast<uint32_t>(count), "contact sheet", progress, [&](uint32_t i) {
        const InputPicture &picture = *first[i].picture;
        pairs[i] = {small_of(picture.file, picture.metadata.orientation),
                    small_of(picture.target, picture.metadata.orientation)};
    });
    uint32_t high = 1;
    for (const auto &pair : pairs) high = std::max({high, pair.first.height, pair.second.height});
    const uint32_t band = label + 2 * (high + gap) + gap;
    Picture page;
    page.width = page.frame_width = gap + std::min<uint32_t>(columns, uint32_t(count)) * (cell + gap);
    page.height = page.frame_height = gap + (uint32_t(count) + columns - 1) / columns * band;
    page.row_bytes = size_t(3) * page.width;
    page.pixels.resize(page.row_bytes * page.height);
    draw_labels(first, count, band, page);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t left = gap + i % columns * (cell + gap), top = gap + i / columns * band + label;
        put(pairs[i].first, left, top, page);
        put(pairs[i].second, left, top + high + gap, page);
    }
    write_picture(path, page);
}

}  // namespace

std::vector<std::string> sheet_names(const CalibrateOptions &o, size_t pictures) {
    std::vector<std::string> names;
    for (size_t page = 0; page * per_page < pictures; page++)
        names.push_back((std::filesystem::path(o.output) / sheet_name(page)).string());
    return names;
}

void write_sheets(const CalibrateOptions &o, const CorrectedPictures &pictures, Ledger &ledger, Progress &progress) {
    const std::vector<std::string> names = sheet_names(o, pictures.list.size());
    for (size_t page = 0; page < names.size(); page++) {
        stop_if_interrupted();
        const size_t first = page * per_page, count = std::min<size_t>(per_page, pictures.list.size() - first);
        std::string text = "sheet";
        for (size_t i = first; i < first + count; i++)
            text += "\n" + pictures.list[i].key + " " + pictures.list[i].picture->name + " "
                    + second_line(pictures.list[i]);
        const std::string key = digest_of_text(text);
        if (ledger.is_current(names[page], key)) continue;
        ledger.begin(names[page], key);
        ledger.save();
        write_sheet(names[page], &pictures.list[first], count, progress);
        ledger.finish(names[page]);
        ledger.save();
    }

    for (size_t page = names.size();; page++) {  // pages of an earlier, larger set
        const std::string name = sheet_names(o, (page + 1) * per_page).back();
        if (!ledger.knows(name)) break;
        ledger.remove(name);
    }
}

}  // namespace lensprof
