#include "fit/methods/cameras.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "core/response.h"
#include "fit/base/constants.hpp"
#include "fit/methods/join.hpp"
#include "fit/methods/raised.hpp"
#include "fit/problem/tracks.hpp"
#include "fit/verdict/output.hpp"
#include "fit/verdict/reason.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kNone = UINT32_MAX;
constexpr double kUnsettledSigma = 1.0;  // of ln gamma that nothing settles
constexpr double kBetter = 0.9;          // standard error, relative, from which on other cameras settle gamma
constexpr double kDarkest = 2.0 / 255.0;

// What a camera's fit tells of its progress, as a part of all.
struct PartOfProgress {
    lensprof_progress progress = nullptr;
    void *user = nullptr;
    double from = 0.0, to = 1.0;

    static int tell(double done, void *part) {
        const auto &own = *static_cast<const PartOfProgress *>(part);
        return own.progress(own.from + (own.to - own.from) * done, own.user);
    }
};

// One camera: what its fit is given, and what it found.
struct Camera {
    CameraInput input;
    std::vector<uint32_t> place;  // of each image of all among those of this camera; kNone
    std::unique_ptr<Output> found;
    bool is_fitted = false;

    const lensprof_fit_result &result() const { return *found->result; }
    bool corrects() const { return is_fitted && (result().usable || result().evens); }
    uint32_t joined_images() const {
        return static_cast<uint32_t>(std::count_if(found->exposures.begin(), found->exposures.end(),
                                                   [](const lensprof_exposure &e) { return !std::isnan(e.ev); }));
    }
};

class CamerasFit {
public:
    CamerasFit(const lensprof_fit_options &options, const std::vector<lensprof_fit_image> &images,
               const std::vector<lensprof_pair> &pairs, const std::vector<lensprof_observation> &observations)
        : options_(options), images_(images), pairs_(pairs), observations_(observations) {}

    bool run(const FitCamera &fit, lensprof_exposure *exposures, lensprof_fit_result &result);

private:
    void part_images();
    void part_data();
    void link_images(Camera &camera);
    void fit_each(const FitCamera &fit, const lensprof_fit_result &result);
    uint32_t choose_base() const;
    bool light_of(const Camera &camera, const lensprof_pair &pair, int side, LightPair &light) const;
    std::vector<LightPair> light_pairs() const;
    void join(uint32_t base);
    void give(uint32_t base, lensprof_exposure *exposures, lensprof_fit_result &result) const;
    void give_images(const Camera &camera, bool is_joined, lensprof_exposure *exposures, lensprof_fit_result &r) const;
    void give_camera(uint32_t number, lensprof_fit_result &r) const;

    const lensprof_fit_options &options_;
    const std::vector<lensprof_fit_image> &images_;
    const std::vector<lensprof_pair> &pairs_;
    const std::vector<lensprof_observation> &observations_;
    std::vector<uint32_t> number_of_;  // of each camera here, the caller's
    std::vector<uint32_t> camera_of_;  // of each image, here
    std::vector<Camera> cameras_;
    std::vector<Joint> joints_;
};

// Numbers cameras as they come.
void CamerasFit::part_images() {
    std::map<uint32_t, uint32_t> numbers;
    for (uint32_t i = 0; i < images_.size(); i++) {
        const auto [found, is_new] = numbers.try_emplace(images_[i].camera, static_cast<uint32_t>(numbers.size()));
        if (is_new) {
            number_of_.push_back(images_[i].camera);
            cameras_.emplace_back();
            cameras_.back().place.assign(images_.size(), kNone);
        }
        Camera &camera = cameras_[found->second];
        camera_of_.push_back(found->second);
        camera.place[i] = static_cast<uint32_t>(camera.input.numbers.size());
        camera.input.numbers.push_back(i);
        camera.input.images.push_back(images_[i]);
    }
}

