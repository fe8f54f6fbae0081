// Quantiles of unordered values, against sorted ones.
#include "fit/base/quantile.hpp"

#include <random>

extern "C" {
#include "support.h"
}

using namespace lensprof;

namespace {

// The value at every place is that of the sorted values, whatever the order and however often they repeat.
void test_select(void **) {
    std::mt19937 random(7);
    for (const size_t count : {1, 2, 3, 4, 7, 60, 333})
        for (const int different : {1, 2, 5, 1000})
            for (int order = 0; order < 3; order++) {
                std::vector<float> values(count);
                for (float &value : values) value = static_cast<float>(static_cast<int>(random()) % different);
                std::vector<float> sorted = values;
                std::sort(sorted.begin(), sorted.end());
                if (order > 0) values = sorted;
                if (order > 1) std::reverse(values.begin(), values.end());
                for (size_t place = 0; place < count; place++) {
                    std::vector<float> some = values;
                    assert_true(select(some.data(), count, place) == sorted[place]);
                    std::sort(some.begin(), some.end());
                    assert_true(some == sorted);
                }
            }
}

// What few rounds do not sort out is left to the standard library.
void test_few_rounds(void **) {
    std::mt19937 random(3);
    std::vector<double> values(1000);
    for (double &value : values) value = static_cast<double>(random());
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (int rounds = 0; rounds < 5; rounds++)
        for (const size_t place : {size_t{0}, size_t{333}, size_t{999}}) {
            std::vector<double> some = values;
            assert_true(select(some.data(), some.size(), place, rounds) == sorted[place]);
        }
    std::vector<double> some = values;
    assert_true(quantile(some, 0.3) == sorted[299]);
    assert_true(upper_median(values) == sorted[500]);
}

void test_no_values(void **) {
    std::vector<double> none;
    assert_true(quantile(none, 0.5) == 0.0);
    assert_true(upper_median(none) == 0.0);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_select),
        cmocka_unit_test(test_few_rounds),
        cmocka_unit_test(test_no_values),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
