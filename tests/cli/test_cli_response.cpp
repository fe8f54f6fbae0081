// `lensprof response`: the response of made-up cameras from raw files and their JPEGs, against the truth.
#include "cli_runs.hpp"
#include "response_scenes.hpp"

#include "campaign.h"

using namespace cli_runs;
using namespace response_scenes;

namespace {

void needs_libraw() {
    if (!can_read_raw()) skip();
}

std::string work(const std::string &name) { return in_folder(name); }

// The JPEG as it would be embedded, and the file around it.
std::string save_shot(const std::string &name, const Taken &taken, const JpegKind &kind = {92, 2, 2}) {
    const std::string jpeg = work("embedded.tmp.jpg"), file = work(name);
    write_jpeg_file(jpeg, taken.rendered, kind);
    save(file, raw_files::dng_with_preview(taken.dng, load(jpeg), taken.rendered.width, taken.rendered.height));
    fs::remove(jpeg);
    return file;
}

// A camera whose properties all vary.
Shot any_shot(int i) {
    std::mt19937 random(static_cast<uint32_t>(1000 + i));
    std::uniform_real_distribution<double> even(0.0, 1.0);
    Shot shot;
    shot.response = response_number(i);
    shot.white_ev = -0.2 + 0.8 * even(random);
    shot.exposure = std::exp2(-0.5 + 1.5 * even(random));
    shot.mixing = 0.8 * even(random);
    shot.balance = {1.4 + even(random), 1.0, 1.2 + even(random)};
    shot.falloff = {-0.6 * even(random), -0.1 + 0.2 * even(random), 0.0};
    shot.corrects = i % 3 == 1;
    shot.saturation = i % 4 == 3 ? 0.3 * even(random) : 0.0;
    shot.sharpen = 0.6 * even(random);
    shot.noise = 0.003 * even(random), shot.shot_noise = 0.03 * even(random);
    shot.crop = 0.02 * even(random);
    shot.bend = i % 5 == 2 ? -0.04 * even(random) : 0.0;
    shot.rendered_width = static_cast<uint32_t>(400 + 480 * even(random));
    shot.jpeg.quality = 75 + static_cast<int>(24 * even(random));
    shot.jpeg.step_x = shot.jpeg.step_y = i % 2 ? 1 : 2;
    const lensprof::SceneKind kinds[] = {lensprof::SceneKind::landscape, lensprof::SceneKind::landscape,
                                         lensprof::SceneKind::interior, lensprof::SceneKind::foliage};
    shot.scene = kinds[i / 2 % 4];
    shot.seed = static_cast<uint32_t>(50 + i);
    return shot;
}

// 30 cameras: gamma within .03, and within its standard error as often as that means.
void test_campaign(void **) {
    needs_libraw();
    const int runs = campaign_runs(30);
    int within = 0, within_two = 0, corrections = 0;
    for (int i = 0; i < runs; i++) {
        const Shot shot = any_shot(i);
        const Json json = json_of({"response", save_shot("shot.dng", take(shot), shot.jpeg), "--no-store", "--json"});
        const double truth = std::exp(gauge_of(shot.response)) / std::log(208.0 / 48.0);
        const double error = std::log(double(json["gamma"]["value"]) / truth), sigma = json["gamma"]["sigma"];
        const auto &file = json["files"][0];
        const double radius = file["radius"], corner = shot.corrects ? 1.0 / falloff_of(shot, radius * radius) : 1.0;
        within += std::fabs(error) <= sigma, within_two += std::fabs(error) <= 2 * sigma;
        corrections += file["falloff"]["corrected"] == shot.corrects;
        print_message("%2d gamma %.3f true %.3f ln error %+.4f sigma %.4f; corner %.3f true %.3f sigma %.4f; map %.2f; levels %.2f; "
                      "grey %.2f..%.2f places %d corr %.3f white_ev %.2f true %.2f shows %d%s\n",
                      i, double(json["gamma"]["value"]), truth, error, sigma, double(file["falloff"]["corner"]), corner,
                      double(file["falloff"]["corner_sigma"]), double(file["tones"]["pattern"]), double(file["noise"]),
                      double(json["grey"][0]), double(json["grey"][1]), int(file["places"]),
                      double(file["alignment"]["correlation"]), double(file["white_ev"]), shot.white_ev, int(bool(json["shows_white"])), shot.saturation > 0 ? " saturated" : "");
    }
    print_message("%d: within one sigma %d, two %d; corrections told %d\n", runs, within, within_two, corrections);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_campaign, empty_folder),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
