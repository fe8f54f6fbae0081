// Changes maker notes as bytes, without knowledge of their fields: when a note moves, and when a copy lacks a gain map.
#pragma once

#include <cstdint>
#include <vector>

namespace lensprof {

// A note for another place. Notes of many makers are a directory whose offsets count from the start of the structure
// around the note: those that lead into the note move with it. Other notes are returned unchanged.
std::vector<uint8_t> moved_note(std::vector<uint8_t> note, uint64_t from, uint64_t to);

// Removes HDRHeadroom and HDRGain from a note of Apple. False if the note has neither.
bool remove_gain_map_entries(std::vector<uint8_t> &note);

}  // namespace lensprof
