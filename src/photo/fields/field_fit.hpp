// The shading that many pictures of different scenes have in common.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/fields.h>

#include "photo/calibration/profile_store.hpp"
#include "photo/cards/dark_frames.hpp"
#include "photo/fields/field_list.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/stated_levels.hpp"
#include "photo/report/verdict.hpp"

namespace lensprof {

struct FieldOptions {
    StoreOptions store;
    int64_t profile = 0;            // whose response the pictures have; 0: none
    std::optional<double> gamma;    // of the response x^(1/gamma)
    StatedLevels levels;            // of the samples; no black level: it is estimated
    std::optional<DarkLevel> dark;  // instead of a stated black level
    uint32_t channel = 0;           // of stacks with several, counted from 1; 0: not given
    bool linear = false;            // stated by the user
};

struct FieldFit {
    std::vector<std::string> names;             // of the pictures read
    std::vector<lensprof_fields_image> images;  // of each
    std::vector<std::string> left_out;          // messages that name files and pages
    FieldPage first;                            // of the pictures read
    size_t files = 0;
    uint32_t width = 0, height = 0;  // px
    bool is_black_given = false;
    double full_scale = 1.0;                  // largest sample of the files; 1 for float samples
    std::vector<lensprof_response> response;  // one or three
    lensprof_profile_key key{};
    std::shared_ptr<const lensprof_fields> held;
    lensprof_fields_result fit{};
    Verdict verdict;
    std::shared_ptr<lensprof_profile> profile;  // in the frame of the sensor
    double load_s = 0, solve_s = 0;
    int64_t profile_id = 0;  // 0 = not stored
};

// Reads the pictures and fits. Pictures that cannot be read are left out. Failure if the others differ in size or kind,
// or show no light.
FieldFit fit_fields_of(const std::vector<std::string> &names, const FieldOptions &o, Events &events);

// Stores the profile of a fit and sets its number.
void store_fields(const StoreOptions &o, FieldFit &fit);

// The shading of the whole frame, 1 in its middle: float, grey or RGB.
Picture shading_picture(const FieldFit &fit);

}  // namespace lensprof
