// A call of a fit: its arguments except the data, and its results.
#pragma once

#include <memory>
#include <vector>

#include "fit/verdict/result.hpp"

namespace lensprof {

struct FitCall {
    lensprof_fit_options options;
    lensprof_response held;  // where the options point to it
    std::vector<lensprof_fit_image> images;
    FitResult result = empty_result();
    std::vector<lensprof_fit_image_quality> quality;
    std::vector<SettingResult> settings;  // empty if all images have setting 0
    std::vector<CameraResult> cameras;    // empty if all images have camera 0

    FitCall() = default;
    FitCall(const FitCall &) = delete;
    FitCall &operator=(const FitCall &) = delete;

    uint32_t count() const { return static_cast<uint32_t>(images.size()); }
    int channels() const { return static_cast<int>(options.channels); }

    // Makes room for the results of the images.
    void make_room();

    // The response and the falloff curves (three, which may be equal) of an image.
    const lensprof_response &response_of(uint32_t image) const;
    const lensprof_vignetting *falloff_of(uint32_t image) const;

    // Takes the images and results of another call.
    void take(FitCall &&other);

private:
    void point_to_room();
};

}  // namespace lensprof
