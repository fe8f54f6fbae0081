// The loop over items on several threads: every item runs once, and which items are started if one fails.
#include "threads/item_loop.hpp"

#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <memory>

extern "C" {
#include <cmocka.h>
}

using namespace lensprof;

namespace {

constexpr uint32_t count = 200, threads = 16;

void test_every_item_once(void **) {
    for (const uint32_t used : {1u, 2u, threads, 2 * count}) {
        std::vector<std::atomic<int>> begun(count);
        std::atomic<uint32_t> highest{0};  // thread
        assert_true(for_each_item(count, used, [&](uint32_t item, uint32_t thread) {
            if (thread > highest) highest = thread;
            begun[item]++;
            return true;
        }));
        assert_true(highest < used);
        for (const auto &times : begun) assert_int_equal(times.load(), 1);
    }
    assert_true(for_each_item(0, threads, [](uint32_t, uint32_t) { return false; }));
}

// Items from `first` on throw their numbers. Items below it are started whatever the timing, and the lowest number is
// reported. There are so many items that all threads are at work by then.
void test_lowest_failure(void **) {
    constexpr uint32_t many = 400000;
    for (uint32_t round = 0; round < 40; round++) {
        const uint32_t first = many / 2 + 4999 * round;
        const std::unique_ptr<std::atomic<char>[]> begun(new std::atomic<char>[many]());
        uint32_t thrown = many;
        try {
            for_each_item(many, threads, [&](uint32_t item, uint32_t) -> bool {
                begun[item] = 1;
                if (item >= first) throw item;
                return true;
            });
        } catch (const uint32_t item) {
            thrown = item;
        }
        assert_int_equal(thrown, first);
        for (uint32_t item = 0; item < first; item++) assert_int_equal(begun[item].load(), 1);
    }
}

// A call that returns false ends the loop; nothing is thrown.
void test_end(void **) {
    for (int round = 0; round < 200; round++) {
        std::vector<std::atomic<int>> begun(count);
        const bool all = for_each_item(count, threads, [&](uint32_t item, uint32_t) {
            begun[item]++;
            return item != 20;
        });
        assert_false(all);
        for (uint32_t item = 0; item <= 20; item++) assert_int_equal(begun[item].load(), 1);
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_every_item_once),
        cmocka_unit_test(test_lowest_failure),
        cmocka_unit_test(test_end),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
