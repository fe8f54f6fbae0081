// Sampling: pairs show the same scene point, are spread evenly, and avoid unsuitable places.
#include "sampled_pictures.hpp"

#include <algorithm>
#include <map>

namespace {

void test_pairs_show_one_scene_point(void **) {
    for (uint32_t reduction : {1u, 3u})
        for (uint32_t sampling : {LENSPROF_SAMPLING_BALANCED, LENSPROF_SAMPLING_PAPER}) {
            Pictures pictures(4, 320, 240, 25.0, reduction);
            std::vector<lensprof_pair> pairs;
            assert_ok(pictures.sample(options_of(sampling, 500), pairs));
            assert_true(pairs.size() > 400 && pairs.size() <= 500);
            for (const auto &pair : pairs) {
                double d[2][2];
                for (int side = 0; side < 2; side++) {
                    const auto &camera = pictures.images[pair.image[side]].camera;
                    assert_true(lensprof_camera_unproject(&camera, pair.xy[side][0], pair.xy[side][1], d[side]));
                    for (int c = 0; c < 3; c++)
                        assert_close(pair.value[side][c], scene(d[side][0], d[side][1], c), 0.004);
                }
                assert_close(d[0][0], d[1][0], 1e-7);
                assert_close(d[0][1], d[1][1], 1e-7);
            }
        }
}

void test_balanced_over_pairs_radius_and_grey(void **) {
    Pictures pictures(6, 320, 240, 25.0);
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 1000), pairs));
    assert_int_equal(pairs.size(), 1000);
    std::map<std::pair<uint32_t, uint32_t>, int> per_edge;
    int per_radius[10] = {}, per_grey[10] = {};
    const lensprof_vignetting centred{};
    for (const auto &pair : pairs) {
        per_edge[std::minmax(pair.image[0], pair.image[1])]++;
        for (int side = 0; side < 2; side++) {
            double r2 = lensprof_vignetting_r2(&centred, 320, 240, pair.xy[side][0], pair.xy[side][1], nullptr);
            per_radius[std::min(9, static_cast<int>(10 * std::sqrt(r2)))]++;
            per_grey[std::min(
                9, static_cast<int>(10 * (pair.value[side][0] + pair.value[side][1] + pair.value[side][2]) / 3))]++;
        }
    }
    assert_int_equal(per_edge.size(), 5);  // 50 degrees wide, 25 degrees apart: only neighbours overlap
    for (const auto &edge : per_edge) assert_true(edge.second >= 100 && edge.second <= 400);
    // Two directions 25 degrees apart: no pair has both ends near the centre, and rings 0 and 1 hold few.
    for (int ring = 3; ring < 10; ring++) assert_true(per_radius[ring] > 50);
    for (int grey = 4; grey < 6; grey++) assert_true(per_grey[grey] > 50 && per_grey[grey] < 1400);
}

void test_masks_levels_and_alpha_are_kept_out(void **) {
    for (uint32_t sampling : {LENSPROF_SAMPLING_BALANCED, LENSPROF_SAMPLING_PAPER}) {
        Pictures pictures(3, 320, 240, 20.0);
        for (uint32_t v = 0; v < 240; v++)
            for (uint32_t u = 0; u < 320; u++) {
                if (v < 120) pictures.masks[1][v * 320 + u] = 0;  // upper half of image 1
                float *pixel = &pictures.data[0][(v * 320 + u) * 3];
                if (u > 300) pixel[1] = 1.0f;  // saturated in one channel
                if (v > 200) pixel[2] = 0.0f;  // black in one channel
            }
        std::vector<lensprof_pair> pairs;
        assert_ok(pictures.sample(options_of(sampling, 600), pairs));
        for (const auto &pair : pairs)
            for (int side = 0; side < 2; side++) {
                if (pair.image[side] == 1) assert_true(pair.xy[side][1] > 119.0);
                if (pair.image[side] == 0) assert_true(pair.xy[side][0] < 302.0 && pair.xy[side][1] < 202.0);
                for (double v : pair.value[side]) assert_true(v >= 0.02 && v <= 0.98);
            }
    }
}