// Images that share unknowns with one of another camera share them with the first such image of their own.
void CamerasFit::link_images(Camera &camera) {
    for (uint32_t lensprof_fit_image::*of :
         {&lensprof_fit_image::ev_of, &lensprof_fit_image::red_of, &lensprof_fit_image::blue_of}) {
        std::map<uint32_t, uint32_t> first;  // by the image whose unknown it is
        for (uint32_t n = 0; n < camera.input.images.size(); n++) {
            const uint32_t owner = images_[camera.input.numbers[n]].*of;
            const uint32_t own = camera.place[owner] != kNone ? camera.place[owner] : n;
            camera.input.images[n].*of = first.try_emplace(owner, own).first->second;
        }
    }
}

void CamerasFit::part_data() {
    const auto camera_of = [&](const uint32_t image[2]) {
        return camera_of_[image[0]] == camera_of_[image[1]] ? &cameras_[camera_of_[image[0]]] : nullptr;
    };
    for (lensprof_pair pair : pairs_) {
        Camera *camera = camera_of(pair.image);
        if (!camera) continue;
        for (uint32_t &image : pair.image) image = camera->place[image];
        camera->input.pairs.push_back(pair);
    }
    for (uint32_t n = 0; n < options_.link_count; n++) {
        lensprof_link link = options_.links[n];
        Camera *camera = camera_of(link.image);
        if (!camera) continue;
        for (uint32_t &image : link.image) image = camera->place[image];
        camera->input.links.push_back(link);
    }
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> seen;  // camera and point: observations
    for (const lensprof_observation &o : observations_) seen[{camera_of_[o.image], o.point}]++;
    for (lensprof_observation o : observations_) {
        Camera &camera = cameras_[camera_of_[o.image]];
        if (seen[{camera_of_[o.image], o.point}] < 2) continue;
        o.image = camera.place[o.image];
        camera.input.observations.push_back(o);
    }
    for (Camera &camera : cameras_) {
        link_images(camera);
        camera.input.options = options_;
        camera.input.options.links = camera.input.links.data();
        camera.input.options.link_count = static_cast<uint32_t>(camera.input.links.size());
        const uint32_t own = camera.place[options_.reference];
        camera.input.options.reference = own == kNone ? 0 : own;
        // The falloff of a profile is of one setting, and its response of one camera.
        if (own == kNone) camera.input.options.profile = nullptr;
    }
}

void CamerasFit::fit_each(const FitCamera &fit, const lensprof_fit_result &result) {
    double done = 0.0;  // share of the images
    for (Camera &camera : cameras_) {
        const double own = static_cast<double>(camera.input.images.size()) / static_cast<double>(images_.size());
        PartOfProgress part{options_.progress, options_.progress_user, done, done + own};
        done += own;
        if (options_.progress)
            camera.input.options.progress = PartOfProgress::tell, camera.input.options.progress_user = &part;
        std::vector<lensprof_exposure> start;
        for (const lensprof_fit_image &image : camera.input.images) start.push_back(image.exposure);
        camera.found = std::make_unique<Output>(result, start.data(), static_cast<uint32_t>(start.size()));
        if (camera.input.images.size() < 2 || (camera.input.pairs.empty() && camera.input.observations.empty()))
            continue;
        camera.is_fitted = fit(camera.input, camera.found->exposures.data(), *camera.found->result);
    }
}

// The camera that the others are joined to: that of the reference, or where its pictures are not evened out that with
// most images which are.
uint32_t CamerasFit::choose_base() const {
    uint32_t base = camera_of_[options_.reference];
    if (cameras_[base].corrects()) return base;
    uint32_t most = 0;
    for (uint32_t k = 0; k < cameras_.size(); k++) {
        if (!cameras_[k].corrects() || cameras_[k].joined_images() <= most) continue;
        base = k, most = cameras_[k].joined_images();
    }
    for (uint32_t k = 0; k < cameras_.size() && !cameras_[base].is_fitted; k++)
        if (cameras_[k].is_fitted) base = k;
    return base;
}

