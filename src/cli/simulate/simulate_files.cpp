// The text files beside the pictures: the project and truth.json.
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/program/format.hpp"
#include "cli/report/report.hpp"
#include "cli/simulate/simulate.hpp"

namespace lensprof {
namespace {

Json image_json(const Truth &truth, size_t i) {
    const auto &e = truth.exposures[i];
    Json image = {
        {"file", truth.files[i]}, {"ev", e.ev}, {"white_balance", {e.white_balance[0], 1.0, e.white_balance[2]}}};
    if (!truth.settings.empty()) {
        const auto &s = truth.settings[i];
        image["exif_ev"] = std::log2(s.time_s * s.iso / 100.0 / (s.f_number * s.f_number));
    }
    if (!truth.positions.empty()) image["shift"] = truth.positions[i];
    if (!truth.objects.empty()) {
        image["objects"] = Json::array();
        for (const auto &b : truth.objects[i]) image["objects"].push_back({b.left, b.top, b.right, b.bottom});
    }
    return image;
}

}  // namespace

// The project as an alignment program would leave it: geometry known, exposures to be found.
std::string project_text(const SimulateOptions &o, const Truth &truth) {
    Random random(truth.seed * 31ull + 5);
    std::string text =
        "# rendered by lensprof simulate\np f2 w3000 h1500 v360  E0 R0 n\"TIFF_m c:LZW\"\nm g1 i0 f0 m2 "
        "p0.00784314\n\n";
    for (size_t i = 0; i < truth.cameras.size(); i++) {
        const auto &c = truth.cameras[i];
        double degrees_per_px = c.hfov_deg / c.width, e[2] = {random.normal(), random.normal()};
        const char *link = i ? "=0" : "0", *va = i ? "=0" : "1";
        text += format("i w%u h%u f0 v%s", c.width, c.height, i ? "=0" : format("%.17g", c.hfov_deg).c_str());
        for (char letter : {'a', 'b', 'c', 'd', 'e'}) text += format(" R%c%s", letter, link);
        text +=
            format(" Eev0 Er1 Eb1 r%.17g p%.17g y%.17g TrX0 TrY0 TrZ0 Tpy0 Tpp0 j0", c.roll_deg,
                   c.pitch_deg + o.misalign * degrees_per_px * e[0], c.yaw_deg + o.misalign * degrees_per_px * e[1]);
        for (char letter : {'a', 'b', 'c', 'd', 'e', 'g', 't'}) text += format(" %c%s", letter, link);
        text += format(" Va%s Vb%s Vc%s Vd%s Vx%s Vy%s Vm5 n\"%s\"\n", va, link, link, link, link, link,
                       truth.files[i].c_str());
    }
    text += "\nv Ra0 Rb0 Rc0 Rd0 Re0\nv Vb0 Vc0 Vd0 Vx0 Vy0\n";
    for (size_t i = 1; i < truth.cameras.size(); i++) text += format("v Eev%zu Er%zu Eb%zu\n", i, i, i);
    return text + "v\n";
}

std::string truth_text(const Truth &truth) {
    Json json, images = Json::array(), k = Json::array();
    for (size_t i = 0; i < truth.files.size(); i++) images.push_back(image_json(truth, i));
    for (uint32_t c = 0; c < truth.vignettings; c++)
        k.push_back({truth.vignetting[c].k[0], truth.vignetting[c].k[1], truth.vignetting[c].k[2]});
    json["schema"] = 1;
    json["images"] = images;
    json["vignetting"] = {{"k", k}, {"center", {truth.vignetting[0].center[0], truth.vignetting[0].center[1]}}};
    json["response"] = {
        {"values", {std::vector<double>(truth.response.table, truth.response.table + LENSPROF_RESPONSE_SAMPLES)}}};
    json["noise"] = truth.noise_levels;
    json["outliers"] = truth.outlier_share;
    json["objects"] = truth.object_share;
    json["local_tone"] = truth.local_tone;
    json["scene"] = scene_word(truth.scene);
    json["parallax"] = truth.parallax;
    json["sharpen"] = truth.sharpening;
    json["clip"] = truth.clip_share;
    return json.dump(1) + "\n";
}

}  // namespace lensprof