// Single wrong pixels barely change a patch.
void test_patches_shrug_off_hot_pixels(void **) {
    Pictures pictures(3, 320, 240, 20.0);
    uint64_t random = 5;
    for (auto &picture : pictures.data)
        for (size_t p = 0; p < picture.size(); p += 3)
            if (lp_random(&random) < 0.10)
                for (int c = 0; c < 3; c++) picture[p + c] = static_cast<float>(lp_random(&random));
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 500), pairs));
    double sum = 0;
    for (const auto &pair : pairs)
        for (int c = 0; c < 3; c++) sum += std::pow(pair.value[0][c] - pair.value[1][c], 2);
    assert_true(255 * std::sqrt(sum / (3 * pairs.size())) < 2.0);
}

// Distance in px of pairs from the true place in the second picture: the quantile `share`.
double distance_of_pairs(const std::vector<lensprof_pair> &pairs, const lensprof_camera cameras[2], double share) {
    std::vector<double> distances;
    for (const auto &pair : pairs) {
        double direction[2], xy[2];
        const int side = pair.image[0] == 0 ? 0 : 1;
        assert_true(lensprof_camera_unproject(&cameras[0], pair.xy[side][0], pair.xy[side][1], direction));
        assert_true(lensprof_camera_project(&cameras[1], direction[0], direction[1], xy));
        distances.push_back(std::hypot(xy[0] - pair.xy[1 - side][0], xy[1] - pair.xy[1 - side][1]));
    }
    std::sort(distances.begin(), distances.end());
    return distances[static_cast<size_t>(share * static_cast<double>(distances.size() - 1))];
}

// The pictures were taken in directions up to 16 pixels off from the project: yaw, pitch and roll.
void test_a_project_that_is_off_is_registered(void **) {
    detail = 0.07;
    Pictures pictures(2, 320, 240, 20.0);
    detail = 0.0;
    const lensprof_camera truth[2] = {pictures.images[0].camera, pictures.images[1].camera};
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 500), pairs));
    assert_close(distance_of_pairs(pairs, truth, 1.0), 0.0, 1e-6);  // already right: nothing is moved
    for (double yaw : {-2.5, 1.0})
        for (double roll : {0.0, 0.5}) {
            pictures.images[1].camera = truth[1];
            pictures.images[1].camera.yaw_deg += yaw;
            pictures.images[1].camera.pitch_deg += 0.7;
            pictures.images[1].camera.roll_deg += roll;
            assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 500), pairs));
            assert_int_equal(pairs.size(), 500);
            assert_true(distance_of_pairs(pairs, truth, 0.95) < 1.5);
        }
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_PAPER, 500), pairs));
    assert_true(distance_of_pairs(pairs, truth, 0.5) > 4.0);  // the paper's variant trusts the project
}

// The angle of view of one image is up to a seventh too small in the project; no rotation compensates for that.
void test_a_wrong_angle_of_view_is_registered(void **) {
    detail = 0.07;
    Pictures pictures(2, 320, 240, 20.0);
    detail = 0.0;
    const lensprof_camera truth[2] = {pictures.images[0].camera, pictures.images[1].camera};
    for (double hfov : {47.0, 43.0}) {
        pictures.images[1].camera.hfov_deg = hfov;
        std::vector<lensprof_pair> pairs;
        assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 500), pairs));
        assert_int_equal(pairs.size(), 500);
        assert_true(distance_of_pairs(pairs, truth, 0.95) < 1.5);
    }
}

// Something covers the scene in one picture.
void test_what_moved_is_left_out(void **) {
    detail = 0.07;
    Pictures pictures(2, 320, 240, 15.0);
    detail = 0.0;
    const uint32_t left = 60, right = 180, top = 60, bottom = 180, border = 12;
    for (uint32_t v = top; v < bottom; v++)
        for (uint32_t u = left; u < right; u++)
            for (int c = 0; c < 3; c++) pictures.data[1][(v * 320 + u) * 3 + static_cast<uint32_t>(c)] = 0.6f;
    std::vector<lensprof_pair> pairs;
    auto share_inside = [&](uint32_t sampling) {
        assert_ok(pictures.sample(options_of(sampling, 1000), pairs));
        double inside = 0.0;
        for (const auto &pair : pairs) {
            const double *xy = pair.xy[pair.image[0] == 1 ? 0 : 1];
            inside +=
                xy[0] > left + border && xy[0] < right - border && xy[1] > top + border && xy[1] < bottom - border;
        }
        return inside / static_cast<double>(pairs.size());
    };
    assert_true(share_inside(LENSPROF_SAMPLING_PAPER) > 0.1);
    assert_true(share_inside(LENSPROF_SAMPLING_BALANCED) < 0.01);
}