// The light behind an end of a pair, by the fit of its camera. False where that does not tell it.
bool CamerasFit::light_of(const Camera &camera, const lensprof_pair &pair, int side, LightPair &light) const {
    const uint32_t own = camera.place[pair.image[side]];
    const lensprof_exposure &exposure = camera.found->exposures[own];
    if (!camera.corrects() || std::isnan(exposure.ev)) return false;
    const lensprof_fit_image &image = images_[pair.image[side]];
    const lensprof_fit_result &r = camera.result();
    const lensprof_vignetting *curves = camera.found->settings[image.setting].vignetting;
    const double noise = std::max(r.noise_levels, 0.5) / 255.0;
    for (uint32_t c = 0; c < options_.channels; c++) {
        const double b = pair.value[side][c];
        if (!(b > kDarkest && b < kWhite)) return false;
        double slope;
        const double x = lp_curve_invert(r.response.table, b, &slope);
        const lensprof_vignetting &curve = curves[options_.channels == 3 ? c : 0];
        const double m = lensprof_vignetting_eval(
            &curve,
            lensprof_vignetting_r2(&curve, image.width, image.height, pair.xy[side][0], pair.xy[side][1], nullptr),
            nullptr);
        const double white = options_.channels == 3 ? std::log(exposure.white_balance[c]) : 0.0;
        if (!(x > 0.0 && m > 0.0)) return false;
        light.log_light[side][c] = std::log(x) - std::log(m) - exposure.ev * kLn2 - white;
        light.variance[side][c] = std::pow(noise * slope / x, 2);
    }
    light.image[side] = pair.image[side];
    light.camera[side] = camera_of_[pair.image[side]];
    return true;
}

std::vector<LightPair> CamerasFit::light_pairs() const {
    std::vector<LightPair> light;
    for (const lensprof_pair &pair : pairs_) {
        const uint32_t a = camera_of_[pair.image[0]], b = camera_of_[pair.image[1]];
        LightPair own{};
        if (a != b && light_of(cameras_[a], pair, 0, own) && light_of(cameras_[b], pair, 1, own)) light.push_back(own);
    }
    return light;
}

// Moves every camera's result to where it agrees with the others.
void CamerasFit::join(uint32_t base) {
    std::vector<double> sigma;
    for (const Camera &camera : cameras_) {
        const bool is_open = camera.is_fitted && camera.result().gamma_from != LENSPROF_GAMMA_KNOWN;
        const bool is_unsettled = is_open && camera.result().gamma_from == LENSPROF_GAMMA_NONE;
        const bool is_base = &camera == &cameras_[base];
        sigma.push_back(!is_open || (is_unsettled && is_base) ? 0.0
                        : is_unsettled                        ? kUnsettledSigma
                                                              : camera.result().gamma_sigma);
    }
    joints_ = join_cameras(light_pairs(), sigma, base, static_cast<int>(options_.channels));
    for (uint32_t k = 0; k < cameras_.size(); k++) {
        const Joint &joint = joints_[k];
        Camera &camera = cameras_[k];
        if (!joint.joined || !camera.is_fitted) continue;
        lensprof_fit_result &r = *camera.found->result;
        if (joint.pairs && sigma[k] > 0.0) {
            std::set<uint32_t> settings;
            for (const lensprof_fit_image &image : camera.input.images) settings.insert(image.setting);
            raise_result(joint.log_gamma, joint.log_gamma_sigma, options_.free, settings, camera.found->exposures, r);
            if (joint.log_gamma_sigma < kBetter * sigma[k]) r.gamma_from = LENSPROF_GAMMA_CAMERAS;
        }
        if (k != base)
            offset_exposures(joint.offset, joint.offset_sigma, options_.channels, camera.found->exposures, r);
    }
}

// Exposures and qualities of a camera's images.
void CamerasFit::give_images(const Camera &camera, bool is_joined, lensprof_exposure *exposures,
                             lensprof_fit_result &r) const {
    for (uint32_t n = 0; n < camera.input.numbers.size(); n++) {
        const uint32_t i = camera.input.numbers[n];
        exposures[i] = camera.found->exposures[n];
        if (!is_joined) exposures[i].ev = std::numeric_limits<double>::quiet_NaN();
        if (!r.image_quality) continue;
        r.image_quality[i] = camera.found->quality[n];
        if (!camera.is_fitted) r.image_quality[i] = {};
        const uint32_t component = r.image_quality[i].component;
        r.image_quality[i].component = camera.is_fitted ? camera.input.numbers[component] : i;
        if (!is_joined) r.image_quality[i].joined = 0;
    }
}

