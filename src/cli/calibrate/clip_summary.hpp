// What `lensprof calibrate` reports of a clip: text, JSON, the page of --report, and notices.
#pragma once

#include <cmath>
#include <iosfwd>
#include <string>
#include <vector>

#include "cli/correct/clip_output.hpp"
#include "photo/clip/clip_calibration.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

// Numbers of frames by state, and the range of their exposures.
struct ClipTally {
    size_t measured = 0, blank = 0, unlinked = 0, repeats = 0;
    uint32_t segments = 0, groups = 0;
    double low_ev = INFINITY, high_ev = -INFINITY;

    explicit ClipTally(const ClipTracks &clip);
};

// Adds warnings and notes on the frames, the given times, and what the clip does not show.
void add_clip_notices(const ClipFit &fit, const ClipTracks &clip, const ClipTally &tally, Events &notices);

// `written`: the names of all files; `levelled`: the levelled frames, or NULL.
Json clip_json(const ClipFit &fit, const ClipTracks &clip, const ClipTally &tally,
               const std::vector<std::string> &written, const ClipOutput *levelled);
void print_clip(const ClipFit &fit, const ClipTracks &clip, const ClipTally &tally,
                const std::vector<std::string> &written, const ClipOutput *levelled, std::ostream &out);

// The bytes of the page (cli/page): response, falloff, exposures of up to 200 frames, and `result`. `known_ev`: given
// exposures, relative to those of the frames; empty: none.
std::string clip_page(const ClipFit &fit, const ClipTracks &clip, const std::vector<double> &known_ev,
                      const Json &result, const std::string &command, const std::vector<std::string> &warnings);

}  // namespace lensprof
