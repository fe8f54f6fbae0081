// What the caller can do about the findings of a fit of cards, as the rest of their texts.
#pragma once

#include <string>

#include "photo/cards/card_fit.hpp"

namespace lensprof {

// Names pictures that do not belong to the cards, and the options that state what the pictures do not show.
void add_advice(const CardOptions &o, const CardInput &input, CardFit &found, Events &events);

// The same for pictures that do not suffice for a fit; empty without advice.
std::string advice_without_fit(const CardOptions &o, const CardInput &input);

// Failure if a file in a folder of dark frames is as dark as these: a shell that expands "dark/*.tif" gives one file to
// the option, and the others as cards.
void refuse_dark_cards(const std::vector<std::string> &files, const CardOptions &o, const DarkLevel &dark);

// Whether the name of a file is that of a dark frame: dark.tif, bias_02.tif, cap.tif.
bool has_dark_name(const std::string &file);

}  // namespace lensprof
