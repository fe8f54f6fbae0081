// Correcting and writing pictures: the part shared by all commands that do so.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "photo/base/events.hpp"
#include "photo/base/library.hpp"
#include "photo/correct/lookup_report.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/stated_levels.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

// The correction of a crop of a picture, such as one of two circles of fisheyes. Its model is that of the crop as a
// frame.
struct CropCorrection {
    int32_t crop[4];   // left, top, right, bottom (right and bottom exclusive) in the picture, may exceed it
    bool is_circular;  // only the circle about the middle that touches the nearer sides
    std::shared_ptr<const lensprof_profile> model;
    lensprof_exposure exposure{}, target_exposure{};
};

// The correction of one picture.
struct Correction {
    std::string source, target;
    std::shared_ptr<const lensprof_profile> model;
    std::shared_ptr<const lensprof_response> encoding;  // encoding of the target; NULL = that of the source
    lensprof_exposure exposure{}, target_exposure{};    // exposure of the picture, and the wanted one
    int64_t profile_id = 0;                             // 0 = the model is not from a profile
    std::shared_ptr<const Found> lookup;                // how the model was predicted; NULL = not predicted
    uint64_t pixels = 0;                                // number of pixels of the source
    std::string model_name;                             // for the mark in the output
    std::shared_ptr<const PictureMetadata> exif;        // EXIF of the exposure, replaces that of the source; NULL =
                                                        // keep
    std::string note;                                   // note to print; empty = none
    std::string command;                                // `apply` with what corrects it; empty = that of the user
    std::shared_ptr<const lensprof_levels> levels;      // of the samples, instead of the model's; NULL: those
    std::vector<CropCorrection> crops;                  // what is corrected; the rest is only encoded. Empty = all
    bool keeps_falloff = false;  // the grid of the model is not the lens's: the mark does not state a correction of it
    bool copies_dng = false;     // the target is a copy of the source with the falloff as an opcode, pixels unchanged
};

struct CorrectionKind {
    bool simulate = false;  // add the falloff instead of removing it
    bool linear = false;    // irradiance as 32 bit float
    double strength = 1.0;  // of the falloff correction; as in lensprof_apply_options
    double gain_cap = 0.0;
    bool chroma = false;
    StatedLevels levels;  // of the pictures, instead of the model's; without any: those
    bool dither = false;
    bool overwrite = false;   // replace even outputs of other pictures
    uint32_t threads = 0;     // 0 = all cores
    uint32_t strip_rows = 0;  // rows processed at a time; 0 = about strip_bytes
};

constexpr size_t strip_bytes = size_t(1) << 20;

// A picture that could not be corrected, and why.
struct FailedPicture {
    std::string file;
    Failure failure;
};

// What was written, and how fast.
struct Corrected {
    Json pictures = Json::array();      // file, output and, if used, profile or lookup
    std::vector<FailedPicture> failed;  // of these nothing was written
    double seconds = 0, megapixels = 0;
};

// How the picture is corrected, in a few words: "falloff by profile 3", "+0.31 EV".
std::string correction_note(const Correction &job);

// Warns of losses in the written target: the EXIF orientation in OpenEXR, which cannot store it, and metadata.
void warn_of_written(const Correction &job, bool with_metadata, Events &events);

// Adds `seconds` and `megapixels_per_second` (null if nothing was written) to a command's object.
void add_speed(const Corrected &corrected, Json &json);

// Checks before anything is written: Failure (unreadable) for a picture that cannot be read, and Failure (usage) for an
// output or contact sheet (path or empty) that would overwrite a picture being corrected, another of the `inputs` or
// another output. Sets the missing pixel counts of the jobs.
void check_targets(std::vector<Correction> &jobs, const std::vector<std::string> &inputs, const std::string &sheet);

// Failure (usage) for an existing output that was made from another picture according to its mark. An output without a
// mark is refused too, unless `replaces_unmarked` and it is in another folder than its source.
void check_older_outputs(const std::vector<Correction> &jobs, const CorrectionKind &kind, bool replaces_unmarked);

// A picture before and after correction, reduced: 8 bit RGB without gaps, rotated as stored.
struct SmallCopies {
    Picture before, after;
};

// Receives small copies of the pictures, made while they are corrected.
struct CopySink {
    uint32_t side;  // the longer one, px, or less for smaller pictures

    // Empty if the picture was not corrected. Threads: several call it, for different jobs.
    std::function<void(uint32_t job, SmallCopies small)> put;
};

// Corrects and writes all pictures; `sink` (NULL = none) receives them before and after. Several pictures are
// processed in parallel, one per thread, each in strips of rows; with at least twice as many threads as pictures,
// encoding of a picture gets its own thread. The number of threads does not affect the outputs or messages. A picture
// that cannot be read or corrected does not stop the others (`failed`). Any other failure, such as a full disk, is
// thrown: pictures before it are written, that picture and those after it are not. Outputs are marked (CorrectionMark),
// and missing folders are created.
Corrected write_corrected(const std::vector<Correction> &jobs, const CorrectionKind &kind, const CopySink *sink,
                          Events &events);

// The small copies that write_corrected gives to a sink of this side, without writing the picture. Not for a DNG.
// Failure.
SmallCopies small_copies_of(const Correction &job, const CorrectionKind &kind, uint32_t side);

}  // namespace lensprof