// Fills a part of a picture with squares of random grey values.
void fill_with_squares(std::vector<float> &data, uint32_t left, uint32_t top, uint32_t width, uint32_t height,
                       uint32_t seed = 1) {
    for (uint32_t v = 0; v < height; v++)
        for (uint32_t u = 0; u < width; u++) {
            uint64_t random = 1000 * (v / 8) + u / 8 + seed;
            lp_random(&random);
            const float value = static_cast<float>(0.2 + 0.6 * lp_random(&random));
            for (uint32_t c = 0; c < 3; c++) data[((top + v) * 320 + left + u) * 3 + c] = value;
        }
}

// An object with more texture than the scene has moved; the project is right and stays unchanged.
void test_a_moving_thing_does_not_move_the_project(void **) {
    detail = 0.04;
    Pictures pictures(2, 320, 240, 15.0);
    detail = 0.0;
    const lensprof_camera truth[2] = {pictures.images[0].camera, pictures.images[1].camera};
    fill_with_squares(pictures.data[0], 200, 70, 96, 96);  // 15 degrees = 92 px
    fill_with_squares(pictures.data[1], 200 - 92 - 24, 70, 96, 96);
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 500), pairs));
    assert_true(distance_of_pairs(pairs, truth, 0.95) < 1.0);
}

// A smooth object in front of different squares in each picture: its own place shows no difference, its surroundings
// do.
void test_a_smooth_place_in_other_surroundings_is_left_out(void **) {
    detail = 0.07;
    Pictures pictures(2, 320, 240, 15.0);
    detail = 0.0;
    const uint32_t left[2] = {136, 44}, top = 50, side = 140, border = 44;  // 15 degrees = 92 px
    for (uint32_t i : {0u, 1u}) {
        fill_with_squares(pictures.data[i], left[i], top, side, side, 1 + 500000 * i);
        for (uint32_t v = top + border; v < top + side - border; v++)
            for (uint32_t u = left[i] + border; u < left[i] + side - border; u++)
                std::fill_n(&pictures.data[i][3 * (v * 320 + u)], 3, 0.4f + 0.1f * static_cast<float>(i));
    }
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 1000), pairs));
    assert_true(pairs.size() > 500);
    for (const auto &pair : pairs) {
        const double *xy = pair.xy[pair.image[0] == 0 ? 0 : 1];
        assert_false(std::abs(xy[0] - left[0] - side / 2.0) < 10 && std::abs(xy[1] - top - side / 2.0) < 10);
    }
}

// Noise keeps some pixels of a saturated place below white: their mean is not that of the light.
void test_a_saturated_place_is_left_out(void **) {
    Pictures pictures(2, 320, 240, 15.0);
    uint64_t random = 3;
    for (uint32_t v = 0; v < 240; v++)
        for (uint32_t u = 160; u < 320; u++)
            if (lp_random(&random) < 0.6) pictures.data[0][3 * (v * 320 + u) + 1] = 1.0f;
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 600), pairs));
    assert_true(pairs.size() > 100);
    size_t there = 0;
    for (const auto &pair : pairs) there += pair.xy[pair.image[0] == 0 ? 0 : 1][0] > 162;
    assert_true(there < pairs.size() / 20);
}

// The third picture shows none of the places that the project states.
void test_a_picture_in_the_wrong_place_has_no_pairs(void **) {
    detail = 0.07;
    Pictures pictures(3, 320, 240, 15.0);
    detail = 0.0;
    std::vector<lensprof_pair> pairs;
    auto of_third = [&] {
        return std::count_if(pairs.begin(), pairs.end(),
                             [](const lensprof_pair &p) { return p.image[0] == 2 || p.image[1] == 2; });
    };
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 600), pairs));
    assert_true(of_third() > 100);
    fill_with_squares(pictures.data[2], 0, 0, 320, 240);
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 600), pairs));
    assert_int_equal(of_third(), 0);
    assert_int_equal(pairs.size(), 600);
}

// A stationary camera: equal places, and grey values next to black and white, where pictures do not look alike. Returns
// the links that sampling reports for three pictures in a row.
std::vector<lensprof_link> links_of(Pictures &pictures, lensprof_sample_options options, uint32_t room = 3) {
    std::vector<lensprof_link> links(room);
    uint32_t found = 0;
    options.links = links.data(), options.link_capacity = room, options.link_count = &found;
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options, pairs));
    uint32_t of_links = 0;
    for (uint32_t n = 0; n < std::min(found, room); n++) of_links += links[n].pairs;
    if (room >= found) assert_int_equal(of_links, pairs.size());
    links.resize(found);
    return links;
}

