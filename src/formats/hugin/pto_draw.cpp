// Drawing what may be used of an image: crop and mask polygons, at the size of a view.
#include <algorithm>
#include <cmath>

#include "formats/hugin/pto.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

// Places of a view's pixel centres in the frame: (u + 0.5) scale - 0.5.
struct Axis {
    double scale;
    uint32_t pixels;

    double place(uint32_t u) const { return (u + 0.5) * scale - 0.5; }

    // First pixel whose place is not below `place`.
    uint32_t first(double place) const {
        double u = std::ceil((place + 0.5) / scale - 0.5);
        return static_cast<uint32_t>(std::clamp(u, 0.0, static_cast<double>(pixels)));
    }
};

// Clears the pixels of the row inside the polygon (even-odd rule). crossings is scratch memory.
void exclude_row(const PtoMask &mask, double y, const Axis &across, uint8_t *row, std::vector<double> &crossings) {
    const auto &corners = mask.corners;
    crossings.clear();
    for (size_t i = 0; i < corners.size(); i++) {
        const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
        if ((a[1] <= y) != (b[1] <= y)) crossings.push_back(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
    }
    std::sort(crossings.begin(), crossings.end());
    for (size_t i = 0; i + 1 < crossings.size(); i += 2)
        std::fill(row + across.first(crossings[i]), row + across.first(crossings[i + 1]), uint8_t{0});
}

// Pixels of the frame cover half a pixel around their centres, so the crop ends half a pixel before its edges. The
// circle of a fisheye is the one Hugin draws: around the middle of the crop, touching its nearer sides.
void crop_row(const lensprof_pto_image &image, double y, const Axis &across, uint8_t *row) {
    const int32_t *crop = image.crop;
    std::fill(row, row + across.pixels, uint8_t{0});
    if (y < crop[1] - 0.5 || y >= crop[3] - 0.5) return;
    double left = crop[0] - 0.5, right = crop[2] - 0.5;
    if (image.crop_circular) {
        double x = 0.5 * (crop[0] + crop[2]), dy = y - 0.5 * (crop[1] + crop[3]);
        double radius = 0.5 * std::min(crop[2] - crop[0], crop[3] - crop[1]);
        double half2 = radius * radius - dy * dy;
        if (half2 <= 0) return;
        left = std::max(left, std::nextafter(x - std::sqrt(half2), x));
        right = std::min(right, x + std::sqrt(half2));
    }
    std::fill(row + across.first(left), row + std::max(across.first(left), across.first(right)), uint8_t{1});
}

bool concerns(const lensprof_pto &pto, const PtoMask &mask, uint32_t index) {
    const PtoImage &marked = pto.images[mask.image], &image = pto.images[index];
    switch (mask.type) {
    case kMaskExcludeStack:
    case kMaskIncludeStack:
        return marked.root[kStack] == image.root[kStack];  // Hugin numbers every stack 0; only the links tell
    case kMaskExcludeLens: return marked.root[kHfov] == image.root[kHfov];
    default: return mask.image == index;
    }
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lensprof_pto_draw_mask(const lensprof_pto *pto, uint32_t index, uint8_t *mask, uint32_t width,
                                       uint32_t height, ptrdiff_t row_bytes, lensprof_error *error) {
    if (!mask || !has_image(pto, index)) return fail_at_image(pto, index, "mask", error);
    const ptrdiff_t least = static_cast<ptrdiff_t>(width);
    if (!width || !height || (row_bytes < least && row_bytes > -least)) {
        set_error(error,
                  "lensprof_pto_draw_mask: the mask has no pixels, or row_bytes is below its width; correct them");
        return LENSPROF_ERROR_SIZE;
    }
    return at_boundary(error, [&] {
        const lensprof_pto_image &image = pto->images[index].result;
        Axis across = {image.camera.width / static_cast<double>(width), width};
        Axis down = {image.camera.height / static_cast<double>(height), height};
        // An include mask asks for this image's content there, and so takes it from every other image: as no pair can
        // be made there, it excludes as well (as in Hugin's own search for control points).
        std::vector<const PtoMask *> excludes;
        size_t corners = 0;
        for (const PtoMask &m : pto->masks) {
            if (m.corners.size() < 3 || !concerns(*pto, m, index)) continue;
            excludes.push_back(&m);
            corners = std::max(corners, m.corners.size());
        }
        std::vector<double> crossings;
        crossings.reserve(corners);  // no allocation, hence no failure, once the drawing has begun
        for (uint32_t v = 0; v < height; v++) {
            uint8_t *row = mask + static_cast<ptrdiff_t>(v) * row_bytes;
            double y = down.place(v);
            crop_row(image, y, across, row);
            for (const PtoMask *m : excludes) exclude_row(*m, y, across, row, crossings);
        }
    });
}