template <class Verdict>
void renumber(const std::vector<uint32_t> &numbers, Verdict &verdict) {
    if (verdict.reason_item.kind != LENSPROF_ITEM_IMAGE || verdict.reason_item.index >= numbers.size()) return;
    verdict.reason_item.index = numbers[verdict.reason_item.index];
}

// A camera and its settings.
void CamerasFit::give_camera(uint32_t number, lensprof_fit_result &r) const {
    const Camera &camera = cameras_[number];
    const Joint &joint = joints_[number];
    lensprof_fit_camera &to = r.cameras[number_of_[number]];
    to.images = camera.is_fitted ? camera.joined_images() : 0;
    to.joined = camera.is_fitted && joint.joined;
    if (!camera.is_fitted) return;
    to.shared_pairs = joint.pairs;
    to.agreeing_share = joint.inlier_share;
    to.light_difference_ev = joint.residual / kLn2;
    to.log_gamma = joint.log_gamma;
    to.offset_sigma_ev = joint.offset_sigma / kLn2;
    copy_camera(camera.result(), to);
    to.reference = camera.input.numbers[camera.result().reference];
    to.setting = images_[to.reference].setting;
    for (const lensprof_fit_image &image : camera.input.images) {
        r.settings[image.setting] = camera.found->settings[image.setting];
        renumber(camera.input.numbers, r.settings[image.setting]);
    }
}

void CamerasFit::give(uint32_t base, lensprof_exposure *exposures, lensprof_fit_result &result) const {
    const Camera &first = cameras_[base];
    lensprof_fit_result r = first.result();
    r.image_quality = result.image_quality;
    r.settings = result.settings, r.setting_count = result.setting_count;
    r.cameras = result.cameras, r.camera_count = result.camera_count;
    renumber(first.input.numbers, r);
    r.reference = first.input.numbers[r.reference];
    r.left_out = 0;
    uint32_t left_out = kNone;
    for (uint32_t k = 0; k < cameras_.size(); k++) {
        give_images(cameras_[k], cameras_[k].is_fitted && joints_[k].joined, exposures, r);
        give_camera(k, r);
    }
    for (uint32_t i = 0; i < images_.size(); i++) {
        if (!std::isnan(exposures[i].ev)) continue;
        r.left_out++;
        left_out = std::min(left_out, i);
    }
    for_each_verdict(r, [&](auto &verdict) {
        const uint32_t code = verdict.reason_code;
        const bool is_lesser = code == LENSPROF_REASON_NONE || is_of_greys(code);
        if (verdict.usable && is_lesser && r.left_out)
            warn(verdict, of_image(LENSPROF_REASON_IMAGES_LEFT_OUT, left_out, {double(r.left_out)}));
    });
    result = r;
}

bool CamerasFit::run(const FitCamera &fit, lensprof_exposure *exposures, lensprof_fit_result &result) {
    part_images();
    part_data();
    fit_each(fit, result);
    const uint32_t base = choose_base();
    if (!cameras_[base].is_fitted) return false;
    join(base);
    give(base, exposures, result);
    return true;
}

}  // namespace

bool has_several_cameras(const lensprof_fit_options &options, const std::vector<lensprof_fit_image> &images) {
    return (options.free & LENSPROF_FREE_RESPONSE)
           && std::any_of(images.begin(), images.end(),
                          [&](const lensprof_fit_image &image) { return image.camera != images[0].camera; });
}

bool fit_cameras(const lensprof_fit_options &options, const std::vector<lensprof_fit_image> &images,
                 const std::vector<lensprof_pair> &pairs, const std::vector<lensprof_observation> &observations,
                 const FitCamera &fit, lensprof_exposure *exposures, lensprof_fit_result &result) {
    return CamerasFit(options, images, pairs, observations).run(fit, exposures, result);
}

}  // namespace lensprof
