// Point files of vig_optimize: one correspondence a line, 16 numbers.
#include <algorithm>
#include <cmath>

#include <lensprof/hugin.h>

#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr size_t kColumns = 16;
constexpr double kMaxImage = 4294967294.0;
constexpr double kOvershoot = 0.25;  // vig_optimize interpolates with a cubic, which rings beyond 0..1 at edges
// image1 image2 x1 y1 x2 y2 R1 G1 B1 R2 G2 B2 0 r1 r2 0
constexpr const char *kColumnNames[kColumns] = {"image1", "image2", "x1", "y1", "x2", "y2",      "R1",      "G1",
                                                "B1",     "R2",     "G2", "B2", "0",  "radius1", "radius2", "0"};

[[noreturn]] void fail_at_column(size_t number, size_t column, const std::string &text) {
    fail_at_line(number, "column " + std::to_string(column + 1) + " (" + kColumnNames[column] + ") " + text);
}

lensprof_pair read_pair(std::string_view line, size_t number) {
    double column[kColumns];
    std::string_view rest = line;
    for (size_t i = 0; i < kColumns; i++) {
        std::string_view word = next_word(rest);
        if (word.empty()) fail_at_column(number, i, "is missing; a line of a point file has 16 numbers");
        if (!read_number(word, column[i]))
            fail_at_column(number, i, "is " + in_quotes(word) + ", not a finite number; correct or delete the line");
        if (i < 2 && !read_whole(word, 0, kMaxImage, column[i]))
            fail_at_column(number, i, "is " + in_quotes(word) + ", not an image number; count images from 0");
        if (i >= 6 && i < 12 && !(column[i] >= -kOvershoot && column[i] <= 1 + kOvershoot))
            fail_at_column(number, i, "is " + in_quotes(word) + ", not within 0..1; scale grey values to 1");
    }
    if (!next_word(rest).empty()) fail_at_line(number, "more than 16 numbers; a line of a point file has 16 numbers");
    if (column[0] == column[1])
        fail_at_line(number, "both points are in image " + number_text(column[0]) + "; a pair needs two images");
    lensprof_pair pair;
    for (size_t side = 0; side < 2; side++) {
        pair.image[side] = static_cast<uint32_t>(column[side]);
        for (size_t i = 0; i < 2; i++) pair.xy[side][i] = column[2 + 2 * side + i];
        for (size_t c = 0; c < 3; c++) pair.value[side][c] = std::clamp(column[6 + 3 * side + c], 0.0, 1.0);
    }
    return pair;
}

// Calls use(pair, index) for every pair of the text and returns their number.
template <typename Use>
uint32_t walk_pairs(std::string_view text, Use use) {
    LineReader reader(text);
    uint32_t count = 0;
    while (reader.next()) {
        std::string_view rest = reader.line;
        if (next_word(rest).empty()) continue;
        if (count == UINT32_MAX) fail_at_line(reader.number, "too many pairs; split the file", LENSPROF_ERROR_SIZE);
        use(read_pair(reader.line, reader.number), count++);
    }
    return count;
}

bool is_finite(const lensprof_pair &pair) {
    double sum = 0.0;  // of values times zero: NaN as soon as one is not finite
    for (int side = 0; side < 2; side++) {
        for (double v : pair.xy[side]) sum += 0.0 * v;
        for (double v : pair.value[side]) sum += 0.0 * v;
    }
    return sum == 0.0;
}

void check_pairs(const lensprof_pair *pairs, uint32_t pair_count, const lensprof_camera *cameras,
                 uint32_t camera_count) {
    for (uint32_t i = 0; i < pair_count; i++) {
        const std::string item = "pair " + std::to_string(i) + ": ";
        if (pairs[i].image[0] >= camera_count || pairs[i].image[1] >= camera_count)
            throw FormatFailure{LENSPROF_ERROR_ARGUMENT, item + "its image has no camera; give one per image"};
        if (!is_finite(pairs[i]))
            throw FormatFailure{LENSPROF_ERROR_NOT_FINITE,
                                item + "it has a number that is not finite; leave the pair out"};
    }
    for (uint32_t i = 0; i < camera_count; i++)
        if (!cameras[i].width || !cameras[i].height)
            throw FormatFailure{LENSPROF_ERROR_SIZE,
                                "camera " + std::to_string(i) + ": its frame has no pixels; set width and height"};
}

void append_pair(std::string &text, const lensprof_pair &pair, const lensprof_camera *cameras) {
    double column[kColumns] = {};
    const lensprof_vignetting centred = {};
    for (size_t side = 0; side < 2; side++) {
        const lensprof_camera &camera = cameras[pair.image[side]];
        column[side] = pair.image[side];
        for (size_t i = 0; i < 2; i++) column[2 + 2 * side + i] = pair.xy[side][i];
        for (size_t c = 0; c < 3; c++) column[6 + 3 * side + c] = pair.value[side][c];
        column[13 + side] = std::sqrt(
            lensprof_vignetting_r2(&centred, camera.width, camera.height, pair.xy[side][0], pair.xy[side][1], nullptr));
    }
    for (size_t i = 0; i < kColumns; i++) text += number_text(column[i]) + (i + 1 < kColumns ? ' ' : '\n');
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lensprof_points_read(const void *data, size_t size, lensprof_pair *pairs, uint32_t capacity,
                                     uint32_t *count, lensprof_error *error) {
    if ((!data && size) || !count || (!pairs && capacity)) {
        set_error(error, "lensprof_points_read: data, pairs or count is NULL; pass a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        const std::string_view all = view_of(data, size);
        *count = walk_pairs(all, [](const lensprof_pair &, uint32_t) {});  // all lines are checked first
        if (!capacity) return;
        if (*count > capacity)
            throw FormatFailure{LENSPROF_ERROR_CAPACITY, std::to_string(*count) + " pairs do not fit the buffer of "
                                                             + std::to_string(capacity) + "; pass a larger one"};
        walk_pairs(all, [&](const lensprof_pair &pair, uint32_t i) { pairs[i] = pair; });
    });
}

lensprof_status lensprof_points_write(const lensprof_pair *pairs, uint32_t pair_count, const lensprof_camera *cameras,
                                      uint32_t camera_count, void *data, size_t capacity, size_t *count,
                                      lensprof_error *error) {
    if ((!pairs && pair_count) || (!cameras && camera_count) || (!data && capacity)) {
        set_error(error, "lensprof_points_write: pairs, cameras or data is NULL; pass buffers");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] {
        check_pairs(pairs, pair_count, cameras, camera_count);
        std::string all;
        for (uint32_t i = 0; i < pair_count; i++) append_pair(all, pairs[i], cameras);
        return all;
    });
}
