#include "cli/profiles/foreign_options.hpp"

namespace lensprof {

Keys declare_foreign(Command &command, ForeignOptions &o, bool is_output) {
    constexpr std::pair<uint32_t, uint32_t> sides = {2, 65536};
    Keys keys = command.expert().keys("--encoding", "what a format depends on but does not state");
    keys.size("frame", o.width, o.height, sides, "size of the pictures, px");
    keys.size("grid", o.columns, o.rows, sides,
              is_output
                  ? "columns and rows of maps (default: the frame size) and of alsc (default: 16x12); rows of curves "
                    "(default: 256) and cube (default: 1024)"
                  : "columns and rows of alsc tables; default 16x12 or 32x32, by their length");
    keys.choice(
        "curve", o.curve,
        {{"inverse", LENSPROF_CURVE_INVERSE},
         {"log", LENSPROF_CURVE_LOG},
         {"log10", LENSPROF_CURVE_LOG10},
         {"forward", LENSPROF_CURVE_FORWARD}},
        "content of a table of curves, or of a cube (inverse or forward): inverse (default: grey value to irradiance), "
        "log or log10 of that, or forward (irradiance to grey value)");
    keys.choice<std::string>(
        "sense", o.sense, {{"attenuation", "attenuation"}, {"gain", "gain"}},
        "meaning of maps: attenuation (divide; default for PNG) or gain (multiply; default for float TIFF)");
    keys.number("color-temperature", o.color_temperature_k, {500.0, 50000.0},
                "colour temperature of alsc tables, K; default that of the file or profile, else 4500");
    if (!is_output) {
        keys.flag("strict", o.strict,
                  "refuse responses that decrease anywhere, instead of using the nearest increasing curve");
        return keys;
    }
    keys.choice("depth", o.depth, {{"8", 8}, {"16", 16}}, "bits of PNG maps: 8 or 16 (default)");
    keys.choice("opcode", o.opcode,
                {{"auto", LENSPROF_DNG_AUTO}, {"radial", LENSPROF_DNG_RADIAL}, {"map", LENSPROF_DNG_GAIN_MAP}},
                "kind of DNG opcodes: radial (FixVignetteRadial), map (GainMap) or auto (default: radial if exact to "
                "0.5 %)");
    return keys;
}

Choices<std::string> format_choices(bool to_write) {
    Choices<std::string> choices;
    for (uint32_t format = 1; const ForeignRule *rule = lensprof_format_get_info(format); format++)
        if (is_offered(*rule, to_write)) choices.emplace_back(rule->name, rule->name);
    return choices;
}

}  // namespace lensprof
