#include "cli/report/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

// Radii of the table, as sample indices.
constexpr size_t table_samples[] = {0, 25, 50, 75, 100};

ChartCurve sample_curve(const StoredProfile &stored, uint32_t index) {
    const lensprof_profile &p = *stored.profile;
    ChartCurve curve{};
    curve.id = stored.id;
    curve.channel = p.vignettings == 3 ? int(index) : -1;
    double sigma;
    lensprof_profile_corner_falloff(&p, index, &sigma);
    curve.has_sigma = sigma > 0.0;
    for (size_t i = 0; i < chart_samples; i++) {
        const double r = double(i) / (chart_samples - 1);
        curve.m[i] = lensprof_profile_radial_falloff(&p, index, r, &sigma);
        curve.sigma[i] = std::max(sigma, 0.0);
    }
    return curve;
}

// The title has the parts of the key that all profiles share (if known), the labels the rest.
std::vector<std::string> label_profiles(const std::vector<StoredProfile> &profiles, std::string &title) {
    std::vector<KeyParts> keys;
    for (const StoredProfile &stored : profiles) keys.push_back(key_parts(stored.profile->key));
    std::vector<std::string> labels(keys.size());
    for (size_t part = 0; part < KeyParts().size(); part++) {
        const auto equals_first = [&](const KeyParts &key) { return key[part] == keys[0][part]; };
        const bool shared = std::all_of(keys.begin(), keys.end(), equals_first);
        if (shared && !keys[0][part].empty()) title += (title.empty() ? "" : ", ") + keys[0][part];
        for (size_t i = 0; i < keys.size() && !shared; i++)
            labels[i] += (labels[i].empty() ? "" : ", ") + spell_part(keys[i], part);
    }
    const std::vector<std::string> alone = labels;
    for (size_t i = 0; i < keys.size(); i++)
        if (std::count(alone.begin(), alone.end(), alone[i]) > 1)
            labels[i] += (labels[i].empty() ? "profile " : ", profile ") + std::to_string(profiles[i].id);
    return labels;
}

// Gain grids are not functions of the radius.
std::string note_of(const std::vector<StoredProfile> &profiles) {
    std::string ids;
    for (const StoredProfile &stored : profiles)
        if (stored.profile->grid.columns) ids += (ids.empty() ? "" : ", ") + std::to_string(stored.id);
    if (ids.empty()) return ids;
    if (!profiles[0].id) return "without the gain grid";
    const bool is_one = ids.find(',') == std::string::npos;
    return (is_one ? "without the gain grid of profile " : "without the gain grids of profiles ") + ids;
}

// Text for any terminal and font renderer: UTF-8 without control characters.
std::string printable(const std::string &text) {
    std::vector<char> field(text.size() + 1);
    set_text(field.data(), field.size(), text);
    return field.data();
}

// 1, 2 or 5 times a power of ten, at least `least`.
double round_step(double min_step) {
    const double power = std::pow(10.0, std::floor(std::log10(min_step)));
    for (double factor : {1.0, 2.0, 5.0})
        if (factor * power >= min_step * (1.0 - 1e-9)) return factor * power;
    return 10.0 * power;
}

char letter(size_t curve) { return char('a' + curve); }

void print_line(const std::string &line, std::ostream &out) {
    out << line.substr(0, line.find_last_not_of(' ') + 1) << "\n";
}

void print_plot(const Chart &chart, std::ostream &out) {
    constexpr int columns = 72;
    const ChartAxis axis = chart_axis(chart);
    const int per_step = std::max(1, 20 / axis.steps), rows = axis.steps * per_step;
    std::vector<std::string> plot(size_t(rows + 1), std::string(columns + 1, ' '));
    for (size_t k = chart.curves.size(); k-- > 0;)  // the first curve is drawn on top
        for (int column = 0; column <= columns; column++) {
            const double position = double(column) / columns * (chart_samples - 1);
            const size_t i = std::min(size_t(position), chart_samples - 2);
            const double *m = chart.curves[k].m, value = m[i] + (position - double(i)) * (m[i + 1] - m[i]);
            const long row = std::lround((axis.high - value) / (axis.high - axis.low) * rows);
            plot[size_t(std::clamp(row, 0l, long(rows)))][size_t(column)] = letter(k);
        }
    for (int row = 0; row <= rows; row++) {
        const bool is_tick = row % per_step == 0;
        const std::string mark = is_tick ? format("%8g +", axis.tick(axis.steps - row / per_step)) : "         |";
        print_line(mark + plot[size_t(row)], out);
    }
    std::string ruler(10 + columns + 1, '-'), labels(10 + columns + 5, ' ');
    ruler.replace(0, 10, "         +");
    const char *const words[] = {"r = 0", "0.25", "0.5", "0.75", "corner"};
    const size_t starts[] = {6, 26, 45, 62, 79};  // the numbers are below their ticks
    for (size_t i = 0; i < 5; i++) {
        ruler[10 + i * columns / 4] = '+';
        labels.replace(starts[i], std::strlen(words[i]), words[i]);
    }
    out << ruler << "\n";
    print_line(labels, out);
}

