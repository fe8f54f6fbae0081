// `lensprof flat --units`: cameras of one type, each measured on its own pictures of a card and compared with the rest.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "cli/program/exit_code.hpp"
#include "cli/program/options.hpp"
#include "photo/cards/card_units.hpp"
#include "photo/cards/unit_batch.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

struct UnitOptions {
    std::optional<UnitRule> rule;  // empty: --units was not given
    UnitLimits limits;
    int64_t against = 0;  // the profile that they are compared with; 0: the median of the units
    bool stores_each = false;
};

struct UnitCards {
    std::vector<MeasuredSetting> settings;  // of a unit each
    std::vector<UnitBatch> batches;
    std::vector<UnitWithoutPictures> missing;
    std::vector<LeftOutCard> left_out;
    size_t given = 0;  // pictures
    UnitOptions options;

    const MeasuredSetting &setting_of(const UnitResult &unit) const { return settings[unit.setting]; }
};

void declare_units(Command &command, UnitOptions &o);

// "Canon EOS R5, RF 50mm F1.8, 50 mm, f/2".
std::string batch_title(const UnitCards &cards, const UnitBatch &batch);

// The units that do not pass come first.
std::vector<const UnitResult *> failed_first(const UnitBatch &batch);

const char *unit_verdict_name(UnitVerdict verdict);

// The bytes of a table with a row per unit and setting.
std::string units_csv(const UnitCards &cards);

// 0; 4 if a unit does not pass; 3 if pictures were left out.
ExitCode units_exit_code(const UnitCards &cards);

// A line per unit, or of more than 20 the units that do not pass. `database`: where profiles are stored; empty: none.
void print_units(const UnitCards &cards, const std::string &database, bool with_notes, std::ostream &out);

// The object that `flat --units --json` prints; docs/json.md describes the schema.
Json units_json(const UnitCards &cards);

// The bytes of the report as a web page.
std::string units_page(const UnitCards &cards, const std::string &command, const std::vector<std::string> &warnings);

}  // namespace lensprof
