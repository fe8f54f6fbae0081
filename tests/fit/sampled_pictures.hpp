// Pictures of a smooth panorama for sampling tests.
#pragma once

#include "simulated.hpp"

// A smooth panorama as a function of direction, grey value 0..1 (already encoded: the tests need no camera). `detail`
// adds texture for tests that need it.
inline double detail = 0.0;

inline double scene(double longitude, double latitude, int c) {
    double x = 40 * longitude + 3 * std::sin(11 * latitude), y = 34 * latitude + 3 * std::sin(13 * longitude);
    return 0.5 + 0.2 * std::sin(9 * longitude + c) + 0.2 * std::cos(7 * latitude - 2.0 * c)
           + detail * std::sin(x) * std::cos(y);
}

struct Pictures {
    std::vector<std::vector<float>> data;
    std::vector<std::vector<uint8_t>> masks;
    std::vector<lensprof_sample_image> images;

    Pictures(uint32_t count, uint32_t width, uint32_t height, double step_deg, uint32_t reduction = 1) {
        for (uint32_t i = 0; i < count; i++) {
            lensprof_sample_image image;
            lensprof_sample_image_init(&image);
            image.camera.width = width * reduction;
            image.camera.height = height * reduction;
            image.camera.hfov_deg = 50;
            image.camera.yaw_deg = step_deg * i;
            image.reduction = reduction;
            image.black = 0.02, image.white = 0.98;
            std::vector<float> pixels(static_cast<size_t>(width) * height * 3);
            for (uint32_t v = 0; v < height; v++)
                for (uint32_t u = 0; u < width; u++) {
                    double d[2], x = (u + 0.5) * reduction - 0.5, y = (v + 0.5) * reduction - 0.5;
                    assert_true(lensprof_camera_unproject(&image.camera, x, y, d));
                    for (int c = 0; c < 3; c++)
                        pixels[(static_cast<size_t>(v) * width + u) * 3 + c] = static_cast<float>(scene(d[0], d[1], c));
                }
            data.push_back(pixels);
            masks.emplace_back(static_cast<size_t>(width) * height, uint8_t{1});
            images.push_back(image);
        }
        for (uint32_t i = 0; i < count; i++) {
            images[i].view = {
                data[i].data(),     static_cast<ptrdiff_t>(width * 12), width, height, LENSPROF_SAMPLE_F32,
                LENSPROF_LAYOUT_RGB};
            images[i].mask = masks[i].data();
            images[i].mask_row_bytes = static_cast<ptrdiff_t>(width);
        }
    }

    lensprof_status sample(const lensprof_sample_options &options, std::vector<lensprof_pair> &pairs,
                           lensprof_error *error = nullptr) {
        uint32_t found = 0;
        auto count = static_cast<uint32_t>(images.size());
        lensprof_status status = lensprof_sample_overlap(&options, images.data(), count, nullptr, 0, &found, error);
        if (status != LENSPROF_OK) return status;
        pairs.assign(found, lensprof_pair{});
        status = lensprof_sample_overlap(&options, images.data(), count, pairs.data(), found, &found, error);
        pairs.resize(status == LENSPROF_OK ? found : 0);
        return status;
    }

    lensprof_status tracks(const lensprof_sample_options &options, std::vector<lensprof_observation> &observations,
                           lensprof_error *error = nullptr) {
        uint32_t found = 0;
        auto count = static_cast<uint32_t>(images.size());
        lensprof_status status = lensprof_sample_tracks(&options, images.data(), count, nullptr, 0, &found, error);
        if (status != LENSPROF_OK) return status;
        observations.assign(found, lensprof_observation{});
        status = lensprof_sample_tracks(&options, images.data(), count, observations.data(), found, &found, error);
        observations.resize(status == LENSPROF_OK ? found : 0);
        return status;
    }
};

inline lensprof_sample_options options_of(uint32_t sampling, uint32_t pairs) {
    lensprof_sample_options options;
    lensprof_sample_options_init(&options);
    options.sampling = sampling;
    options.pairs = pairs;
    return options;
}
