// The text files next to the pictures: the project and truth.json.
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "cli/report/report.hpp"
#include "cli/simulate/simulate.hpp"

namespace lensprof {
namespace {

Json vector_json(const Vector3 &v) { return {v.x, v.y, v.z}; }

Json pose_json(const Pose &pose) {
    Json rows = Json::array();
    for (const auto &row : pose.rotation) rows.push_back(vector_json(row));
    return {{"centre_m", vector_json(pose.centre_m)}, {"rotation", rows}};
}

Json image_json(const Truth &truth, size_t i) {
    const auto &e = truth.exposures[i];
    Json image = {
        {"file", truth.files[i]}, {"ev", e.ev}, {"white_balance", {e.white_balance[0], 1.0, e.white_balance[2]}}};
    if (!truth.settings.empty()) {
        const auto &s = truth.settings[i];
        image["exif_ev"] = std::log2(s.time_s * s.iso / 100.0 / (s.f_number * s.f_number));
    }
    if (!truth.poses.empty()) image["pose"] = pose_json(truth.poses[i]);
    if (!truth.positions.empty()) image["shift"] = truth.positions[i];
    if (!truth.objects.empty()) {
        image["objects"] = Json::array();
        for (const auto &b : truth.objects[i]) image["objects"].push_back({b.left, b.top, b.right, b.bottom});
    }
    return image;
}

}  // namespace

// The scene as an alignment program would find it: geometry known, exposures unknown.
Scene aligned_scene(const SimulateOptions &o, const Truth &truth) {
    Random random(truth.seed * 31ull + 5);
    std::vector<NewImage> images;
    Scene scene;
    for (size_t i = 0; i < truth.cameras.size(); i++) {
        lensprof_camera camera = truth.cameras[i];
        const double degrees_per_px = camera.hfov_deg / camera.width;
        const double e[2] = {random.normal(), random.normal()};
        camera.pitch_deg += o.misalign * degrees_per_px * e[0];
        camera.yaw_deg += o.misalign * degrees_per_px * e[1];
        images.push_back({camera, 0, 0});
        scene.files.push_back((std::filesystem::path(o.output) / truth.files[i]).string());
    }
    set_images(images, scene);
    return scene;
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
    json["scene"] = truth.world ? truth.world_word : scene_word(truth.scene);
    json["parallax"] = truth.parallax;
    json["sharpen"] = truth.sharpening;
    json["clip"] = truth.clip_share;
    if (truth.world) {
        const auto &pinhole = truth.pinhole;
        json["gloss"] = truth.gloss;
        json["camera"] = {{"focal_px", pinhole.focal_px},
                          {"principal_px", {pinhole.principal_px[0], pinhole.principal_px[1]}}};
    }
    return json.dump(1) + "\n";
}

}  // namespace lensprof