void print_table(const Chart &chart, std::ostream &out) {
    size_t width = 5;
    for (const ChartCurve &curve : chart.curves) width = std::max(width, curve.label.size());
    std::string head = format("%*s", int(width) + 11, "r");
    for (size_t sample : table_samples) head += format("  %-14g", double(sample) / (chart_samples - 1));
    print_line(head, out);
    for (size_t k = 0; k < chart.curves.size(); k++) {
        const ChartCurve &curve = chart.curves[k];
        std::string light = format("%c  %-*s       M", letter(k), int(width), curve.label.c_str());
        std::string loss = std::string(width + 9, ' ') + "EV";
        for (size_t sample : table_samples) {
            light += format("  %.3f%-9s", curve.m[sample],
                            sample > 0 && curve.has_sigma ? format(" +- %.3f", curve.sigma[sample]).c_str() : "");
            const double ev = std::round(100.0 * std::log2(curve.m[sample])) / 100.0 + 0.0;  // no -0.00
            loss += format("  %-14s", format("%.2f", ev).c_str());
        }
        print_line(light, out);
        print_line(loss, out);
    }
}

}  // namespace

Chart make_chart(const std::vector<StoredProfile> &profiles, int channel) {
    Chart chart;
    const std::vector<std::string> labels = label_profiles(profiles, chart.title);
    for (size_t i = 0; i < profiles.size(); i++)
        for (uint32_t c = 0; c < profiles[i].profile->vignettings; c++) {
            if (profiles[i].profile->vignettings == 3 && channel >= 0 && int(c) != channel) continue;
            chart.curves.push_back(sample_curve(profiles[i], c));
            ChartCurve &curve = chart.curves.back();
            curve.label = printable(labels[i]);
            if (curve.channel >= 0) {
                const std::string name = channel_names[curve.channel];
                curve.label += (curve.label.empty() ? "" : ", ") + name;
            }
            if (curve.label.empty()) curve.label = curve.id ? "profile " + std::to_string(curve.id) : "blob";
        }
    chart.title = printable(chart.title);
    chart.note = note_of(profiles);
    if (chart.curves.size() > chart_max_curves)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      format("a chart of %zu curves is unreadable, the maximum is %zu; choose fewer profiles, by ids "
                             "or with filters such as --focal and --aperture, or one --channel",
                             chart.curves.size(), chart_max_curves));
    return chart;
}

ChartAxis chart_axis(const Chart &chart) {
    double low = 0.5, high = 1.0;
    for (const ChartCurve &curve : chart.curves)
        for (size_t i = 0; i < chart_samples; i++) {
            low = std::min(low, curve.m[i] - std::min(curve.sigma[i], 0.5 * curve.m[i]));
            high = std::max(high, curve.m[i]);
        }
    const double step = round_step((high - low) / 10.0);
    const int first = int(std::floor(low / step + 1e-9)), last = int(std::ceil(high / step - 1e-9));
    return {first * step, last * step, last - first};
}

void print_chart(const Chart &chart, std::ostream &out) {
    out << "relative illuminance M over r (half diagonals from the centre of the falloff)\n";
    if (!chart.title.empty()) out << chart.title << "\n";
    out << "\n";
    print_plot(chart, out);
    out << "\n";
    print_table(chart, out);
    if (!chart.note.empty()) out << chart.note << "\n";
}

Json chart_json(const Chart &chart) {
    Json curves = Json::array();
    for (const ChartCurve &curve : chart.curves) {
        Json json, r = Json::array(), m = Json::array(), sigma = Json::array(), ev = Json::array();
        for (size_t i = 0; i < chart_samples; i += 5) {
            r.push_back(double(i) / (chart_samples - 1));
            m.push_back(curve.m[i]);
            sigma.push_back(curve.sigma[i]);
            ev.push_back(std::log2(curve.m[i]) + 0.0);
        }
        json["id"] = curve.id ? Json(curve.id) : Json();
        json["label"] = curve.label;
        json["channel"] = curve.channel < 0 ? Json() : Json(channel_names[curve.channel]);
        json["r"] = r;
        json["m"] = m;
        json["sigma"] = curve.has_sigma ? sigma : Json();
        json["ev"] = ev;
        curves.push_back(json);
    }
    return {{"schema", json_schema}, {"title", chart.title}, {"note", chart.note}, {"curves", curves}};
}

}  // namespace lensprof
