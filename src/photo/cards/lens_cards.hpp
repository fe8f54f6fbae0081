// A lens measured on cards: all settings, and those that are missing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photo/cards/card_fit.hpp"
#include "photo/cards/card_settings.hpp"

namespace lensprof {

struct MeasuredSetting {
    CardSetting of;
    std::optional<CardFit> fit;            // empty: no fit was possible
    std::string refusal;                   // why the cards must be taken again; empty: the result is usable
    lensprof_status status = LENSPROF_OK;  // of the failure, if no fit was possible
    NoticeList notices;

    bool is_good() const { return refusal.empty(); }
};

// Measures every setting with its own part of the options, several at a time. The result does not depend on the number
// of threads. A setting that fails does not stop the others; if all fail because of the options, that is a Failure.
std::vector<MeasuredSetting> measure_settings(const CardOptions &o, const CardSettings &settings, uint32_t threads,
                                              Events &events);

// Stores the profiles of usable settings, or of all if forced.
void store_settings(const StoreOptions &o, std::vector<MeasuredSetting> &settings);

// A setting that is to be photographed, too.
struct MissingSetting {
    std::string camera, lens;
    double focal_mm, aperture;
    double sigma;  // standard error of the predicted falloff in the corner; NAN: nothing is near enough to predict it
};

// The settings of each lens whose falloff is predicted from the measured ones with an error above `limit`: shortest,
// longest and middle focal length, and at each the widest aperture, one, two and three stops from it, and the smallest
// (f/16 if EXIF and the measured ones do not reach it). Chosen one by one: each is taken as measured for the next.
std::vector<MissingSetting> missing_settings(const std::vector<MeasuredSetting> &settings, double limit);

}  // namespace lensprof