// Texture that agrees verifies a link, texture that disagrees contradicts it, and waves as slow as a sky's do neither.
void test_links_say_what_texture_says(void **) {
    detail = 0.07;
    Pictures textured(3, 320, 240, 22.0), smooth(3, 320, 240, 22.0);
    detail = 0.0;
    const lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 600);
    const std::vector<lensprof_link> links = links_of(textured, options);
    assert_int_equal(links.size(), 3);
    const uint32_t images[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    for (size_t n = 0; n < 3; n++) {
        assert_memory_equal(links[n].image, images[n], sizeof images[n]);
        if (n != 1) assert_int_equal(links[n].state, LENSPROF_LINK_VERIFIED);
    }
    assert_int_equal(links_of(textured, options, 1).size(), 3);  // room for one
    fill_with_squares(textured.data[2], 0, 0, 320, 240);
    for (const lensprof_link &link : links_of(textured, options))
        if (link.image[1] == 2) assert_true(link.state == LENSPROF_LINK_CONTRADICTED && link.pairs == 0);
    for (auto &picture : smooth.data)
        for (float &v : picture) v = 0.45f + 0.1f * v;
    for (const lensprof_link &link : links_of(smooth, options)) assert_int_equal(link.state, LENSPROF_LINK_UNVERIFIED);
}

// A wall with few lines, off by 4 to 8 pixels: all lines together determine the shift.
void test_few_lines_register_together(void **) {
    Pictures pictures(2, 320, 240, 20.0);
    for (uint32_t i = 0; i < 2; i++) {
        const lensprof_camera &camera = pictures.images[i].camera;
        for (uint32_t n = 0; n < 320 * 240; n++) {
            double d[2];
            assert_true(lensprof_camera_unproject(&camera, n % 320, n / 320, d));
            const double line = std::min(std::abs(d[0] - 0.17), std::min(std::abs(d[1] - 0.11), std::abs(d[1] + 0.2)));
            for (int c = 0; c < 3; c++)
                pictures.data[i][3 * n + static_cast<size_t>(c)] =
                    static_cast<float>(0.5 + 0.1 * d[0] - (line < 0.006 ? 0.2 : 0.0));
        }
    }
    const lensprof_camera truth[2] = {pictures.images[0].camera, pictures.images[1].camera};
    for (double off : {0.6, -1.1}) {
        pictures.images[1].camera = truth[1];
        pictures.images[1].camera.yaw_deg += off, pictures.images[1].camera.pitch_deg -= off;
        std::vector<lensprof_pair> pairs;
        assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BALANCED, 500), pairs));
        assert_int_equal(pairs.size(), 500);
        assert_true(distance_of_pairs(pairs, truth, 0.95) < 1.5);
    }
}

void test_bracket_takes_what_does_not_look_alike(void **) {
    Pictures pictures(2, 160, 120, 0.0);
    for (float &value : pictures.data[1]) value = std::min(1.0f, 2.0f * value);  // much of it is white
    for (auto &image : pictures.images) image.black = 0.002, image.white = 0.998;
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BRACKET, 400), pairs));
    assert_true(pairs.size() > 50);
    for (const auto &pair : pairs)
        for (int c = 0; c < 3; c++) {
            assert_close(pair.xy[0][0], pair.xy[1][0], 1e-6);
            assert_close(pair.xy[0][1], pair.xy[1][1], 1e-6);
            double bright = pair.value[pair.image[1] == 1][c], dark = pair.value[pair.image[1] != 1][c];
            assert_true(bright < 0.998);
            assert_close(bright, 2.0 * dark, 0.03);
        }
}

// No pixel of a patch may be black or white, even if its mean is neither.
void test_every_pixel_of_a_patch(void **) {
    Pictures pictures(2, 160, 120, 0.0);
    for (auto &data : pictures.data)
        for (size_t p = 0; p < data.size() / 3; p += 7)
            for (size_t c = 0; c < 3; c++) data[3 * p + c] = 1.0f;  // one white pixel in every patch
    std::vector<lensprof_pair> pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_BRACKET, 400), pairs));
    assert_true(pairs.size() > 50);
    for (auto &image : pictures.images) image.every_pixel = 1;
    assert_int_equal(pictures.sample(options_of(LENSPROF_SAMPLING_BRACKET, 400), pairs), LENSPROF_ERROR_NO_SAMPLES);
    pictures.images[0].every_pixel = 2;
    assert_int_equal(pictures.sample(options_of(LENSPROF_SAMPLING_BRACKET, 400), pairs), LENSPROF_ERROR_SIZE);
}

