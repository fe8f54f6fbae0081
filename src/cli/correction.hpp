/* correction.hpp - pictures corrected by a model and written: what every command that does so has in common. */
#ifndef LENSPROF_CLI_CORRECTION_HPP
#define LENSPROF_CLI_CORRECTION_HPP

#include <memory>
#include <string>
#include <vector>

#include "contact_sheet.hpp"
#include "library.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "run.hpp"

namespace lensprof {

/* What is done to one picture. */
struct Correction {
    std::string source, target;
    std::shared_ptr<const lensprof_profile> model;
    lensprof_exposure own, wanted; /* what the picture got, and what it shall look like */
    int64_t profile_id = 0;        /* 0 = the model is of no profile */
};

struct CorrectionKind {
    bool simulate = false; /* put in what would be taken out */
    bool linear = false;   /* irradiance as 32 bit float */
};

/* Geometric mean of exposures and white balances: Goldman & Chen 2005, equation 15. */
lensprof_exposure mean_exposure(const std::vector<lensprof_exposure> &exposures);

/* Failure for a picture that cannot be read (unreadable), and for an output or contact sheet (path or empty) that would
 * take the place of a picture that is corrected, of another of the `inputs` or of another output (usage): before anything
 * is written. */
void check_targets(const std::vector<Correction> &jobs, const std::vector<std::string> &inputs,
                   const std::string &sheet);

/* The folder, made where there is none. */
void make_folder(const std::string &folder);

/* Corrects and writes all pictures; `sheet` (NULL = none) receives them before and after. Returns an array of what was
 * written: file, output and, where one was used, profile. */
Json write_corrected(const std::vector<Correction> &jobs, const CorrectionKind &kind, ContactSheet *sheet,
                     Progress &progress, Streams &streams);

}  // namespace lensprof

#endif
