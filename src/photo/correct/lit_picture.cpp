#include "photo/correct/lit_picture.hpp"

#include "photo/correct/picture_plan.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {

static constexpr double edge_px = 0.05;  // beyond the centres of the outermost pixels

LitPicture::LitPicture(const PlacedCorrection &placed, const CorrectionKind &kind, const Scene &scene)
    : weights_(placed.job),
      camera_(scene.images[placed.image].camera),
      vignetting_(placed.job.model->vignetting[0]),
      grey_(read_picture(placed.job.source)),
      samples_(lensprof_layout_samples(grey_.layout)) {
    const std::string &file = placed.job.source;
    view_ = grey_.view();
    check_finite(view_, 0, 1, file);
    light_.resize(size_t(grey_.width) * grey_.height * samples_);
    const lensprof_target after{light_.data(),       static_cast<ptrdiff_t>(grey_.width * samples_ * sizeof(float)),
                                grey_.width,         grey_.height,
                                LENSPROF_SAMPLE_F32, grey_.layout};
    const Plan plan(options_of(grey_, placed.job, kind), file);
    check(lensprof_apply(plan.get(), &view_, &after, 0, 0), file);
    for (size_t c = 0; c < 3; c++) gain_[c] = gain_of(placed.job, c);
    for (int k = 0; k <= curve_steps; k++)
        curve_[static_cast<size_t>(k)] = lensprof_response_eval(
            &placed.job.model->response[0], std::pow(static_cast<double>(k) / curve_steps, 2), nullptr);
    mask_ = mask_of(scene, placed.image, grey_.width, grey_.height);
}

void LitPicture::weights(uint32_t x, uint32_t y, double trust, double weight[3]) const {
    const double m = falloff(x, y);
    for (size_t c = 0; c < samples_; c++) weight[c] = trust * m * m * weights_.at(c, grey(x, y, c));
}

bool read_at(LitPicture &picture, const double xy[2], Reading &reading) {
    const double right = picture.width() - 1.0, bottom = picture.height() - 1.0;
    if (!(xy[0] >= -edge_px && xy[1] >= -edge_px && xy[0] <= right + edge_px && xy[1] <= bottom + edge_px))
        return false;
    const double at_x = std::clamp(xy[0], 0.0, right), at_y = std::clamp(xy[1], 0.0, bottom);
    const auto x = static_cast<uint32_t>(at_x), y = static_cast<uint32_t>(at_y);
    const double u = at_x - x, v = at_y - y;
    const uint32_t next_x = std::min(x + 1, picture.width() - 1), next_y = std::min(y + 1, picture.height() - 1);
    reading = {{}, 1.0, false, u < 0.5 ? x : next_x, v < 0.5 ? y : next_y};
    for (uint32_t n = 0; n < 4; n++) {
        const uint32_t px = n % 2 ? next_x : x, py = n / 2 ? next_y : y;
        const double share = (n % 2 ? u : 1 - u) * (n / 2 ? v : 1 - v);
        if (picture.is_masked(px, py)) return false;
        const float *light = picture.light(px, py);
        for (size_t c = 0; c < picture.samples(); c++) reading.light[c] += share * static_cast<double>(light[c]);
        reading.trust = std::min(reading.trust, picture.trust(px, py));
        reading.is_white = reading.is_white || is_white(picture.largest(px, py));
    }
    return true;
}

}  // namespace lensprof
