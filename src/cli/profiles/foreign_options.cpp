#include "cli/profiles/foreign_options.hpp"

#include <cstdio>

#include <CLI/CLI.hpp>

#include "cli/program/options.hpp"
#include "cli/program/run.hpp"

namespace lensprof {
namespace {

// "WIDTHxHEIGHT" in both numbers; a text for people where it is none.
std::string read_size(const std::string &text, uint32_t &width, uint32_t &height) {
    unsigned w = 0, h = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%7ux%7u%c", &w, &h, &rest) != 2 || w < 2 || h < 2 || w > 1000000 || h > 1000000)
        return "give WIDTHxHEIGHT, 2 to 1000000 each";
    width = w, height = h;
    return "";
}

uint32_t curve_of(const std::string &word) {
    return word == "log"       ? LENSPROF_CURVE_LOG
           : word == "log10"   ? LENSPROF_CURVE_LOG10
           : word == "forward" ? LENSPROF_CURVE_FORWARD
                               : LENSPROF_CURVE_INVERSE;
}

CLI::Option *add_size(CLI::App &app, const char *name, uint32_t &width, uint32_t &height, const char *about) {
    return app
        .add_option_function<std::string>(
            name,
            [name, &width, &height](const std::string &text) {
                const std::string wrong = read_size(text, width, height);
                if (!wrong.empty()) throw CLI::ValidationError(name, text + ": " + wrong);
            },
            about)
        ->type_name("WIDTHxHEIGHT");
}

}  // namespace

void declare_foreign(CLI::App &app, ForeignOptions &o, bool written) {
    add_size(app, "--frame", o.width, o.height,
             "size of the pictures, px, for formats that depend on it and do not say it");
    add_size(app, "--grid", o.columns, o.rows,
             written ? "columns and rows of maps (that of the frame) and of alsc (16x12)"
                     : "alsc: columns and rows of tables other than 16x12 and 32x32");
    app.add_option_function<std::string>(
           "--curve", [&o](const std::string &word) { o.curve = curve_of(word); },
           "curves: what the table holds: inverse (grey value to irradiance; default), log or log10 of that, or "
           "forward (irradiance to grey value)")
        ->check(CLI::IsMember({"inverse", "log", "log10", "forward"}));
    app.add_option("--sense", o.sense,
                   "maps: attenuation (divide; default for PNG) or gain (multiply; default for float TIFF)")
        ->check(CLI::IsMember({"attenuation", "gain"}));
    app.add_option("--color-temperature", o.color_temperature_k,
                   "alsc: K; default that of the file or profile, or 4500")
        ->check(in_range(500.0, 50000.0));
    if (!written) return;
    app.add_option("--depth", o.depth, "maps as PNG: bits, 8 or 16 (default)")->check(CLI::IsMember({8, 16}));
    app.add_option("--opcode", o.opcode,
                   "opcodes: radial (FixVignetteRadial), map (GainMap) or auto: radial where that is exact to 0.5 %")
        ->check(CLI::IsMember({"auto", "radial", "map"}));
}

}  // namespace lensprof
