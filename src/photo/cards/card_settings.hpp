// Which pictures of cards are of which lens setting.
#pragma once

#include <string>
#include <vector>

#include "photo/cards/card_pictures.hpp"
#include "photo/cards/card_units.hpp"
#include "photo/cards/setting_table.hpp"

namespace lensprof {

// Pictures of one camera, lens, focal length, aperture and distance.
struct CardSetting {
    lensprof_profile_key key{};  // of the picture whose numbers are rounded least
    std::vector<CardPicture> pictures;
    std::string label;      // "24 mm, f/2.8"
    std::string unit = {};  // where units are measured alone
    size_t group = 0;       // number of the setting, which several units share
};

struct CardSettings {
    std::vector<CardSetting> list;  // by camera, lens, focal length, aperture and distance
    std::vector<LeftOutCard> left_out;
    size_t given = 0;  // pictures
    bool has_folders = false;
    std::vector<UnitWithoutPictures> missing_units;
};

// "2850 K"; empty if it is unknown.
std::string temperature_text(const lensprof_profile_key &key);

// Where units are measured alone, each has settings of its own. Finds the settings of pictures and folders of them,
// whatever their order: by EXIF, completed by names, replaced by `table` (NULL: none) and by what `o` states for all.
// Left out, with the reason: files that cannot be read; of folders, copies of other pictures and those whose falloff
// the camera corrected; and, of several settings, pictures that state neither focal length nor aperture. Failure if
// nothing is left.
CardSettings card_settings(const std::vector<std::string> &names, const CardOptions &o, SettingTable *table,
                           Events &events);

}  // namespace lensprof
