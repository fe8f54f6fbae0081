// The reports of `lensprof flat` for a whole lens.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "cli/program/exit_code.hpp"
#include "photo/base/output_file.hpp"
#include "photo/cards/card_light.hpp"
#include "photo/cards/lens_cards.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

struct LensCards {
    std::vector<MeasuredSetting> settings;
    std::vector<MissingSetting> missing;  // by the error of their predictions
    std::vector<LeftOutCard> left_out;
    size_t given = 0;                          // pictures
    std::optional<LightCheck> light;           // what overlapping pictures show about it
    size_t light_removed = 0;                  // settings from which it was removed
    std::vector<std::string> lens_file_notes;  // what is lost in it, or unknown
    std::string lens_file;                     // written of it; empty: none

    size_t good() const;
};

constexpr double largest_prediction_error = 0.05;  // of the corner's illuminance

// "24 pictures of 6 settings".
std::string counted_settings(const CardSettings &settings);

// Failure for a name that is neither .xml nor .csv, and for .xml of several cameras or lenses, which one entry of
// Lensfun cannot be, or whose lens or crop factor is unknown.
void check_lens_output(const std::string &output, const StoreOptions &store, const CardSettings &settings);

// Where the file for Lensfun finds cameras, and the database of Lensfun that it is added to; empty: none.
struct LensFileSource {
    std::vector<std::string> databases;
    std::string into;
};

// The bytes of a table with a row per setting, and of the file for Lensfun; empty if no setting is good. Sets its
// notes.
std::string lens_csv(const LensCards &cards);
std::string lensfun_text(const LensFileSource &source, LensCards &cards);

// Adds such a file. One for Lensfun is added if any setting is good, and becomes `lens_file`.
void add_lens_output(const std::string &path, const LensFileSource &source, LensCards &cards, OutputFiles &outputs);

// Failure for a name that does not end in .zip or cannot be written.
void check_bundle(const std::string &path);

// Adds a zip archive of the report, the numbers, the lens for Lensfun if any setting is good, and reduced pictures.
// Same input, same bytes.
void add_bundle(const std::string &path, const LensFileSource &source, LensCards cards, const std::string &command,
                Events &events, OutputFiles &outputs);

// 0, 4 if cards must be taken again, 3 if files could not be read.
ExitCode lens_exit_code(const LensCards &cards);

// A line per setting, what is missing, and what became of the result. `database`: where profiles are stored; empty:
// none.
void print_lens(const LensCards &cards, const std::string &database, std::ostream &out);

// The object that `flat --json` prints of several settings; docs/json.md describes the schema.
Json lens_json(const LensCards &cards);

// The bytes of the report as a web page.
std::string lens_page(const LensCards &cards, const std::string &command, const std::vector<std::string> &warnings);

}  // namespace lensprof