void test_same_seed_same_pairs(void **) {
    Pictures pictures(3, 160, 120, 20.0);
    std::vector<lensprof_pair> a, b, other;
    lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 300);
    assert_ok(pictures.sample(options, a));
    assert_ok(pictures.sample(options, b));
    assert_int_equal(a.size(), b.size());
    assert_memory_equal(a.data(), b.data(), a.size() * sizeof a[0]);
    options.seed = 2;
    assert_ok(pictures.sample(options, other));
    assert_true(other.size() != a.size() || std::memcmp(a.data(), other.data(), a.size() * sizeof a[0]) != 0);
}

void test_any_number_of_threads_gives_the_same_pairs(void **) {
    for (uint32_t count : {2u, 5u}) {
        Pictures pictures(count, 160, 120, 20.0);
        for (uint32_t sampling : {LENSPROF_SAMPLING_BALANCED, LENSPROF_SAMPLING_PAPER}) {
            std::vector<lensprof_pair> one, pairs;
            lensprof_sample_options options = options_of(sampling, 700);
            options.threads = 1;
            assert_ok(pictures.sample(options, one));
            for (uint32_t threads : {2u, 5u, 0u}) {
                options.threads = threads;
                assert_ok(pictures.sample(options, pairs));
                assert_int_equal(pairs.size(), one.size());
                assert_memory_equal(pairs.data(), one.data(), one.size() * sizeof one[0]);
            }
        }
    }
}

// The calls of a progress function, which cancels at call number `last`.
struct Heard {
    std::vector<double> done;
    size_t last = SIZE_MAX;
};

int hear(double done, void *user) {
    auto *heard = static_cast<Heard *>(user);
    heard->done.push_back(done);
    return heard->done.size() >= heard->last;
}

void test_progress_rises_to_one(void **) {
    Pictures pictures(4, 160, 120, 20.0);
    for (uint32_t sampling : {LENSPROF_SAMPLING_BALANCED, LENSPROF_SAMPLING_PAPER})
        for (uint32_t threads : {1u, 3u}) {
            Heard heard;
            lensprof_sample_options options = options_of(sampling, 2000);
            options.threads = threads;
            options.progress = hear;
            options.progress_user = &heard;
            std::vector<lensprof_pair> pairs;
            assert_ok(pictures.sample(options, pairs));
            assert_true(heard.done.size() >= 2 && heard.done.front() >= 0.0 && heard.done.back() == 1.0);
            assert_true(std::is_sorted(heard.done.begin(), heard.done.end()));
        }
}

void test_progress_cancels(void **) {
    Pictures pictures(4, 160, 120, 20.0);
    for (uint32_t sampling : {LENSPROF_SAMPLING_BALANCED, LENSPROF_SAMPLING_PAPER})
        for (size_t last : {1u, 2u, 20u}) {
            Heard heard;
            heard.last = last;
            lensprof_sample_options options = options_of(sampling, 2000);
            options.threads = last < 3 ? 2 : 1;  // the number of calls depends on which thread does the work
            options.progress = hear;
            options.progress_user = &heard;
            std::vector<lensprof_pair> pairs(2000);
            uint32_t found = 77;
            lensprof_error error;
            lensprof_pair untouched = pairs[0];
            assert_int_equal(
                lensprof_sample_overlap(&options, pictures.images.data(), 4, pairs.data(), 2000, &found, &error),
                LENSPROF_ERROR_CANCELLED);
            assert_int_equal(heard.done.size(), last);  // no call after the cancellation
            assert_int_equal(found, 77);
            assert_memory_equal(&pairs[0], &untouched, sizeof untouched);
            assert_non_null(strstr(error.text, "cancelled"));
        }
}

