// A profile as functions for GPUs: GLSL (ES 3.00 and 3.30) and WGSL.
#include <algorithm>
#include <cmath>
#include <functional>

#include "formats/each_format.h"

#include "formats/code/code_text.hpp"
#include "formats/code/shader_table.hpp"
#include "formats/falloff/export.hpp"

namespace lensprof {
namespace {

// What the two languages write differently.
struct Language {
    bool is_wgsl;

    std::string vector(int size) const { return "vec" + std::to_string(size) + (is_wgsl ? "<f32>" : ""); }
    std::string vector(const std::function<double(uint32_t)> &of_channel) const {
        return vector(3) + "(" + float_text(of_channel(0)) + ", " + float_text(of_channel(1)) + ", "
               + float_text(of_channel(2)) + ")";
    }
    // "name: type" or "type name".
    std::string typed(const std::string &type, const std::string &name) const {
        return is_wgsl ? name + ": " + type : type + " " + name;
    }
    std::string value(const std::string &type, const std::string &name) const {
        return is_wgsl ? "let " + name : type + " " + name;
    }
    std::string variable(const std::string &type, const std::string &name) const {
        return is_wgsl ? "var " + name : type + " " + name;
    }
    std::string real(const std::string &whole) const { return (is_wgsl ? "f32(" : "float(") + whole + ")"; }
    std::string whole(const std::string &real) const { return (is_wgsl ? "i32(" : "int(") + real + ")"; }
    std::string scalar() const { return is_wgsl ? "f32" : "float"; }
    std::string index() const { return is_wgsl ? "i32" : "int"; }
    std::string function(const std::string &type, const std::string &name, const std::string &parameters) const {
        return is_wgsl ? "fn " + name + "(" + parameters + ") -> " + type + " {\n"
                       : type + " " + name + "(" + parameters + ") {\n";
    }
};

std::string falloff_text(const lensprof_profile &profile, const Language &l) {
    const std::string v2 = l.vector(2), v3 = l.vector(3);
    const double *center = profile.vignetting[0].center;
    std::string text = l.function(v3, "lensprof_falloff", l.typed(v2, "position") + ", " + l.typed(v2, "size"));
    text += "    " + l.value(v2, "center") + " = " + v2 + "(" + float_text(center[0]) + ", " + float_text(center[1])
            + ");\n";
    for (int n = 0; n < 3; n++)
        text += "    " + l.value(v3, "k" + std::to_string(n + 1)) + " = " + l.vector([&](uint32_t c) {
            return profile.vignetting[profile.vignettings == 3 ? c : 0].k[n];
        }) + ";\n";
    text += "    " + l.value(v2, "r") + " = (position - 0.5 * size) / (0.5 * length(size)) - center;\n    "
            + l.value(l.scalar(), "r2") + " = dot(r, r);\n    return 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));\n}\n";
    return text;
}

std::string conversion(const Language &l, const char *name, const char *parameter, const std::string &result) {
    return l.function(l.vector(3), name, l.typed(l.vector(3), parameter)) + "    return " + result + ";\n}\n";
}

bool is_power(const lensprof_response &response) {
    return response.kind == LENSPROF_RESPONSE_LINEAR || response.kind == LENSPROF_RESPONSE_GAMMA;
}

// Linear and gamma responses, without a table. Values below 0 have no power.
std::string power_text(const lensprof_profile &profile, const Language &l) {
    const auto gamma = [&](uint32_t c) { return profile.response[profile.responses == 3 ? c : 0].gamma; };
    const bool is_linear = std::all_of(profile.response, profile.response + profile.responses,
                                       [](const lensprof_response &r) { return r.kind == LENSPROF_RESPONSE_LINEAR; });
    const auto power = [&](const std::string &base, const std::string &exponent) {
        return is_linear ? base
                         : "pow(max(" + base + ", " + l.vector([](uint32_t) { return 0.0; }) + "), " + exponent + ")";
    };
    return conversion(l, "lensprof_to_light", "encoded", power("encoded", l.vector(gamma))) + "\n"
           + conversion(l, "lensprof_from_light", "light",
                        power("light", l.vector([&](uint32_t c) { return 1.0 / gamma(c); })));
}

// The values of a table, as float or vec3.
std::string values_text(const ShaderTable &table, const Language &l) {
    const size_t size = table.values[0].size();
    const bool is_one = table.values.size() == 1;
    const std::string type = is_one ? l.scalar() : l.vector(3);
    const std::string array =
        l.is_wgsl ? "array<" + type + ", " + std::to_string(size) + ">" : type + "[" + std::to_string(size) + "]";
    std::string text = l.is_wgsl ? "var<private> lensprof_table: " + array
                                 : "const " + type + " lensprof_table[" + std::to_string(size) + "]";
    text += " = " + array + "(";
    for (size_t i = 0; i < size; i++) {
        const std::string value =
            is_one ? float_text(table.values[0][i]) : l.vector([&](uint32_t c) { return table.values[c][i]; });
        text += (i % (is_one ? 8 : 2) ? " " : "\n    ") + value + (i + 1 < size ? "," : ");\n");
    }
    return text;
}

// One channel into light: linear between the values of the table.
std::string channel_to_light(const Language &l, const std::string &at, const std::string &channel, size_t last) {
    const std::string steps = float_text(static_cast<double>(last));
    return l.function(l.scalar(), "lensprof_channel_to_light", l.typed(l.scalar(), "grey") + channel) + "    "
           + l.value(l.scalar(), "x") + " = clamp(grey, 0.0, 1.0) * " + steps + ";\n    " + l.value(l.index(), "i")
           + " = min(" + l.whole("x") + ", " + std::to_string(last - 1) + ");\n    return mix(" + at + "[i], " + at
           + "[i + 1], x - " + l.real("i") + ");\n}\n";
}

// The inverse: bisection for the step of the table that the light lies in.
std::string channel_from_light(const Language &l, const std::string &at, const std::string &channel, size_t last) {
    const std::string steps = float_text(static_cast<double>(last));
    return l.function(l.scalar(), "lensprof_channel_from_light", l.typed(l.scalar(), "light") + channel) + "    "
           + l.variable(l.index(), "low") + " = 0;\n    " + l.variable(l.index(), "high") + " = " + std::to_string(last)
           + ";\n    while (high - low > 1) {\n        " + l.value(l.index(), "middle")
           + " = (low + high) / 2;\n        if (" + at
           + "[middle] <= light) { low = middle; } else { high = middle; }\n" + "    }\n    "
           + l.value(l.scalar(), "share") + " = (light - " + at + "[low]) / max(" + at + "[high] - " + at
           + "[low], 1e-37);\n    return clamp((" + l.real("low") + " + share) / " + steps + ", 0.0, 1.0);\n}\n";
}

std::string table_text(const ShaderTable &table, const Language &l) {
    const size_t last = table.values[0].size() - 1;
    const bool is_one = table.values.size() == 1;
    const std::string channel = is_one ? "" : ", " + l.typed(l.index(), "channel");
    std::string to_light = channel_to_light(l, "lensprof_table", channel, last),
                from_light = channel_from_light(l, "lensprof_table", channel, last);
    const auto add_channel = [](std::string &text) {  // to each element of the table
        for (size_t at = 0; (at = text.find("lensprof_table[", at)) != std::string::npos;) {
            at = text.find(']', at) + 1;
            text.insert(at, "[channel]");
        }
    };
    if (!is_one) add_channel(to_light), add_channel(from_light);
    const auto each = [&](const std::string &name, const std::string &value) {
        std::string all;
        for (int c = 0; c < 3; c++)
            all += (c ? ", " : "") + name + "(" + value + "[" + std::to_string(c) + "]"
                   + (is_one ? "" : ", " + std::to_string(c)) + ")";
        return l.vector(3) + "(" + all + ")";
    };
    return values_text(table, l) + "\n" + to_light + "\n" + from_light + "\n"
           + conversion(l, "lensprof_to_light", "encoded", each("lensprof_channel_to_light", "encoded")) + "\n"
           + conversion(l, "lensprof_from_light", "light", each("lensprof_channel_from_light", "light"));
}

std::string correction_text(const Language &l) {
    const std::string v2 = l.vector(2), v3 = l.vector(3);
    return l.function(v3, "lensprof_correct",
                      l.typed(v3, "encoded") + ", " + l.typed(v2, "position") + ", " + l.typed(v2, "size"))
           + "    return lensprof_from_light(lensprof_to_light(encoded) / lensprof_falloff(position, size));\n}\n";
}

std::string shader_text(const lensprof_profile &profile, const Language &l) {
    const bool is_table = !std::all_of(profile.response, profile.response + profile.responses, is_power);
    const ShaderTable table = is_table ? shader_table(profile) : ShaderTable();
    std::vector<std::string> head = head_lines(profile, "response and falloff of a camera and lens");
    head.insert(head.end(),
                {"lensprof_falloff: M = 1 + k1 r^2 + k2 r^4 + k3 r^6 of linear light, by which a correction divides.",
                 "position, size: of a pixel and of the whole frame, px; y is down; the first pixel is at 0.5, 0.5.",
                 "lensprof_to_light, lensprof_from_light: response, grey values 0 to 1.",
                 "lensprof_correct: from_light(to_light(encoded) / falloff)."});
    if (is_table)
        head.push_back("Table of " + std::to_string(table.values[0].size()) + " values: a corrected value is within "
                       + fixed_text(std::max(1.0, std::ceil(100.0 * table.worst)) / 100.0) + " levels of 255.");
    std::string text;
    for (const std::string &line : head) text += "// " + line + "\n";
    text += l.is_wgsl ? "\n" : "\nprecision highp float;\n\n";
    return text + falloff_text(profile, l) + "\n" + (is_table ? table_text(table, l) : power_text(profile, l)) + "\n"
           + correction_text(l);
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_shader_write(const lensprof_profile *profile, uint32_t format, void *data, size_t capacity,
                                size_t *count, lensprof_error *error) {
    if (!profile || (format != LENSPROF_FORMAT_GLSL && format != LENSPROF_FORMAT_WGSL) || (!data && capacity)) {
        set_error(
            error,
            "lensprof_export: profile or data is NULL, or the format is not GLSL or WGSL; pass a profile and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] {
        const lensprof_status status = lensprof_profile_validate(profile);
        demand_of_profile(
            status == LENSPROF_OK, 0,
            std::string("is invalid (") + lensprof_status_name(status) + "); see lensprof_profile_validate", status);
        const bool is_wgsl = format == LENSPROF_FORMAT_WGSL;
        check_no_grid(*profile, 0, is_wgsl ? "wgsl" : "glsl");
        return shader_text(*profile, Language{is_wgsl});
    });
}
