#include "photo/calibration/sensor_file.hpp"

#include <algorithm>
#include <cmath>

#include <lensprof/formats.h>
#include <nlohmann/json.hpp>

#include "photo/base/format.hpp"
#include "photo/base/library.hpp"

namespace lensprof {
namespace {

using Json = nlohmann::ordered_json;
using Table = std::vector<double>;

constexpr double frame_side = 4000.0;  // px of the frame: only its shape matters
constexpr const char *algorithm = "rpi.alsc";

// The tables of one profile, as the library writes them.
Json tables_of(const lensprof_profile &profile, double aspect, const SensorTables &tables) {
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = LENSPROF_FORMAT_ALSC;
    options.width = static_cast<uint32_t>(std::lround(frame_side * std::min(aspect, 1.0)));
    options.height = static_cast<uint32_t>(std::lround(frame_side * std::min(1.0 / aspect, 1.0)));
    options.columns = tables.columns, options.rows = tables.rows;
    return Json::parse(exported("tables", {&profile}, options))[algorithm];
}

// How far two tables of ratios differ from cell to cell: libcamera's tuning tool derives sigma from it, the mean over
// the inner cells of the mean difference to four neighbours. It is how much of a shading libcamera's adaptive part may
// add to an interpolated table.
double roughness(const Table &a, const Table &b, const SensorTables &tables) {
    Table ratio(a.size());
    double mean = 0.0;
    for (size_t i = 0; i < a.size(); i++) ratio[i] = a[i] / b[i], mean += ratio[i] / static_cast<double>(a.size());
    if (mean < 1.0)
        for (double &value : ratio) value = 1.0 / value;
    double sum = 0.0;
    const size_t columns = tables.columns, rows = tables.rows;
    for (size_t y = 1; y + 1 < rows; y++)
        for (size_t x = 1; x + 1 < columns; x++)
            for (const size_t neighbour :
                 {(y - 1) * columns + x, (y + 1) * columns + x, y * columns + x - 1, y * columns + x + 1})
                sum += 0.25 * std::fabs(ratio[y * columns + x] - ratio[neighbour]);
    return std::round(1e5 * sum / static_cast<double>((columns - 2) * (rows - 2))) / 1e5;
}

// The largest of neighbouring temperatures; what the library writes for one.
double sigma_of(const Json &calibrations, const SensorTables &tables, const Json &for_one) {
    if (calibrations.size() < 2) return for_one;
    double largest = 0.0;
    for (size_t n = 0; n + 1 < calibrations.size(); n++)
        largest = std::max(largest, roughness(calibrations[n]["table"].get<Table>(),
                                              calibrations[n + 1]["table"].get<Table>(), tables));
    return largest;
}

// The mean of the temperatures, as of the tuning tool.
Table mean_luminance(const std::vector<Json> &parts, SensorFileCost &cost) {
    Table mean(parts.front()["luminance_lut"].size(), 0.0);
    for (const Json &part : parts)
        for (size_t i = 0; i < mean.size(); i++)
            mean[i] += part["luminance_lut"][i].get<double>() / static_cast<double>(parts.size());
    for (const Json &part : parts)
        for (size_t i = 0; i < mean.size(); i++)
            cost.green = std::max(cost.green, std::fabs(mean[i] / part["luminance_lut"][i].get<double>() - 1.0));
    for (double &value : mean) value = std::round(1000.0 * value) / 1000.0;
    return mean;
}

// A line for each row of a table.
std::string table_text(const Json &table, const SensorTables &tables) {
    std::string text = "[";
    for (size_t i = 0; i < table.size(); i++)
        text += (i ? "," : "") + std::string(i % tables.columns ? " " : "\n      ") + table[i].dump();
    return text + "]";
}

std::string calibrations_text(const char *name, const Json &calibrations, const SensorTables &tables) {
    std::string text = format("    \"%s\": [", name);
    for (size_t n = 0; n < calibrations.size(); n++)
        text += (n ? "," : "") + std::string("\n     {\"ct\": ") + calibrations[n]["ct"].dump()
                + ", \"table\": " + table_text(calibrations[n]["table"], tables) + "}";
    return text + "],\n";
}

bool is_coloured(const lensprof_profile *profile) { return profile->vignettings == 3 || profile->grid.channels == 3; }

}  // namespace

std::string sensor_file_text(std::vector<const lensprof_profile *> profiles, double aspect, const SensorTables &tables,
                             SensorFileCost &cost) {
    std::sort(profiles.begin(), profiles.end(), [](const lensprof_profile *a, const lensprof_profile *b) {
        return a->key.color_temperature_k < b->key.color_temperature_k;
    });
    std::vector<Json> parts;
    Json red = Json::array(), blue = Json::array();
    for (const lensprof_profile *profile : profiles) {
        parts.push_back(tables_of(*profile, aspect, tables));
        red.push_back(parts.back()["calibrations_Cr"][0]), blue.push_back(parts.back()["calibrations_Cb"][0]);
    }
    cost.has_colours = std::any_of(profiles.begin(), profiles.end(), is_coloured);
    const Json &first = parts.front();
    std::string text = format("{\n  \"%s\": {\n    \"omega\": ", algorithm) + first["omega"].dump()
                       + ",\n    \"n_iter\": " + (cost.has_colours ? first["n_iter"].dump() : "0")
                       + ",\n    \"luminance_strength\": " + first["luminance_strength"].dump() + ",\n";
    if (cost.has_colours)
        text += calibrations_text("calibrations_Cr", red, tables) + calibrations_text("calibrations_Cb", blue, tables);
    text += "    \"luminance_lut\": " + table_text(Json(mean_luminance(parts, cost)), tables) + ",\n";
    const double sigma_red = sigma_of(red, tables, first["sigma"]),
                 sigma_blue = sigma_of(blue, tables, first["sigma_Cb"]);
    return text + "    \"sigma\": " + Json(sigma_red).dump() + ",\n    \"sigma_Cb\": " + Json(sigma_blue).dump()
           + "\n  }\n}\n";
}

}  // namespace lensprof
