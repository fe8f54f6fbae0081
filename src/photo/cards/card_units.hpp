// Which unit a picture of a card is of, where many cameras of one type are calibrated.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/cards/card_pictures.hpp"
#include "photo/pictures/named_pictures.hpp"

namespace lensprof {

// A picture that is not used, such as one that no unit is known of, with the reason.
struct LeftOutCard {
    std::string file, reason;
};

// Sets the unit of each picture: `named` are the files given, to which the index of a picture refers. Removes the
// pictures that state none, and those of units whose pictures state two serial numbers, and returns them. Failure if
// the automatic choice finds no unit, or folders and serial numbers that contradict each other.
std::vector<LeftOutCard> assign_units(const UnitRule &rule, const std::vector<NamedPicture> &named,
                                      std::vector<CardPicture> &pictures, Events &events);

// A unit that has a folder, but no picture that can be used, with the reason.
struct UnitWithoutPictures {
    std::string unit, reason;
};

// Of units by their folders: those of the folders in `names` that none of the pictures is of. `left_out`: reasons.
std::vector<UnitWithoutPictures> units_without_pictures(const UnitRule &rule, const std::vector<std::string> &names,
                                                        const std::vector<CardPicture> &pictures,
                                                        const std::vector<LeftOutCard> &left_out);

// The paths of the pictures, in which the unit has no name: names of units are not names of settings ("f12").
std::vector<std::string> paths_without_units(const UnitRule &rule, const std::vector<NamedPicture> &named);

// Whether the words of a pattern have the place of the unit, {unit}.
bool is_unit_pattern(const std::string &pattern);

}  // namespace lensprof
