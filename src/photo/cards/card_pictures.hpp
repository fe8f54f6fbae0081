// Pictures of a white card or another even light, at one setting of a lens: the input of a fit of its falloff.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/flat.h>

#include "photo/calibration/profile_store.hpp"
#include "photo/cards/dark_frames.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/stated_levels.hpp"

namespace lensprof {

// Where pictures state the unit that they are of.
struct UnitRule {
    enum class By {
        automatic,
        folder,
        serial,
        name
    } by = By::automatic;
    std::string pattern;  // of names: {unit} is the unit, * and ? as in file names
};

// How cards are measured. Vectors per picture, shot or card are empty, or as long as the pictures require.
struct CardOptions {
    StoreOptions store;
    std::vector<std::array<double, 4>> cards;  // x, y, width and height, px of the frame
    std::vector<uint32_t> shots;
    std::vector<double> ev, rotation_deg;
    uint32_t falloff_curves = 0, light = LENSPROF_FLAT_LIGHT_AUTO, grid = LENSPROF_FLAT_GRID_AUTO;
    bool free_center = true, linear = false, several = false, find_card = false, own_light = false,
         turned = false;          // the camera was rotated between the shots, as the orientation of EXIF states
    int64_t profile = 0;          // whose response the pictures have; 0: none
    std::optional<double> gamma;  // of the response x^(1/gamma)
    double ev_sigma = 0.02;
    std::optional<double> ignore_below;   // grey values, 0..1; by default 2/255, less if the black level is known
    double ignore_above = 250.0 / 255.0;  // grey values, 0..1
    StatedLevels levels;                  // of the samples
    std::vector<std::string> dark_files;  // with the lens covered; they are not cards
    std::optional<DarkLevel> dark;        // of them, instead of a stated black level
    uint32_t max_side = 1600;
    uint32_t threads = 0;           // of one fit; 0: all cores
    std::optional<UnitRule> units;  // each unit is measured alone; empty: the pictures are of one
};

struct CardPicture {
    std::string file;
    PictureMetadata metadata;  // its key completed by names and table
    size_t index = 0;          // of the pictures given, of which lists of options have a value each
    std::string unit = {};     // that it is of, where units are measured alone
};

// All inputs of the library call, and the memory they refer to.
struct CardInput {
    std::vector<std::string> files;
    std::vector<Picture> pictures;
    std::vector<std::vector<uint8_t>> masks;  // per picture; empty = the whole picture
    std::vector<lensprof_flat_image> images;
    std::vector<lensprof_response> response;  // one or three
    StatedLevels levels;                      // that the first picture states
    lensprof_profile_key key;                 // from EXIF of the first picture
    lensprof_flat_options options;
};

constexpr uint32_t least_card_side = 64;  // px

// Determines everything that needs no pixels: shots, exposures, rotations, response and key. Failure if something is
// missing, and for counts that do not match the number of pictures.
CardInput prepare_cards(const CardOptions &o, const std::vector<CardPicture> &pictures, Events &events);

// Reads the pictures and completes images and options.
void read_cards(const CardOptions &o, CardInput &input, Events &events);

}  // namespace lensprof