void test_sample_types_and_layouts_agree(void **) {
    Pictures pictures(2, 160, 120, 20.0);
    std::vector<lensprof_pair> reference, pairs;
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_PAPER, 100), reference));
    std::vector<std::vector<uint16_t>> bgra(2);
    for (int i = 0; i < 2; i++) {
        for (size_t p = 0; p < pictures.data[i].size(); p += 3) {
            for (int c = 2; c >= 0; c--)
                bgra[i].push_back(static_cast<uint16_t>(std::lround(65535 * pictures.data[i][p + c])));
            bgra[i].push_back(65535);
        }
        pictures.images[i].view = {
            bgra[i].data() + 119 * 160 * 4, -160 * 8, 160, 120, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_BGRA};
        for (int v = 0; v < 60; v++)  // bottom-up rows
            for (int k = 0; k < 160 * 4; k++) std::swap(bgra[i][v * 640 + k], bgra[i][(119 - v) * 640 + k]);
    }
    assert_ok(pictures.sample(options_of(LENSPROF_SAMPLING_PAPER, 100), pairs));
    // Rounding to 16 bit may change which of two points has the lower gradient; most pairs stay the same.
    size_t same = 0;
    for (const auto &pair : pairs)
        for (const auto &other : reference) {
            if (pair.xy[0][0] != other.xy[0][0] || pair.image[0] != other.image[0]) continue;
            same++;
            for (int c = 0; c < 3; c++) assert_close(pair.value[1][c], other.value[1][c], 2e-5);
        }
    assert_true(same > 80);
}

void test_refuses(void **) {
    std::vector<lensprof_pair> pairs;
    lensprof_error error;
    lensprof_sample_options options = options_of(LENSPROF_SAMPLING_BALANCED, 100);
    Pictures apart(2, 80, 60, 90.0);
    assert_int_equal(apart.sample(options, pairs, &error), LENSPROF_ERROR_NO_OVERLAP);
    assert_non_null(strstr(error.text, "overlap"));
    Pictures white(2, 80, 60, 20.0);
    for (auto &picture : white.data) std::fill(picture.begin(), picture.end(), 1.0f);
    assert_int_equal(white.sample(options, pairs, &error), LENSPROF_ERROR_NO_SAMPLES);
    Pictures nan(2, 80, 60, 20.0);
    nan.data[1][(7 * 80 + 5) * 3] = NAN;
    assert_int_equal(nan.sample(options, pairs, &error), LENSPROF_ERROR_NOT_FINITE);
    assert_non_null(strstr(error.text, "image 1: pixel 5, 7"));
    Pictures bad(2, 80, 60, 20.0);
    bad.images[0].reduction = 2;
    assert_int_equal(bad.sample(options, pairs, &error), LENSPROF_ERROR_SIZE);
    bad.images[0].reduction = 1, bad.images[0].white = 0.01;
    assert_int_equal(bad.sample(options, pairs, &error), LENSPROF_ERROR_ARGUMENT);
    options.reserved = 1;
    bad.images[0].white = 0.98;
    assert_int_equal(bad.sample(options, pairs, &error), LENSPROF_ERROR_ARGUMENT);
    options.reserved = 0;
    bad.images.resize(1);
    assert_int_equal(bad.sample(options, pairs, &error), LENSPROF_ERROR_ARGUMENT);
    options.struct_size = 3;
    assert_int_equal(apart.sample(options, pairs, &error), LENSPROF_ERROR_STRUCT_SIZE);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs_show_one_scene_point),
        cmocka_unit_test(test_balanced_over_pairs_radius_and_grey),
        cmocka_unit_test(test_masks_levels_and_alpha_are_kept_out),
        cmocka_unit_test(test_patches_shrug_off_hot_pixels),
        cmocka_unit_test(test_a_project_that_is_off_is_registered),
        cmocka_unit_test(test_a_wrong_angle_of_view_is_registered),
        cmocka_unit_test(test_what_moved_is_left_out),
        cmocka_unit_test(test_a_moving_thing_does_not_move_the_project),
        cmocka_unit_test(test_a_smooth_place_in_other_surroundings_is_left_out),
        cmocka_unit_test(test_a_saturated_place_is_left_out),
        cmocka_unit_test(test_a_picture_in_the_wrong_place_has_no_pairs),
        cmocka_unit_test(test_links_say_what_texture_says),
        cmocka_unit_test(test_few_lines_register_together),
        cmocka_unit_test(test_bracket_takes_what_does_not_look_alike),
        cmocka_unit_test(test_every_pixel_of_a_patch),
        cmocka_unit_test(test_same_seed_same_pairs),
        cmocka_unit_test(test_any_number_of_threads_gives_the_same_pairs),
        cmocka_unit_test(test_progress_rises_to_one),
        cmocka_unit_test(test_progress_cancels),
        cmocka_unit_test(test_sample_types_and_layouts_agree),
        cmocka_unit_test(test_refuses),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
