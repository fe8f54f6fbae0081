#include "fit/methods/cameras.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include <Eigen/Core>

#include "core/covariance.h"
#include "core/response.h"
#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/methods/group.hpp"
#include "fit/methods/join.hpp"
#include "fit/methods/raised.hpp"
#include "fit/problem/tracks.hpp"
#include "fit/verdict/finding.hpp"
#include "fit/verdict/judge.hpp"
#include "fit/verdict/output.hpp"

namespace lensprof {
namespace {

constexpr double kUndeterminedSigma = 1.0;  // of ln gamma if nothing determines it
constexpr double kBetter = 0.9;             // relative standard error below which other cameras determine gamma
// Uncertainty of a response's light at white, natural logarithm: no pair shows grey values near it, and exposures are
// defined by it. Over 60 pairs of measured responses of today's cameras the exposures of two cameras were .37 EV off,
// RMS, median .24.
constexpr double kWhiteSigma = 0.18;
constexpr double kDarkest = 2.0 / 255.0;

// Reports the progress of a camera's fit as a part of the whole.
struct PartOfProgress {
    lensprof_progress progress = nullptr;
    void *user = nullptr;
    double from = 0.0, to = 1.0;

    static int report(double done, void *part) {
        const auto &self = *static_cast<const PartOfProgress *>(part);
        return self.progress(self.from + (self.to - self.from) * done, self.user);
    }
};

// One camera: input and result of its fit.
struct Camera {
    CameraInput input;
    std::unique_ptr<Output> found;
    bool is_fitted = false;
    uint32_t attached = 0;  // images

    const FitResult &result() const { return *found->result; }
    bool corrects() const { return is_fitted && (result().usable || result().equalizes); }
    uint32_t joined_images() const {
        return static_cast<uint32_t>(std::count_if(found->exposures.begin(), found->exposures.end(),
                                                   [](const lensprof_exposure &e) { return !std::isnan(e.ev); }));
    }
};

class CamerasFit {
public:
    explicit CamerasFit(const CamerasData &data)
        : options_(data.options), images_(data.images), pairs_(data.pairs), camera_of_(camera_numbers(data.images)) {
        for (CameraInput &input : part_cameras(data, camera_of_)) cameras_.push_back({std::move(input), nullptr});
    }

    bool run(const FitCamera &fit, lensprof_exposure *exposures, FitResult &result);

private:
    void fit_each(const FitCamera &fit, const FitResult &result);
    uint32_t choose_base() const;
    bool light_of(const lensprof_pair &pair, int side, const lensprof_exposure &exposure, double log_light[3],
                  double variance[3]) const;
    std::vector<LightPair> light_pairs() const;
    double response_variance(uint32_t number) const;
    std::vector<double> gamma_sigmas(uint32_t base) const;
    void state_gamma(uint32_t number, const std::vector<double> &sigmas, double &sigma, uint32_t &from) const;
    void join(uint32_t base);
    void raise(uint32_t number, double gamma_sigma, uint32_t gamma_from, std::array<double, 3> &shift);
    void collect();
    void attach();
    void number_components();
    bool attach_image(uint32_t image, const std::vector<uint32_t> &pairs);
    void write(uint32_t base, lensprof_exposure *exposures, FitResult &result) const;
    void give_camera(uint32_t number, FitResult &r) const;
    void report_fewest_images(FitResult &r) const;
    lensprof_finding left_out_finding(uint32_t count, bool are_few) const;

