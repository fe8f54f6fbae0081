// The verdict on fields: all rules, the most important first within a severity, with their limits.
#pragma once

#include "fit/fields/fit.hpp"
#include "fit/verdict/rule.hpp"

namespace lensprof {

namespace fields_limits {

// Pictures that differ. Three: with two, content that both share cannot be seen to be content. Eight: below it the
// error that the groups of pictures state is itself uncertain by a quarter.
constexpr double kFewest = 3.0, kFew = 8.0;

// Share of the variance of a cell that is fine detail which all pictures have in common: above a half they show one
// scene, if it is at least 4 % of the light. Shadings with a ring or step of 6 to 8 % of the light have 1 % (the made
// fields of tests/bench).
constexpr double kOneScene = 0.5, kSceneDetail = 0.04, kDetail = 0.02;

// Standard error of the shading, share of the light.
constexpr double kUncertain = 0.1, kDoubtful = 0.02;

constexpr double kMuchWhite = 0.5, kSomeWhite = 0.01;    // of the cells
constexpr double kMuchUnseen = 0.2, kSomeUnseen = 0.01;  // of the cells

}  // namespace fields_limits

struct JudgedFields {
    const FieldsFit &fit;
    const lensprof_fields_result &r;
    uint32_t state = 0;
    Wording wording = Wording::usual;
};

using FieldsRule = VerdictRule<JudgedFields>;

// States of a result.
constexpr uint32_t kOfFields = 0, kIsFitted = 1, kHasOpenOffset = 2;  // that no picture and no option determines

namespace measure {

Measured fields_that_differ(const JudgedFields &judged);
Measured fields_repeated(const JudgedFields &judged);
Measured fields_pattern(const JudgedFields &judged);
Measured fields_scene(const JudgedFields &judged);
Measured fields_error(const JudgedFields &judged);
Measured fields_offset(const JudgedFields &judged);
Measured fields_white(const JudgedFields &judged);
Measured fields_left_out(const JudgedFields &judged);
Measured fields_black(const JudgedFields &judged);
Measured fields_unseen(const JudgedFields &judged);
Measured fields_gain(const JudgedFields &judged);

}  // namespace measure

// clang-format off
constexpr FieldsRule kFieldsRules[] = {
    {LENSPROF_REASON_FIELDS_FEW,       kRefuses, kOfFields, measure::fields_that_differ, Side::below, fields_limits::kFewest,     Wording::usual},
    {LENSPROF_REASON_FIELDS_PATTERN,   kRefuses, kIsFitted, measure::fields_scene,       Side::above, fields_limits::kOneScene,   Wording::usual},
    {LENSPROF_REASON_FIELDS_UNSEEN,    kRefuses, kIsFitted, measure::fields_unseen,      Side::above, fields_limits::kMuchUnseen, Wording::usual},
    {LENSPROF_REASON_FIELDS_UNCERTAIN, kRefuses, kIsFitted|kHasOpenOffset, measure::fields_error, Side::above, fields_limits::kUncertain, Wording::alone},
    {LENSPROF_REASON_FIELDS_UNCERTAIN, kRefuses, kIsFitted, measure::fields_error,       Side::above, fields_limits::kUncertain,  Wording::usual},
    {LENSPROF_REASON_FIELDS_UNCERTAIN, kWarns,   kIsFitted|kHasOpenOffset, measure::fields_error, Side::above, fields_limits::kDoubtful,  Wording::alone},
    {LENSPROF_REASON_FIELDS_UNCERTAIN, kWarns,   kIsFitted, measure::fields_error,       Side::above, fields_limits::kDoubtful,   Wording::usual},
    {LENSPROF_REASON_FIELDS_WHITE,     kWarns,   kIsFitted, measure::fields_white,       Side::above, fields_limits::kMuchWhite,  Wording::usual},
    {LENSPROF_REASON_FIELDS_UNSEEN,    kWarns,   kIsFitted, measure::fields_unseen,      Side::above, fields_limits::kSomeUnseen, Wording::weak},
    {LENSPROF_REASON_FIELDS_FEW,       kNotes,   kIsFitted, measure::fields_that_differ, Side::below, fields_limits::kFew,        Wording::weak},
    {LENSPROF_REASON_FIELDS_PATTERN,   kNotes,   kIsFitted, measure::fields_pattern,     Side::above, fields_limits::kDetail,    Wording::weak},
    {LENSPROF_REASON_FIELDS_OFFSET,    kNotes,   kIsFitted, measure::fields_offset,      Side::above, 0.0,                        Wording::usual},
    {LENSPROF_REASON_FIELDS_GAIN,      kNotes,   kIsFitted, measure::fields_gain,        Side::below, 1.0,                        Wording::usual},
    {LENSPROF_REASON_FIELDS_REPEATED,  kNotes,   kOfFields, measure::fields_repeated,    Side::above, 0.0,                        Wording::usual},
    {LENSPROF_REASON_FIELDS_BLACK,     kNotes,   kOfFields, measure::fields_black,       Side::above, 0.0,                        Wording::usual},
    {LENSPROF_REASON_FIELDS_WHITE,     kNotes,   kOfFields, measure::fields_left_out,    Side::above, 0.0,                        Wording::alone},
    {LENSPROF_REASON_FIELDS_WHITE,     kNotes,   kIsFitted, measure::fields_white,       Side::above, fields_limits::kSomeWhite,  Wording::weak},
};
// clang-format on

}  // namespace lensprof
