// What `lensprof response` prints: a JSON object, and lines for people.
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/program/format.hpp"
#include "cli/response/rules.hpp"

namespace lensprof {
namespace {

const char *tones_word(const FileFindings &file) {
    return file.pattern_levels > kStrongMap ? "local" : file.pattern_levels > kWeakMap ? "doubtful" : "global";
}

Json file_json(const FileFindings &file) {
    const PlacesOf &f = file.from;
    Json colour = Json::array();
    for (size_t c = 0; c < 3; c++)
        colour.push_back(
            {file.rendering.colour[3 * c], file.rendering.colour[3 * c + 1], file.rendering.colour[3 * c + 2]});
    Json json;
    json["file"] = file.file;
    json["jpeg"] = file.rendered.empty() ? Json() : Json(file.rendered);
    json["size"] = {f.width, f.height};
    json["quarter_turns"] = f.quarter_turns;
    json["alignment"] = {{"shift", {f.alignment.shift[0], f.alignment.shift[1]}},
                         {"scale", f.alignment.scale},
                         {"k", {f.alignment.k1, f.alignment.k2}},
                         {"correlation", f.alignment.correlation},
                         {"texture", f.alignment.texture}};
    json["squares"] = f.squares;
    json["places"] = file.places;
    json["left_out"] = {{"black", f.black},
                        {"white", f.white},
                        {"colourful", f.colourful},
                        {"saturated", f.saturated},
                        {"rough", f.rough}};
    json["radius"] = file.radius;
    json["gamma"] = file.gamma;
    json["gamma_sigma"] = file.gamma_sigma;
    json["colour"] = f.channels == 1 ? Json::array({Json::array({file.rendering.colour[0]})}) : colour;
    json["white_ev"] = file.white_ev;
    json["noise"] = file.noise_levels;
    json["falloff"] = {
        {"corrected", file.is_corrected()}, {"corner", file.corner}, {"corner_sigma", file.corner_sigma}};
    json["tones"] = {{"mapped", tones_word(file)}, {"pattern", file.pattern_levels}, {"pattern_ev", file.pattern_ev}};
    return json;
}

void print_file(const FileFindings &file, std::ostream &out) {
    const PlacesOf &f = file.from;
    out << format("picture   %s: %s of %u x %u px, %u areas, %.2f levels from the curve\n", file.file.c_str(),
                  file.rendered.empty() ? "its preview" : file.rendered.c_str(), f.width, f.height, file.places,
                  file.noise_levels);
    out << format(
        "          falloff %s: %.3f +- %.3f of the sensor's light at r = %.2f; tones %s: a map of %.2f levels "
        "remains\n",
        file.is_corrected() ? "corrected by the camera" : "not corrected", file.corner, file.corner_sigma, file.radius,
        file.pattern_levels > kStrongMap ? "locally mapped"
        : file.pattern_levels > kWeakMap ? "possibly locally mapped"
                                         : "globally mapped",
        file.pattern_levels);
    out << format("          white %.2f EV below the saturation of the sensor\n", file.white_ev);
}

}  // namespace

Json response_report_json(const ResponseReport &report) {
    Json json;
    json["schema"] = json_schema;
    json["method"] = "response";
    json["usable"] = report.usable;
    add_verdict(report.verdict, json);
    json["files"] = Json::array();
    for (const FileFindings &file : report.files) json["files"].push_back(file_json(file));
    const bool is_fitted = !report.files.empty();
    json["response"] = is_fitted ? response_json(&report.response, 1) : Json();
    json["gamma"] = {{"value", is_fitted ? Json(report.gamma) : Json()},
                     {"sigma", is_fitted ? Json(report.log_gamma_sigma) : Json()}};
    json["grey"] = is_fitted ? Json::array({report.lowest / 255.0, report.highest / 255.0}) : Json();
    json["shows_white"] = report.shows_white;
    json["falloff_corrected"] = report.is_corrected;
    json["seconds"] = {{"load", report.load_s}, {"solve", report.solve_s}};
    json["profile"] = report.profile_id ? Json(report.profile_id) : Json();
    return json;
}

void print_response_report(const ResponseReport &report, std::ostream &out) {
    for (const FileFindings &file : report.files) print_file(file, out);
    print_response(report.response, out);
    out << format("gamma     %.3f +- %.3f (levels 48 to 208; standard error of ln gamma %.3f)\n", report.gamma,
                  report.gamma * report.log_gamma_sigma, report.log_gamma_sigma);
    out << format("levels    %.0f to %.0f of 255 are measured; white %s\n", report.lowest, report.highest,
                  report.shows_white ? "is measured" : "is extrapolated");
    out << format("time      load %.2f s, solve %.2f s\n", report.load_s, report.solve_s);
    if (!report.usable) out << "NOT USABLE: " << report.verdict.headline() << "\n";
    print_findings(report.verdict, out);
}

}  // namespace lensprof
