// Pictures corrected by a model and written: what every command that does so has in common.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/pictures/contact_sheet.hpp"
#include "cli/pictures/metadata.hpp"
#include "cli/profiles/lookup_report.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {

// What is done to one picture.
struct Correction {
    std::string source, target;
    std::shared_ptr<const lensprof_profile> model;
    std::shared_ptr<const lensprof_response> encoding;  // of the target; NULL = as the source's
    lensprof_exposure own{}, wanted{};                  // what the picture got, and what it shall look like
    int64_t profile_id = 0;                             // 0 = the model is of no profile
    std::shared_ptr<const Found> lookup;                // how the model was predicted; NULL = it was not
    uint64_t pixels = 0;                                // of the source
    std::string model_name;                             // for the output's mark
    std::shared_ptr<const PictureMetadata> exif;        // of the exposure, in place of the source's; NULL = its own
    std::string note;                                   // what is to be said of it; empty = nothing
    bool copies_dng = false;  // the target is the source with the falloff as an opcode, pixels untouched
};

struct CorrectionKind {
    bool simulate = false;  // put in what would be taken out
    bool linear = false;    // irradiance as 32 bit float
    double strength = 1.0;  // of the falloff's correction; as lensprof_apply_options
    double gain_cap = 0.0;
    bool dither = false;
    bool overwrite = false;   // outputs of other pictures, too
    uint32_t threads = 0;     // 0 = all cores
    uint32_t strip_rows = 0;  // rows of a picture that are worked on at once; 0 = about strip_bytes of them
};

constexpr size_t strip_bytes = size_t(1) << 20;

// What was written, and how fast.
struct Corrected {
    Json pictures = Json::array();  // file, output and, where one was used, profile or lookup
    double seconds = 0, megapixels = 0;
};

// Warns of what the written target is without: the turn of EXIF in OpenEXR, which cannot state it, and metadata.
void warn_of_written(const Correction &job, bool with_metadata, Progress &progress);

// Adds `seconds` and `megapixels_per_second` (null when nothing was written) to a command's object.
void add_speed(const Corrected &corrected, Json &json);

// The options --threads and --overwrite.
void declare_writing(Command &command, CorrectionKind &kind);

// Failure for a picture that cannot be read (unreadable), and for an output or contact sheet (path or empty) that
// would take the place of a picture that is corrected, of another of the `inputs` or of another output (usage):
// before anything is written. Sets the jobs' numbers of pixels.
void check_targets(std::vector<Correction> &jobs, const std::vector<std::string> &inputs, const std::string &sheet);

// Failure (usage) for an output that is there and was made of another picture, as its mark says, or, unless
// `replaces_unmarked` and it is in another folder than its source, not by lensprof.
void check_older_outputs(const std::vector<Correction> &jobs, const CorrectionKind &kind, bool replaces_unmarked);

// Corrects and writes all pictures; `sheet` (NULL = none) receives them before and after. Several pictures are worked
// on at once, one a thread, each in strips of rows; where there are at least twice as many threads as pictures, a
// picture is encoded on a thread of its own. Whatever the number of threads, what is written and said is as if it had
// been done one after another: the failure of the first picture that has one is thrown, those before it are written,
// it and those after it are not. Outputs are marked (CorrectionMark), and their folders made where there are none.
Corrected write_corrected(const std::vector<Correction> &jobs, const CorrectionKind &kind, ContactSheet *sheet,
                          Progress &progress);

}  // namespace lensprof