    const lensprof_fit_options &options_;
    const std::vector<lensprof_fit_image> &images_;
    const std::vector<lensprof_pair> &pairs_;
    const std::vector<uint32_t> camera_of_;  // camera of each image, numbered in order of first appearance
    std::vector<Camera> cameras_;
    std::vector<Joint> joints_;
    std::vector<lensprof_exposure> exposures_;         // of all images, relative to the reference; ev NaN if not known
    std::vector<lensprof_fit_image_quality> quality_;  // of the same images
};

void CamerasFit::fit_each(const FitCamera &fit, const FitResult &result) {
    double done = 0.0;  // share of the images
    for (Camera &camera : cameras_) {
        const double share = static_cast<double>(camera.input.images.size()) / static_cast<double>(images_.size());
        PartOfProgress part{options_.progress, options_.progress_user, done, done + share};
        done += share;
        if (options_.progress)
            camera.input.options.progress = PartOfProgress::report, camera.input.options.progress_user = &part;
        std::vector<lensprof_exposure> start;
        for (const lensprof_fit_image &image : camera.input.images) start.push_back(image.exposure);
        camera.found = std::make_unique<Output>(result, start.data(), static_cast<uint32_t>(start.size()));
        if (!camera.input.has_data()) continue;
        camera.is_fitted = fit(camera.input, camera.found->exposures.data(), *camera.found->result);
    }
}

// Chooses the camera that the others are joined to: that of the reference or, if its pictures are not equalised, the
// camera with the most images among those whose pictures are.
uint32_t CamerasFit::choose_base() const {
    uint32_t base = camera_of_[options_.reference];
    if (cameras_[base].corrects()) return base;
    uint32_t max_images = 0;
    for (uint32_t k = 0; k < cameras_.size(); k++) {
        if (!cameras_[k].corrects() || cameras_[k].joined_images() <= max_images) continue;
        base = k, max_images = cameras_[k].joined_images();
    }
    for (uint32_t k = 0; k < cameras_.size() && !cameras_[base].is_fitted; k++)
        if (cameras_[k].is_fitted) base = k;
    return base;
}

// The light at an end of a pair, by the fit of its camera and this exposure of the image. False if it cannot be
// determined.
bool CamerasFit::light_of(const lensprof_pair &pair, int side, const lensprof_exposure &exposure, double log_light[3],
                          double variance[3]) const {
    const Camera &camera = cameras_[camera_of_[pair.image[side]]];
    const lensprof_fit_image &image = images_[pair.image[side]];
    if (!camera.corrects() || !camera.found->settings[image.setting].images || std::isnan(exposure.ev)) return false;
    const FitResult &r = camera.result();
    const lensprof_vignetting *curves = camera.found->settings[image.setting].vignetting;
    const double noise = std::max(r.noise_levels, 0.5) / 255.0;
    for (uint32_t c = 0; c < options_.channels; c++) {
        const double b = pair.value[side][c];
        if (!(b > kDarkest && b < kWhite)) return false;
        double slope;
        const double x = lp_curve_invert(r.response.table, b, &slope);
        const lensprof_vignetting &curve = curves[options_.channels == 3 ? c : 0];
        const double *xy = pair.xy[side];
        const double m = lensprof_vignetting_eval(
            &curve, lensprof_vignetting_r2(&curve, image.width, image.height, xy[0], xy[1], nullptr), nullptr);
        const double white = options_.channels == 3 ? std::log(exposure.white_balance[c]) : 0.0;
        if (!(x > 0.0 && m > 0.0)) return false;
        log_light[c] = std::log(x) - std::log(m) - exposure.ev * kLn2 - white;
        variance[c] = std::pow(noise * slope / x, 2);
    }
    return true;
}

std::vector<LightPair> CamerasFit::light_pairs() const {
    std::vector<LightPair> light;
    for (const lensprof_pair &pair : pairs_) {
        LightPair light_pair{};
        bool is_known = camera_of_[pair.image[0]] != camera_of_[pair.image[1]];
        for (int side = 0; side < 2 && is_known; side++) {
            const uint32_t image = pair.image[side], camera = camera_of_[image],
                           place = cameras_[camera].input.place[image];
            light_pair.image[side] = image, light_pair.camera[side] = camera;
            is_known = place != kNoPlace
                       && light_of(pair, side, cameras_[camera].found->exposures[place], light_pair.log_light[side],
                                   light_pair.variance[side]);
        }
        if (is_known) light.push_back(light_pair);
    }
    return light;
}

// Variance of the light at the grey values that a camera shares with others, natural logarithm, from the uncertainty of
// its response except gamma: the uncertainty of its light's scale relative to the others. A table only states that of
// white.
double CamerasFit::response_variance(uint32_t number) const {
    const Camera &camera = cameras_[number];
    const FitResult &r = camera.result();
    const double at_white = r.response_from == LENSPROF_FIT_RESPONSE_OPTIONS ? 0.0 : kWhiteSigma * kWhiteSigma;
    const uint32_t modes = lp_covariance_modes(&r.response, 1), size = r.covariance_size;
    if (!modes || size < modes) return at_white;
    Eigen::VectorXd slopes = Eigen::VectorXd::Zero(modes);  // mean derivative of ln f^-1 by each mode
    double count = 0.0;
    for (const lensprof_pair &pair : pairs_)
        for (int side = 0; side < 2; side++) {
            const uint32_t image = pair.image[side], other = pair.image[1 - side];
            const double b = pair.value[side][options_.channels == 3 ? 1 : 0];
            if (camera_of_[image] != number || camera_of_[other] == number || !(b > kDarkest && b < kWhite)) continue;
            double slope;
            const double x = lp_curve_invert(r.response.table, b, &slope);
            if (!(x > 0.0)) continue;
            for (uint32_t l = 0; l < modes; l++)
                slopes[l] -= slope / x * lp_curve_eval(lensprof_emor_table(l + 1), x, nullptr);
            count += 1.0;
        }
    if (!(count > 0.0)) return at_white;
    slopes /= count;
    const double gamma_sigma = std::max(r.gamma_sigma, 0.0);
    double variance = 0.0;
    for (uint32_t i = 0; i < modes; i++)
        for (uint32_t j = 0; j < modes; j++)
            variance += slopes[i] * slopes[j]
                        * (r.covariance[i * size + j]
                           - gamma_sigma * gamma_sigma * r.gamma_direction[i] * r.gamma_direction[j]);
    return at_white + std::max(0.0, variance);
}

// Standard error of ln gamma according to each camera's fit. If nothing determines any of them, that of the base is
// held.
std::vector<double> CamerasFit::gamma_sigmas(uint32_t base) const {
    std::vector<double> sigmas;
    bool is_any_determined = false;
    for (const Camera &camera : cameras_) {
        const bool is_known = !camera.is_fitted || camera.result().gamma_from == LENSPROF_GAMMA_KNOWN;
        const bool is_determined = is_known || camera.result().gamma_from != LENSPROF_GAMMA_NONE;
        is_any_determined = is_any_determined || (is_determined && camera.is_fitted);
        sigmas.push_back(is_known ? 0.0 : is_determined ? camera.result().gamma_sigma : kUndeterminedSigma);
    }
    if (!is_any_determined) sigmas[base] = 0.0;
    return sigmas;
}

// The final knowledge of ln gamma. If there are only pictures, the errors of the cameras' priors are correlated: no
// gamma is then known better than the best of them.
void CamerasFit::state_gamma(uint32_t number, const std::vector<double> &sigmas, double &sigma, uint32_t &from) const {
    double best = HUGE_VAL, best_other = HUGE_VAL;
    bool are_priors = true, is_undetermined = true;
    for (uint32_t k = 0; k < cameras_.size(); k++) {
        if (!joints_[k].joined || !cameras_[k].is_fitted) continue;
        best = std::min(best, sigmas[k]);
        if (k != number) best_other = std::min(best_other, sigmas[k]);
        const uint32_t gamma_from = cameras_[k].result().gamma_from;
        are_priors = are_priors && gamma_from == LENSPROF_GAMMA_PRIOR;
        is_undetermined = is_undetermined && gamma_from == LENSPROF_GAMMA_NONE;
    }
    sigma = joints_[number].log_gamma_sigma;
    if (are_priors) sigma = std::max(sigma, best);
    if (best_other < kBetter * sigmas[number]) from = LENSPROF_GAMMA_CAMERAS;
    if (is_undetermined) from = LENSPROF_GAMMA_NONE, sigma = LENSPROF_UNKNOWN;
}

// Moves every camera's result to agree with the others.
void CamerasFit::join(uint32_t base) {
    const std::vector<double> sigmas = gamma_sigmas(base);
    std::vector<double> variances;
    for (uint32_t k = 0; k < cameras_.size(); k++)
        variances.push_back(cameras_[k].is_fitted ? response_variance(k) : 0.0);
    const auto cancelled = [&] { return options_.progress && options_.progress(1.0, options_.progress_user) != 0; };
    joints_ = join_cameras(light_pairs(), sigmas, base, static_cast<int>(options_.channels), cancelled);
    std::vector<double> gamma_sigma(cameras_.size());
    std::vector<uint32_t> gamma_from(cameras_.size());
    for (uint32_t k = 0; k < cameras_.size(); k++) {
        if (!cameras_[k].is_fitted) continue;
        gamma_from[k] = cameras_[k].result().gamma_from;
        state_gamma(k, sigmas, gamma_sigma[k], gamma_from[k]);
    }
    std::array<double, 3> of_base{};
    for (uint32_t n = 0; n < cameras_.size(); n++) {
        const uint32_t k = n == 0 ? base : n <= base ? n - 1 : n;  // the base first
        if (!joints_[k].joined || !cameras_[k].is_fitted) continue;
        std::array<double, 3> offset{};
        if (joints_[k].pairs && sigmas[k] > 0.0) raise(k, gamma_sigma[k], gamma_from[k], offset);
        if (k == base) {
            of_base = offset;
            continue;
        }
        Joint &joint = joints_[k];
        const double gamma = std::exp(joint.log_gamma), gamma_of_base = std::exp(joints_[base].log_gamma);
        joint.offset_sigma = std::sqrt(joint.offset_sigma * joint.offset_sigma + gamma * gamma * variances[k]
                                       + gamma_of_base * gamma_of_base * variances[base]);
        for (size_t c = 0; c < 3; c++) offset[c] = joint.offset[c] + of_base[c] - offset[c];
        offset_exposures({offset, joint.offset_sigma, joint.balance_sigma}, options_.channels,
                         cameras_[k].found->exposures, *cameras_[k].found->result);
    }
}

// Raises a camera's result to its exponent. This holds the exposure of its reference, so that light l becomes gamma l +
// shift in each channel.
void CamerasFit::raise(uint32_t number, double gamma_sigma, uint32_t gamma_from, std::array<double, 3> &shift) {
    const Joint &joint = joints_[number];
    Camera &camera = cameras_[number];
    FitResult &r = *camera.found->result;
    const lensprof_exposure &zero = camera.found->exposures[r.reference];
    for (uint32_t c = 0; c < options_.channels; c++)
        shift[c] = (std::exp(joint.log_gamma) - 1.0)
                   * (zero.ev * kLn2 + (options_.channels == 3 ? std::log(zero.white_balance[c]) : 0.0));
    std::set<uint32_t> settings;
    for (const lensprof_fit_image &image : camera.input.images) settings.insert(image.setting);
    raise_result(joint.log_gamma, gamma_sigma, options_.free, settings, camera.found->exposures, r);
    r.gamma_from = gamma_from;
}

// Collects exposures and qualities of the images that are fitted.
void CamerasFit::collect() {
    exposures_.resize(images_.size());
    quality_.resize(images_.size());
    for (uint32_t i = 0; i < images_.size(); i++) {
        const Camera &camera = cameras_[camera_of_[i]];
        const bool is_joined = camera.is_fitted && joints_[camera_of_[i]].joined;
        const uint32_t place = camera.input.place[i];
        exposures_[i] = images_[i].exposure;
        quality_[i] = {};
        quality_[i].component = i;
        if (camera.is_fitted && place != kNoPlace) {
            exposures_[i] = camera.found->exposures[place];
            quality_[i] = camera.found->quality[place];
            quality_[i].component = camera.input.numbers[quality_[i].component];
        }
        if (is_joined && place != kNoPlace) continue;
        exposures_[i].ev = std::numeric_limits<double>::quiet_NaN();
        quality_[i].joined = 0;
    }
}

// Determines the exposure of an image that is not in its camera's fit, from pairs with images whose exposures are
// known. False if these are too few, or disagree.
bool CamerasFit::attach_image(uint32_t image, const std::vector<uint32_t> &pairs) {
    std::vector<double> log_exposure[3];
    lensprof_exposure zero;
    lensprof_exposure_init(&zero);
    double other_variance = 0.0;
    for (const uint32_t p : pairs) {
        const lensprof_pair &pair = pairs_[p];
        const int side = pair.image[1] == image, other = 1 - side;
        double image_light[3], other_light[3], unused[3];
        if (!light_of(pair, side, zero, image_light, unused)
            || !light_of(pair, other, exposures_[pair.image[other]], other_light, unused))
            continue;
        for (uint32_t c = 0; c < options_.channels; c++) log_exposure[c].push_back(image_light[c] - other_light[c]);
        other_variance += std::pow(quality_[pair.image[other]].ev_sigma, 2);
    }
    const size_t count = log_exposure[0].size();
    if (count < kMinJoiningPairs) return false;
    double found[3] = {}, sigma[3] = {};
    for (uint32_t c = 0; c < options_.channels; c++) {
        found[c] = median(log_exposure[c]);
        for (double &value : log_exposure[c]) value = std::abs(value - found[c]);
        const double scatter = median(log_exposure[c]);
        if (scatter > kLargestLightDifference) return false;
        sigma[c] = kMadToSigma * scatter / std::sqrt(static_cast<double>(count));
    }
    const uint32_t green = options_.channels == 3 ? 1 : 0;
    lensprof_fit_image_quality &quality = quality_[image];
    exposures_[image].ev = found[green] / kLn2;
    for (const uint32_t c : {0u, 2u}) {
        if (options_.channels == 1) break;
        exposures_[image].white_balance[c] = std::exp(found[c] - found[green]);
        quality.white_balance_sigma[c] = exposures_[image].white_balance[c] * std::hypot(sigma[c], sigma[green]);
    }
    const double of_response =
        joints_[camera_of_[image]].offset_sigma / kLn2;  // that of its own camera, and of the others
    quality.ev_sigma =
        std::hypot(sigma[green] / kLn2, std::sqrt(other_variance / static_cast<double>(count)), of_response);
    quality.pairs = quality.inliers = static_cast<uint32_t>(count);
    quality.joined = 1;
    return true;
}

// Joined images are one group.
void CamerasFit::number_components() {
    uint32_t first = kNoPlace;
    for (uint32_t i = 0; i < quality_.size(); i++) {
        if (!quality_[i].joined) continue;
        if (first == kNoPlace) first = i;
        quality_[i].component = first;
    }
}

// Attaches images that no pairs join to others of their camera, by pairs with other cameras: first those that share
// data with fitted images, then those that share data with these.
void CamerasFit::attach() {
    std::map<uint32_t, std::vector<uint32_t>>
        pairs_of;  // images that may be attached, and the pairs with an end in each
    const auto may_be = [&](uint32_t i) {
        const Camera &camera = cameras_[camera_of_[i]];
        return camera.input.place[i] == kNoPlace && camera.corrects() && joints_[camera_of_[i]].joined;
    };
    for (uint32_t p = 0; p < pairs_.size(); p++)
        for (const uint32_t image : pairs_[p].image)
            if (may_be(image)) pairs_of[image].push_back(p);
    for (bool any = true; any;) {
        any = false;
        for (const auto &[image, pairs] : pairs_of) {
            if (!std::isnan(exposures_[image].ev) || !attach_image(image, pairs)) continue;
            Camera &camera = cameras_[camera_of_[image]];
            camera.attached++, any = true;
            camera.found->settings[images_[image].setting].images++;
        }
    }
}

template <class Verdict>
void renumber(const std::vector<uint32_t> &numbers, Verdict &verdict) {
    for (lensprof_finding &finding : verdict.verdict)
        if (finding.item.kind == LENSPROF_ITEM_IMAGE && finding.item.index < numbers.size())
            rename_item(numbers[finding.item.index], finding);
}

// Writes a camera and its settings to the result.
void CamerasFit::give_camera(uint32_t number, FitResult &r) const {
    const Camera &camera = cameras_[number];
    const Joint &joint = joints_[number];
    CameraResult &result = r.cameras[camera.input.number];
    lensprof_fit_camera &to = result.joint;
    to.images = camera.is_fitted ? camera.joined_images() : 0;
    to.attached = camera.attached;
    to.joined = camera.is_fitted && joint.joined;
    if (!camera.is_fitted) return;
    to.shared_pairs = joint.pairs;
    to.agreeing_share = joint.inlier_share;
    to.irradiance_difference_ev = joint.residual / kLn2;
    to.log_gamma = joint.log_gamma;
    to.offset_sigma_ev = joint.offset_sigma / kLn2;
    copy_camera(camera.result(), result);
    to.reference = camera.input.numbers[camera.result().reference];
    to.setting = images_[to.reference].setting;
    for (const lensprof_fit_image &image : camera.input.images) {
        r.settings[image.setting] = camera.found->settings[image.setting];
        renumber(camera.input.numbers, r.settings[image.setting]);
    }
}

// Whether a finding is on images that are left out: those of all cameras replace those of one.
bool is_on_left_out(const lensprof_finding &finding) {
    return finding.code == LENSPROF_REASON_IMAGES_LEFT_OUT || finding.code == LENSPROF_REASON_IMAGES_UNCONNECTED;
}

// That `count` images of all cameras are left out: about those that disagree, if there are any. `are_few`: those that
// agree are too few.
lensprof_finding CamerasFit::left_out_finding(uint32_t count, bool are_few) const {
    uint32_t disagree = 0, first = UINT32_MAX;
    for (uint32_t k = 0; k < cameras_.size(); k++) {
        const Camera &camera = cameras_[k];
        if (!camera.is_fitted) continue;
        for (const lensprof_finding &finding : camera.result().verdict) {
            if (finding.code != LENSPROF_REASON_IMAGES_LEFT_OUT) continue;
            disagree += static_cast<uint32_t>(finding.value[0]);
            first = std::min(first, camera.input.numbers[finding.item.index]);
        }
        if (joints_[k].joined || !joints_[k].pairs) continue;
        disagree += camera.joined_images() + camera.attached;
        first = std::min(first, camera.input.numbers[camera.result().reference]);
    }
    uint32_t out = 0;  // the first
    while (out + 1 < exposures_.size() && !std::isnan(exposures_[out].ev)) out++;
    if (are_few) return found_by_method(LENSPROF_REASON_IMAGE_GROUPS, of_image(of_value(double(cameras_.size())), out));
    if (disagree) return found_by_method(LENSPROF_REASON_IMAGES_LEFT_OUT, of_image(of_value(disagree), first));
    return found_by_method(LENSPROF_REASON_IMAGES_UNCONNECTED, of_image(of_value(count), out));
}

// What the falloff of one camera is from is stated for the whole result: for the camera with the fewest images.
void CamerasFit::report_fewest_images(FitResult &r) const {
    const lensprof_finding *fewest = nullptr;
    for (uint32_t k = 0; k < cameras_.size(); k++) {
        if (!joints_[k].joined) continue;
        for (const lensprof_finding &finding : cameras_[k].result().verdict)
            if (finding.code == LENSPROF_REASON_FEW_IMAGES && finding.severity != LENSPROF_SEVERITY_PASSED
                && (!fewest || finding.measured < fewest->measured))
                fewest = &finding;
    }
    if (!fewest) return;
    remove_findings(r.verdict, [](const auto &finding) { return finding.code == LENSPROF_REASON_FEW_IMAGES; });
    report_last(r, *fewest);
}

void CamerasFit::write(uint32_t base, lensprof_exposure *exposures, FitResult &result) const {
    const Camera &first = cameras_[base];
    FitResult r = first.result();
    r.image_quality = result.image_quality;
    r.settings = result.settings, r.setting_count = result.setting_count;
    r.cameras = result.cameras, r.camera_count = result.camera_count;
    renumber(first.input.numbers, r);
    r.reference = first.input.numbers[r.reference];
    for (uint32_t k = 0; k < cameras_.size(); k++) give_camera(k, r);
    std::copy(exposures_.begin(), exposures_.end(), exposures);
    if (r.image_quality) std::copy(quality_.begin(), quality_.end(), r.image_quality);
    const auto is_out = [](const lensprof_exposure &exposure) { return std::isnan(exposure.ev); };
    r.left_out = static_cast<uint32_t>(std::count_if(exposures_.begin(), exposures_.end(), is_out));
    const bool are_few = 2 * r.left_out > images_.size();  // that agree
    const auto minority = minority_finding(options_, static_cast<uint32_t>(images_.size()), r);
    if (are_few || minority) {
        r.equalizes = 0;
        for (uint32_t k = 0; k < r.camera_count; k++) r.cameras[k].equalizes = 0;
    }
    const lensprof_finding left_out = left_out_finding(r.left_out, are_few);
    for_each_verdict(r, [&](auto &verdict) {
        Findings &own = verdict.verdict;
        remove_findings(own, is_on_left_out);
        if (r.left_out && !has_code(own, static_cast<lensprof_reason>(left_out.code))) report_first(verdict, left_out);
        if (minority && !are_few) report_first(verdict, *minority);
    });
    report_fewest_images(r);
    result = r;
}

bool CamerasFit::run(const FitCamera &fit, lensprof_exposure *exposures, FitResult &result) {
    fit_each(fit, result);
    const uint32_t base = choose_base();
    if (!cameras_[base].is_fitted) return false;
    join(base);
    collect();
    attach();
    number_components();
    write(base, exposures, result);
    return true;
}

}  // namespace

bool has_several_cameras(const lensprof_fit_options &options, const std::vector<lensprof_fit_image> &images) {
    return (options.free & LENSPROF_FREE_RESPONSE)
           && std::any_of(images.begin(), images.end(),
                          [&](const lensprof_fit_image &image) { return image.camera != images[0].camera; });
}

bool fit_cameras(const CamerasData &data, const FitCamera &fit, lensprof_exposure *exposures, FitResult &result) {
    return CamerasFit(data).run(fit, exposures, result);
}

}  // namespace lensprof
