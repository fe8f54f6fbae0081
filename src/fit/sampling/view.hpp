// Reads grey values from a picture to sample: patches, gradients, masks.
#pragma once

#include <functional>

#include <lensprof/sample.h>

namespace lensprof {

// A patch of the view, measured at one scene point.
struct Patch {
    double value[3];  // grey value 0..1 at the exact position; repeated for grey views
    double gradient;  // grey values per view pixel, all channels
};

// Rejects a view that does not fit its frame (the camera's size), its mask or its limits. The rest of the camera is not
// read.
lensprof_status check_view(const lensprof_sample_image &image, uint32_t i, lensprof_error *error);

// Reads every sample of float views, on several threads, and rejects views with a sample that is not finite. Throws
// Cancelled if `stop` returns true.
lensprof_status check_finite(const std::function<lensprof_sample_image(uint32_t)> &image, uint32_t count,
                             uint32_t threads, const std::function<bool()> &stop, lensprof_error *error);

class View {
public:
    explicit View(const lensprof_sample_image &image);

    const lensprof_sample_image &image() const { return image_; }

    // First pixel with a sample that is not finite; false if all are finite. Only float views can have one.
    bool find_not_finite(uint32_t &x, uint32_t &y) const;

    // Red, green and blue of every pixel of a row, interleaved; repeated for grey views. allowed[u] is 0 if mask or
    // alpha exclude the pixel.
    void row(int v, float *values, uint8_t *allowed) const;

    // Mean of the channels of every pixel of a row.
    void grey_row(int v, float *out) const;

    // True if a full-frame position lies in the frame, far enough inside the view for a patch.
    bool holds(double x, double y) const;

    // Robust mean of 5 x 5 view pixels about a full-frame position, moved to the exact position along the patch's own
    // gradient. False if a pixel of it is masked, or a channel's value is outside [black, white]; with `keep_white` a
    // channel that is above white in every pixel has the value 1.
    bool patch(double x, double y, bool keep_white, Patch &out) const;

    // Bilinear value and central difference gradient, as in simple samplers; with `keep_white` a channel above white
    // has the value 1.
    bool point(double x, double y, bool keep_white, Patch &out) const;

private:
    void to_view(double x, double y, double &u, double &v) const;
    double sample(int u, int v, int channel) const;
    bool is_allowed(int u, int v) const;
    bool in_range(Patch &patch, bool keep_white) const;

    const lensprof_sample_image &image_;
    int channels_;
    bool reversed_, alpha_;
};

}  // namespace lensprof
