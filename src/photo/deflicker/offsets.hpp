// The exposures of levelled frames for raw converters: settings next to the frames, and tables.
#pragma once

#include <string>
#include <vector>

#include "photo/deflicker/corrections.hpp"

namespace lensprof {

enum class OffsetFormat {
    xmp,  // NAME.xmp with crs:Exposure2012, which Lightroom, Camera Raw and darktable read
    pp3   // NAME.EXT.pp3 with the exposure compensation of RawTherapee
};

// The settings file of a frame, next to it, or in `folder` unless that is empty.
std::string offset_file(const std::string &frame, OffsetFormat format, const std::string &folder);

// Text of the settings: those in `existing` (the text of a file; empty: none) with this offset. An offset that an
// earlier run has added is replaced, one that the user has set is kept below it. Failure (unreadable) with `file` for a
// text of another kind.
std::string xmp_with_offset(const std::string &existing, double offset_ev, const std::string &file);
std::string pp3_with_offset(const std::string &existing, double offset_ev, const std::string &file);

// Writes the settings files of all levelled frames, all or none of them. Returns their names.
std::vector<std::string> write_offsets(const std::vector<LevelledFrame> &frames, OffsetFormat format,
                                       const std::string &folder);

// A table: file, seconds, state, exposure before and after, correction, colours, error, clipped share.
std::string offset_table(const std::vector<LevelledFrame> &frames);

// Whether a file is such a table, by its first line.
bool is_offset_table(const std::string &path);

// The wanted EV of each frame from a table: one number per frame, or lines "file,ev"; a heading and comments with # are
// skipped. Failure (unreadable) with the line.
std::vector<double> read_curve(const std::string &path, const FrameSequence &sequence);

// The name of a state in tables and JSON.
const char *state_name(uint32_t state);

}  // namespace lensprof
