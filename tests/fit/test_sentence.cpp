// The sentences of verdicts, composed of a code, an item and numbers.
extern "C" {
#include "support.h"
}
#undef fail

#include <set>
#include <string>
#include <vector>

#include "fit/verdict/finding.hpp"

using namespace lensprof;

namespace {

std::vector<lensprof_reason> codes() {
    std::vector<lensprof_reason> all;
    for (uint32_t code = 1; code < 1000; code++)
        if (std::string(lensprof_reason_name(code)) != "unknown") all.push_back(static_cast<lensprof_reason>(code));
    return all;
}

std::string named(const lensprof_finding &finding) {
    return std::string(finding.text).substr(finding.item.text_begin, finding.item.text_bytes);
}

lensprof_finding warning_of(lensprof_reason code, const Measured &measured, Wording wording = Wording::usual) {
    return finding_of(code, LENSPROF_SEVERITY_WARNING, measured, 0.5, wording);
}

void test_values_and_items_have_their_places(void **) {
    lensprof_finding finding = warning_of(LENSPROF_REASON_IMAGE_DISAGREES, of_image(of_values(0.1, 3.0, 40.0), 12));
    assert_string_equal(finding.text,
                        "only 3 of the 40 pairs of image 12 agree with the camera model; check its alignment");
    assert_string_equal(named(finding).c_str(), "image 12");
    assert_close(finding.measured, 0.1, 0.0);
    assert_close(finding.limit, 0.5, 0.0);
    rename_item(7, finding);
    assert_string_equal(finding.text,
                        "only 3 of the 40 pairs of image 7 agree with the camera model; check its alignment");
    assert_string_equal(named(finding).c_str(), "image 7");
    finding = warning_of(LENSPROF_REASON_FLAT_WHITE, of_shot(of_value(0.256), 4));
    assert_string_equal(finding.text, "26 % of the card in shot 4 is white in every exposure; take a shorter exposure");
    assert_string_equal(named(finding).c_str(), "shot 4");
    finding = warning_of(LENSPROF_REASON_FLAT_NOT_RADIAL, of_values(0.0123, 0.0123, 0.0004), Wording::grid);
    assert_string_equal(finding.text, "1.2 % of the light is not radial: the gain grid describes it, except for 0.0 %");
    assert_int_equal(finding.item.kind, LENSPROF_ITEM_NONE);
    finding = warning_of(LENSPROF_REASON_KNOWN_STEP, of_image(of_value(-0.5), 3), Wording::less);
    assert_non_null(strstr(finding.text, "0.5 EV lower"));
}

bool is_whole(const lensprof_finding &finding) {
    const std::string text = finding.text;
    return text.find_first_of("{}") == std::string::npos && text.size() >= 15 && text.size() < sizeof finding.text - 1
           && (finding.item.text_bytes == 0 || named(finding) == "image 4294967295");
}

// Each sentence fits its buffer, and those of different codes differ.
void test_every_code_has_a_sentence(void **) {
    std::set<std::string> of_others;
    for (lensprof_reason code : codes()) {
        std::set<std::string> own;
        for (int wording = 0; wording <= static_cast<int>(Wording::grid); wording++) {
            const lensprof_finding finding =
                warning_of(code, of_image(of_values(1.0, 0.5, 1234.5), 4294967295u), static_cast<Wording>(wording));
            if (!is_whole(finding) || of_others.count(finding.text)) assert_string_equal(finding.text, "");
            own.insert(finding.text);
        }
        of_others.insert(own.begin(), own.end());
    }
}

// Refusals come first, then warnings, notes and rules that hold.
void test_order(void **) {
    Findings findings;
    const auto with = [](lensprof_reason code, lensprof_severity severity) { return finding_of(code, severity, {}); };
    add_last(findings, with(LENSPROF_REASON_SCATTER, LENSPROF_SEVERITY_PASSED));
    add_last(findings, with(LENSPROF_REASON_FAR_CENTER, LENSPROF_SEVERITY_NOTE));
    assert_true(is_usable(findings) && first_code(findings) == LENSPROF_REASON_FAR_CENTER);
    add_last(findings, with(LENSPROF_REASON_KNOWN_ORDER, LENSPROF_SEVERITY_WARNING));
    add_first(findings, with(LENSPROF_REASON_PRIOR_OVERRULED, LENSPROF_SEVERITY_WARNING));
    assert_true(first_code(findings) == LENSPROF_REASON_PRIOR_OVERRULED);
    add_last(findings, with(LENSPROF_REASON_FEW_PAIRS, LENSPROF_SEVERITY_REFUSAL));
    add_last(findings, with(LENSPROF_REASON_FEW_GREYS, LENSPROF_SEVERITY_REFUSAL));
    const uint32_t order[] = {LENSPROF_REASON_FEW_PAIRS,   LENSPROF_REASON_FEW_GREYS,  LENSPROF_REASON_PRIOR_OVERRULED,
                              LENSPROF_REASON_KNOWN_ORDER, LENSPROF_REASON_FAR_CENTER, LENSPROF_REASON_SCATTER};
    for (size_t i = 0; i < 6; i++) assert_int_equal(findings[i].code, order[i]);
    assert_int_equal(count_findings(findings), 5);
    assert_int_equal(count_passed(findings), 1);
    assert_false(is_usable(findings) || has_code(findings, LENSPROF_REASON_SCATTER));
    assert_true(has_code(findings, LENSPROF_REASON_FEW_GREYS));
    assert_int_equal(first_code({}), LENSPROF_REASON_NONE);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_values_and_items_have_their_places),
        cmocka_unit_test(test_every_code_has_a_sentence),
        cmocka_unit_test(test_order),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
