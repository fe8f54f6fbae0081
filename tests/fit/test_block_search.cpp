// Correlations of a block with all blocks around a place, against the definition in double precision.
#include "fit/sampling/block_search.hpp"

#include <random>

extern "C" {
#include "support.h"
}

using namespace lensprof;

namespace {

constexpr int kWidth = 70, kHeight = 60, kReach = 4;
constexpr double kPixel = 4.0;  // px of the full frame
constexpr double kRotated[2][2] = {{0.9531, -0.1973}, {0.1517, 1.0479}};

GreyLevels::Level random_level(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> grey(0.1f, 0.9f);
    GreyLevels::Level level{kWidth, kHeight, kPixel, std::vector<float>(kWidth * kHeight)};
    for (float &value : level.grey) value = grey(random);
    return level;
}

// Whether the square about column u and row v, rotated by kRotated, is in the level; its values.
bool read_square(const GreyLevels::Level &level, double u, double v, std::vector<double> &values) {
    values.clear();
    for (int b = -kReach; b <= kReach; b++)
        for (int a = -kReach; a <= kReach; a++) {
            const double column = std::floor(u + kRotated[0][0] * a + kRotated[0][1] * b);
            const double row = std::floor(v + kRotated[1][0] * a + kRotated[1][1] * b);
            if (!(column >= 0 && row >= 0 && column < kWidth && row < kHeight)) return false;
            values.push_back(level.grey[static_cast<size_t>(row * kWidth + column)]);
        }
    return true;
}

double product(const std::vector<double> &a, const std::vector<double> &b) {
    double sum = 0.0;
    for (size_t k = 0; k < a.size(); k++) sum += a[k] * b[k];
    return sum;
}

// Without the plane that fits best.
std::vector<double> less_plane(std::vector<double> values) {
    std::vector<double> ones(values.size(), 1.0), across, down;
    for (int b = -kReach; b <= kReach; b++)
        for (int a = -kReach; a <= kReach; a++) across.push_back(a), down.push_back(b);
    for (const auto &direction : {ones, across, down}) {  // orthogonal
        const double share = product(values, direction) / product(direction, direction);
        for (size_t k = 0; k < values.size(); k++) values[k] -= share * direction[k];
    }
    return values;
}

// Of the values that are neither black nor saturated in both.
double plain_correlation(const std::vector<double> &first, const std::vector<double> &second) {
    std::vector<double> a, b;
    for (size_t k = 0; k < first.size(); k++)
        if (!is_lost_grey(static_cast<float>(first[k])) && !is_lost_grey(static_cast<float>(second[k])))
            a.push_back(first[k]), b.push_back(second[k]);
    const std::vector<double> ones(a.size(), 1.0);
    for (auto *values : {&a, &b}) {
        const double mean = product(*values, ones) / static_cast<double>(ones.size());
        for (double &value : *values) value -= mean;
    }
    return product(a, b) / std::sqrt(product(a, a) * product(b, b));
}

bool has_lost(const std::vector<double> &values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return is_lost_grey(static_cast<float>(v)); });
}

// Counts the shifts whose square is outside, and those with lost pixels.
void compare(const GreyLevels::Level &level, double u, double v, const Shifts &shifts, size_t &outside, size_t &lost) {
    const GreyLevels::Level other = random_level(7);
    Block<kReach> block;
    std::vector<double> own, values;
    assert_true(block.cut_flat(other, 30 * kPixel, 30 * kPixel, kPixel, kRotated));
    assert_true(read_square(other, 30 + 0.5 / kPixel, 30 + 0.5 / kPixel, own));
    const Sight sight{
        u * kPixel - 0.5, v * kPixel - 0.5, {{kRotated[0][0], kRotated[0][1]}, {kRotated[1][0], kRotated[1][1]}}};
    const std::vector<double> found = correlations_around(block, level, sight, kPixel, shifts);
    assert_int_equal(found.size(), shifts.count());
    for (size_t k = 0; k < found.size(); k++) {
        const auto [du, dv] = shifts.at(k);
        if (!read_square(level, u + du, v + dv, values)) {
            assert_true(found[k] == kOutside);
            outside++;
            continue;
        }
        lost += has_lost(values);
        const std::vector<double> a = less_plane(own), b = less_plane(values);
        const double expected = has_lost(values) ? plain_correlation(own, values)
                                                 : product(a, b) / std::sqrt(product(a, a) * product(b, b));
        assert_close(found[k], expected, 2e-6);
    }
}

void test_every_shift(void **) {
    const GreyLevels::Level level = random_level(3);
    size_t outside = 0, lost = 0;
    compare(level, 35.3137, 30.7091, {{0, 0}, 3, 1}, outside, lost);
    compare(level, 35.3137, 30.7091, {{2, -5}, 12, 1}, outside, lost);
    compare(level, 35.3137, 30.7091, {{-1, 4}, 12, 2}, outside, lost);
    assert_int_equal(outside + lost, 0);
}

void test_the_frame_ends(void **) {
    const GreyLevels::Level level = random_level(4);
    size_t outside = 0, lost = 0;
    for (const double u : {-3.4137, 3.2719, 69.5093, 80.0711, -1e6, 1e300, std::nan("")})
        compare(level, u, 57.1391, {{0, 0}, 12, 1}, outside, lost);
    assert_true(outside > 4000 && outside < 7 * 625);
}

void test_black_and_white_do_not_count(void **) {
    GreyLevels::Level level = random_level(5);
    for (size_t k = 0; k < level.grey.size(); k += 97) level.grey[k] = k % 2 ? 0.0f : 1.0f;
    size_t outside = 0, lost = 0;
    compare(level, 35.3137, 30.7091, {{0, 0}, 12, 1}, outside, lost);
    assert_true(lost > 100 && lost < 625);
}

// Without texture there is nothing to compare.
void test_an_even_area(void **) {
    GreyLevels::Level level = random_level(6);
    std::fill(level.grey.begin(), level.grey.end(), 0.5f);
    Block<kReach> block;
    assert_true(block.cut_flat(random_level(7), 120, 120, kPixel, kUpright));
    const Sight sight{140, 120, {{1.0, 0.0}, {0.0, 1.0}}};
    for (const double correlation : correlations_around(block, level, sight, kPixel, {{0, 0}, 3, 1}))
        assert_true(correlation == 0.0);
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_shift),
        cmocka_unit_test(test_the_frame_ends),
        cmocka_unit_test(test_black_and_white_do_not_count),
        cmocka_unit_test(test_an_even_area),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
