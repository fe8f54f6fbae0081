// The reports of `lensprof flat` for a whole lens.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "cli/program/exit_code.hpp"
#include "photo/base/output_file.hpp"
#include "photo/calibration/sensor_file.hpp"
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
    std::string lens_file_text;                // the good settings for Lensfun; empty without any
    std::string lens_file_obstacle;            // why there is no such text, or no file of it; empty: there can be
    std::vector<double> lens_file_ev;          // per setting, its error in a corner there; NAN: not in it
    std::vector<std::string> lens_file_notes;  // what is lost in it, or unknown
    std::string lens_file;                     // written of it; empty: none
    std::string sensor_file_text;              // tables at all colour temperatures; empty: not asked for, or none good
    std::string sensor_file_note;              // what they lose; empty: nothing to note

    size_t good() const;
    bool is_good_for_lensfun(size_t setting) const;  // or not in the file
};

constexpr double largest_prediction_error = 0.05;  // of the corner's illuminance
constexpr double largest_lens_file_ev = 0.1;       // in a corner, of a setting that is good for Lensfun: it is seen

// "good", why it is not so in the file for Lensfun, or why to take it again.
std::string result_text(const LensCards &cards, size_t setting);

// The lens of a missing setting, with its camera if the pictures are of several.
std::string missing_lens(const LensCards &cards, const MissingSetting &missing);

// Illuminance in the corners of the frame, with the gain grid: their mean, and its standard error.
struct Corner {
    double value, sigma;
};
Corner corner_of(const CardFit &found);

// "Canon EOS R5, RF 50mm F1.8", the parts that are known.
std::string lens_title(const lensprof_profile_key &key);

// "Canon EOS R5, RF 50mm F1.8, 50 mm, f/2", likewise.
std::string setting_title(const lensprof_profile_key &key);

// "24 pictures of 6 settings".
std::string counted_settings(const CardSettings &settings);

// Failure for a name that is neither .xml, .csv nor .json.
void check_lens_output(const std::string &output);

// What settings lack for Lensfun, and the option that states it; empty if they lack nothing.
std::string lacking_for_lensfun(const StoreOptions &store, const CardSettings &settings);

// Several cameras or lenses, which one entry of Lensfun cannot be; empty for one.
std::string several_for_lensfun(const CardSettings &settings);

// Settings that differ in more than the colour temperature, which one file of a sensor cannot hold; empty for one.
std::string several_for_sensor(const CardSettings &settings);

// Where the file for Lensfun finds cameras, and the database of Lensfun that it is added to; empty: none.
struct LensFileSource {
    std::vector<std::string> databases;
    std::string into;
};

// The bytes of a table with a row per setting.
std::string lens_csv(const LensCards &cards);

// Sets the text for Lensfun, with its notes and errors. Failure if Lensfun cannot hold a setting.
void make_lens_file(const LensFileSource &source, LensCards &cards);

// Sets the text of the good settings for libcamera, and its note.
void make_sensor_file(const SensorTables &tables, LensCards &cards);

// Adds such a file. One for Lensfun is added if there is a text and no obstacle, and becomes `lens_file`.
void add_lens_output(const std::string &path, LensCards &cards, OutputFiles &outputs);

// Failure for a name that does not end in .zip or cannot be written.
void check_bundle(const std::string &path);

// Adds a zip archive of the report, the numbers, the lens for Lensfun if any setting is good, and reduced pictures.
// Same input, same bytes.
void add_bundle(const std::string &path, LensCards cards, const std::string &command, Events &events,
                OutputFiles &outputs);

// 0, 4 if cards must be taken again or there is an obstacle to the file for Lensfun, 3 if files could not be read.
ExitCode lens_exit_code(const LensCards &cards);

// A line per setting, what is missing, and what became of the result; notes that differ in numbers only are one line.
// `database`: where profiles are stored; empty: none.
void print_lens(const LensCards &cards, const std::string &database, bool with_notes, std::ostream &out);

// The object that `flat --json` prints of several settings; docs/json.md describes the schema.
Json lens_json(const LensCards &cards);

// The bytes of the report as a web page.
std::string lens_page(const LensCards &cards, const std::string &command, const std::vector<std::string> &warnings);

}  // namespace lensprof
