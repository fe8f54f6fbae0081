// What `lensprof response` prints: a JSON object, and lines for people.
#include "cli/response/response_report.hpp"

#include <array>

#include <nlohmann/json.hpp>

#include "cli/report/findings.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

Json file_json(const ResponseFile &file) {
    constexpr std::array<const char *, 3> names = {"global", "doubtful", "local"};
    const lensprof_rendering_shot &s = file.shot;
    Json colour = Json::array();
    for (size_t c = 0; c < 3; c++) colour.push_back({s.colour[3 * c], s.colour[3 * c + 1], s.colour[3 * c + 2]});
    Json json;
    json["file"] = file.file;
    json["jpeg"] = file.rendered.empty() ? Json() : Json(file.rendered);
    json["size"] = {s.width, s.height};
    json["quarter_turns"] = s.quarter_turns;
    json["alignment"] = {{"shift", s.shift},
                         {"scale", s.scale},
                         {"k", {s.k1, s.k2}},
                         {"correlation", s.correlation},
                         {"texture", s.texture}};
    json["squares"] = s.squares;
    json["places"] = s.areas;
    json["left_out"] = {{"black", s.black},
                        {"white", s.white},
                        {"colourful", s.colourful},
                        {"saturated", s.saturated},
                        {"rough", s.rough}};
    json["radius"] = s.radius;
    json["gamma"] = s.gamma;
    json["gamma_sigma"] = s.gamma_sigma;
    json["colour"] = s.channels == 1 ? Json::array({Json::array({s.colour[0]})}) : colour;
    json["white_ev"] = s.white_ev;
    json["noise"] = s.noise_levels;
    json["falloff"] = {{"corrected", s.corrects_falloff != 0}, {"corner", s.corner}, {"corner_sigma", s.corner_sigma}};
    json["tones"] = {{"mapped", names[s.tones]}, {"pattern", s.pattern_levels}, {"pattern_ev", s.pattern_ev}};
    return json;
}

void print_file(const ResponseFile &file, std::ostream &out) {
    constexpr std::array<const char *, 3> words = {"globally mapped", "possibly locally mapped", "locally mapped"};
    const lensprof_rendering_shot &s = file.shot;
    out << format("picture   %s: %s of %u x %u px, %u areas, %.2f levels from the curve\n", file.file.c_str(),
                  file.rendered.empty() ? "its preview" : file.rendered.c_str(), s.width, s.height, s.areas,
                  s.noise_levels);
    out << format(
        "          falloff %s: %.3f +- %.3f of the sensor's light at r = %.2f; tones %s: a map of %.2f levels "
        "remains\n",
        s.corrects_falloff ? "corrected by the camera" : "not corrected", s.corner, s.corner_sigma, s.radius,
        words[s.tones], s.pattern_levels);
    out << format("          white %.2f EV below the saturation of the sensor\n", s.white_ev);
}

}  // namespace

Json response_report_json(const ResponseReport &report) {
    Json json;
    json["schema"] = json_schema;
    json["method"] = "response";
    json["usable"] = report.result.usable != 0;
    add_verdict(report.verdict, json);
    json["files"] = Json::array();
    for (const ResponseFile &file : report.files) json["files"].push_back(file_json(file));
    const bool is_fitted = !report.files.empty();
    const lensprof_rendering_result &r = report.result;
    json["response"] = is_fitted ? response_json(&r.response, 1) : Json();
    json["gamma"] = {{"value", is_fitted ? Json(r.gamma) : Json()},
                     {"sigma", is_fitted ? Json(r.gamma_sigma) : Json()}};
    json["grey"] = is_fitted ? Json::array({r.lowest, r.highest}) : Json();
    json["shows_white"] = r.shows_white != 0;
    json["falloff_corrected"] = r.corrects_falloff != 0;
    json["seconds"] = {{"load", report.load_s}, {"solve", report.solve_s}};
    json["profile"] = report.profile_id ? Json(report.profile_id) : Json();
    return json;
}

void print_response_report(const ResponseReport &report, std::ostream &out) {
    const lensprof_rendering_result &r = report.result;
    for (const ResponseFile &file : report.files) print_file(file, out);
    print_response(r.response, out);
    out << format("gamma     %.3f +- %.3f (levels 48 to 208; standard error of ln gamma %.3f)\n", r.gamma,
                  r.gamma * r.gamma_sigma, r.gamma_sigma);
    out << format("levels    %.0f to %.0f of 255 are measured; white %s\n", 255.0 * r.lowest, 255.0 * r.highest,
                  r.shows_white ? "is measured" : "is extrapolated");
    out << format("time      load %.2f s, solve %.2f s\n", report.load_s, report.solve_s);
    if (!r.usable) out << "NOT USABLE: " << report.verdict.headline() << "\n";
    print_findings(report.verdict, out);
}

}  // namespace lensprof
