// The sentences of verdicts, composed of a code, an item and numbers.
extern "C" {
#include "support.h"
}
#undef fail

#include <set>
#include <string>
#include <vector>

#include "fit/verdict/reason.hpp"

using namespace lensprof;

namespace {

std::vector<lensprof_reason> codes() {
    std::vector<lensprof_reason> all;
    for (uint32_t code = 1; code < 1000; code++)
        if (std::string(lensprof_reason_name(code)) != "unknown") all.push_back(static_cast<lensprof_reason>(code));
    return all;
}

std::string named(const Sentence &sentence) {
    return sentence.text.substr(sentence.item.text_begin, sentence.item.text_bytes);
}

void test_values_and_items_have_their_places(void **) {
    Sentence sentence = sentence_of(of_image(LENSPROF_REASON_IMAGE_DISAGREES, 12, {3.0, 40.0}));
    assert_string_equal(sentence.text.c_str(),
                        "only 3 of the 40 pairs of image 12 agree with the camera model; check its alignment");
    assert_string_equal(named(sentence).c_str(), "image 12");
    sentence = sentence_of(of_shot(LENSPROF_REASON_FLAT_WHITE, 4, {0.256}));
    assert_string_equal(sentence.text.c_str(),
                        "26 % of the card in shot 4 is white in every exposure; take a shorter exposure");
    assert_string_equal(named(sentence).c_str(), "shot 4");
    sentence = sentence_of({LENSPROF_REASON_FLAT_NOT_RADIAL_GRID, {0.0123, 0.0004}});
    assert_string_equal(sentence.text.c_str(),
                        "1.2 % of the light is not radial: the gain grid describes it, except for 0.0 %");
    assert_int_equal(sentence.item.kind, LENSPROF_ITEM_NONE);
    assert_string_equal(sentence_of({LENSPROF_REASON_NONE, {}}).text.c_str(), "");
}

bool is_whole(const Sentence &sentence) {
    return sentence.text.find_first_of("{}") == std::string::npos && sentence.text.size() >= 15
           && sentence.text.size() <= 255 && (sentence.item.text_bytes == 0 || named(sentence) == "image 4294967295");
}

// Each sentence fits its buffer in the results and differs from all others.
void test_every_code_has_a_sentence(void **) {
    std::set<std::string> seen;
    for (lensprof_reason code : codes()) {
        const Sentence sentence = sentence_of(of_image(code, 4294967295u, {0.5, 1234.5}));
        const bool good = is_whole(sentence) && seen.insert(sentence.text).second;
        if (!good) print_error("%d: %s\n", code, sentence.text.c_str());
        assert_true(good);
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_values_and_items_have_their_places),
        cmocka_unit_test(test_every_code_has_a_sentence),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
