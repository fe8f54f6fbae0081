// The falloff of one lens setting, measured on pictures of a card.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "photo/cards/card_pictures.hpp"
#include "photo/report/falloff.hpp"
#include "photo/report/verdict.hpp"

namespace lensprof {

struct CardFit {
    std::vector<std::string> files;
    std::vector<uint32_t> shots;  // of the pictures
    std::vector<double> ev, rotated;
    std::vector<lensprof_flat_image_quality> quality;
    std::vector<lensprof_response> response;
    lensprof_profile_key key{};
    double aspect = usual_aspect;               // width over height of the pictures
    uint32_t width = 0, height = 0;             // of the frame, px
    bool is_turn_unknown = false;               // the profile lacks what differs between opposite sides
    std::shared_ptr<const lensprof_flat> held;  // NULL without a fit
    std::shared_ptr<lensprof_profile> profile;  // of it, in the frame of the sensor; NULL without a fit
    lensprof_flat_result fit{};
    Verdict verdict;                     // of it
    std::vector<bool> shows_even_light;  // per picture, of a refused fit
    double load_s = 0, solve_s = 0;
    int64_t profile_id = 0;  // 0 = not stored

    bool shows_any_even_light() const {
        return std::find(shows_even_light.begin(), shows_even_light.end(), true) != shows_even_light.end();
    }
};

// Reads the pictures and fits. Failure, with the status NOT_USABLE if the pictures do not suffice for a fit.
CardFit fit_cards(const CardOptions &o, CardInput &input, Events &events);

// The result if no fit was possible.
CardFit failed_fit(const CardInput &input, const Failure &failure);

// Stores the profile of a fit and sets its number.
void store_fit(const StoreOptions &o, CardFit &fit);

}  // namespace lensprof
