// `lensprof flat --fields`: the shading of many pictures of different scenes.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "cli/program/run.hpp"
#include "photo/fields/field_fit.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

struct FieldsCommand {
    std::vector<std::string> files, outputs;  // outputs: pictures of the shading
    std::vector<std::string> dark_files;      // pictures without light
    std::string report;                       // .html; empty: none
    bool json = false, progress = false;
    FieldOptions fit;
};

// Fits, stores and prints; returns the exit code.
int fit_fields_command(FieldsCommand o, Streams &streams);

// The object that --json prints; docs/json.md describes the schema.
Json fields_json(const FieldFit &found);

void print_fields(const FieldFit &found, std::ostream &out);

// The bytes of the report as a web page.
std::string fields_page(const FieldFit &found, const std::string &title, const std::string &command,
                        const std::vector<std::string> &warnings);

}  // namespace lensprof
