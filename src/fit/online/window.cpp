#include "fit/online/window.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "fit/base/quantile.hpp"
#include "fit/online/camera.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr double kWindowCutoff2 = 16.0;  // squared standard errors at which an observation has half its weight
constexpr double kLeastWindowNoise = 0.2 / 255.0;
constexpr double kHeld = 1e12;      // precision of the exposure that the others refer to
constexpr double kLoose = 1e-3;     // precision of exposures without observations
constexpr double kLeverage = 0.02;  // share of all information from which leaving out a track changes its pull
constexpr int kRadianceSteps = 3;

// The observations of one track in one channel, at its best radiance.
struct TrackEquations {
    double radiance = 0.0, pull = 0.0;  // precision of ln L, and its pull
    Globals globals = Globals::Zero();  // mixed with the globals
    Exposures exposures, pulls;         // mixed with the exposures, and the pulls on them
    GlobalMatrix both = GlobalMatrix::Zero();
    Globals global_pull = Globals::Zero();
    MixedMatrix mixed;

    explicit TrackEquations(int keyframes)
        : exposures(Exposures::Zero(keyframes)),
          pulls(Exposures::Zero(keyframes)),
          mixed(MixedMatrix::Zero(keyframes, kGlobals)) {}
    // The precision of the globals once ln L follows them.
    GlobalMatrix own_precision() const { return both - globals * (globals.transpose() / radiance); }
    // The same once, by `follow`, the exposures follow them.
    GlobalMatrix net_precision(const MixedMatrix &follow) const {
        const double unit = 1.0 / radiance;
        const MixedMatrix net_mixed = mixed - exposures * (unit * globals.transpose());
        ExposureMatrix own = -exposures * (unit * exposures.transpose());
        own.diagonal() += exposures;
        const GlobalMatrix cross = net_mixed.transpose() * follow;
        return own_precision() - cross - cross.transpose() + follow.transpose() * own * follow;
    }
    // The pulls on globals and exposures once ln L follows them.
    Globals net_globals() const { return global_pull - globals * (pull / radiance); }
    Exposures net_exposures() const { return pulls - exposures * (pull / radiance); }
};

using OmittedMixed = Eigen::Matrix<double, Eigen::Dynamic, kOmitted, 0, kMostKeyframes, kOmitted>;

class TrackView {
public:
    TrackView(const Memory &memory, uint32_t track, uint32_t channel, double noise)
        : memory_(memory),
          camera_(memory.state().camera),
          track_(memory.window_tracks()[track]),
          channel_(channel),
          noise_(noise) {}

    // Weight per observation; 0: outside of the range.
    struct Observed {
        Prediction at;
        double log_falloff, residual, weight;
        const Sighting *sighting;
    };

    template <class Use>
    void each(Use use) const {
        const State &state = memory_.state();
        for (int32_t i = track_.last; i != kNone; i = memory_.sightings()[i].next) {
            const Sighting &s = memory_.sightings()[i];
            Observed o{};
            o.sighting = &s;
            o.log_falloff = log_falloff_of(camera_, static_cast<double>(s.r2));
            const double a = memory_.keyframes()[s.keyframe].log_exposure[channel_];
            o.at = predict(camera_, track_.log_radiance[channel_] + a + o.log_falloff);
            const double unit = static_cast<double>(s.weight) / (noise_ * noise_);
            if (!is_inside(state, o.at.value, 1.0 / unit) || !(o.at.by_log > 0.0)) continue;
            o.residual = static_cast<double>(s.value[channel_]) - o.at.value;
            const double z = o.residual * o.residual * unit / kWindowCutoff2;
            o.weight = unit / (1.0 + z * z);
            use(o);
        }
    }

    void find_radiance() {
        for (int n = 0; n < kRadianceSteps; n++) {
            double precision = 0.0, pull = 0.0;
            each([&](const Observed &o) {
                precision += o.weight * o.at.by_log * o.at.by_log, pull += o.weight * o.at.by_log * o.residual;
            });
            if (!(precision > 0.0)) return;
            track_.log_radiance[channel_] += std::clamp(pull / precision, -0.5, 0.5);
        }
    }

    void equations(TrackEquations &track) const {
        double precision = 0.0;
        each([&](const Observed &o) { precision += o.weight * o.at.by_log * o.at.by_log; });
        each([&](Observed o) {
            o.residual += 0.5 * o.at.bend / precision;  // f is expected at a radiance that has an error
            Globals slope;
            by_globals(camera_, o.at, static_cast<double>(o.sighting->r2), o.log_falloff, slope);
            const double p = o.at.by_log, wp = o.weight * p;
            const auto k = static_cast<int>(o.sighting->keyframe);
            track.radiance += wp * p, track.pull += wp * o.residual;
            track.globals += wp * slope, track.global_pull += o.weight * o.residual * slope;
            track.exposures[k] += wp * p, track.pulls[k] += wp * o.residual;
            track.both += o.weight * slope * slope.transpose();
            track.mixed.row(k) += wp * slope.transpose();
        });
    }

private:
    const Memory &memory_;
    const Camera &camera_;
    WindowTrack &track_;
    uint32_t channel_;
    double noise_;
};

// Two observations do not show which of them is wrong.
bool is_checkable(const WindowTrack &track) { return track.count > 2; }

}  // namespace

Window::Window(const Memory &memory)
    : memory_(memory), keyframes_(static_cast<int>(memory.state().key_count)), noise_(memory.state().noise) {
    weigh();
    precision_.setZero(), pull_.setZero();
    for (uint32_t c = 0; c < memory.state().channels; c++) add_channel(c);
}

// The noise by the residuals of all tracks at their best radiances.
void Window::weigh() {
    double *values = memory_.values();
    size_t count = 0;
    const State &state = memory_.state();
    for (uint32_t t = 0; t < state.window_count; t++) {
        if (!is_checkable(memory_.window_tracks()[t])) continue;
        TrackView view(memory_, t, 0, noise_);
        view.find_radiance();
        const size_t first = count;
        view.each([&](const TrackView::Observed &o) {
            values[count++] = std::abs(o.residual) * std::sqrt(static_cast<double>(o.sighting->weight));
        });
        const auto seen = static_cast<double>(count - first);
        if (seen < 2.0) count = first;
        for (size_t i = first; i < count; i++) values[i] *= std::sqrt(seen / (seen - 1.0));
    }
    if (count > 1) noise_ = std::max(kMadToSigma * select(values, count, count / 2), kLeastWindowNoise);
}

void Window::add_channel(uint32_t channel) {
    ChannelEquations &sums = channels_[channel];
    sums.exposures = ExposureMatrix::Zero(keyframes_, keyframes_);
    sums.exposures.diagonal().setConstant(kLoose);
    sums.exposures(0, 0) = kHeld;
    sums.mixed = MixedMatrix::Zero(keyframes_, kGlobals), sums.pull = Exposures::Zero(keyframes_);
    sums.globals.setZero(), sums.global_pull.setZero();
    for (uint32_t t = 0; t < memory_.state().window_count; t++) {
        if (!is_checkable(memory_.window_tracks()[t])) continue;
        TrackView view(memory_, t, channel, noise_);
        view.find_radiance();
        TrackEquations track(keyframes_);
        view.equations(track);
        if (!(track.radiance > 0.0)) continue;
        const double unit = 1.0 / track.radiance;
        sums.globals += track.both - track.globals * (unit * track.globals.transpose());
        sums.mixed += track.mixed - track.exposures * (unit * track.globals.transpose());
        sums.exposures -= track.exposures * (unit * track.exposures.transpose());
        sums.exposures.diagonal() += track.exposures;
        sums.global_pull += track.net_globals(), sums.pull += track.net_exposures();
    }
    sums.exposures = sums.exposures.llt().solve(ExposureMatrix::Identity(keyframes_, keyframes_)).eval();
    const MixedMatrix follow = sums.exposures * sums.mixed;
    precision_ += sums.globals - sums.mixed.transpose() * follow;
    pull_ += sums.global_pull - follow.transpose() * sums.pull;
}

void Window::move_exposures(const Globals &step) const {
    for (uint32_t c = 0; c < memory_.state().channels; c++) {
        const ChannelEquations &sums = channels_[c];
        const Exposures change = sums.exposures * (sums.pull - sums.mixed * step);
        for (int k = 0; k < keyframes_; k++) memory_.keyframes()[k].log_exposure[c] += std::clamp(change[k], -0.5, 0.5);
    }
}

Omitted Window::omitted() const {
    const State &state = memory_.state();
    Omitted pulls = Omitted::Zero();
    for (uint32_t c = 0; c < state.channels; c++) {
        const MixedMatrix follow = channels_[c].exposures * channels_[c].mixed;
        OmittedMixed mixed = OmittedMixed::Zero(keyframes_, kOmitted);
        for (uint32_t t = 0; t < state.window_count; t++) {
            if (!is_checkable(memory_.window_tracks()[t])) continue;
            const TrackView view(memory_, t, c, noise_);
            double radiance = 0.0;
            OmittedSlope mean = OmittedSlope::Zero();
            view.each([&](const TrackView::Observed &o) {
                radiance += o.weight * o.at.by_log * o.at.by_log;
                mean += (o.weight * o.at.by_log) * omitted_by_sigma(state, o.at);
            });
            if (!(radiance > 0.0)) continue;
            mean /= radiance;
            view.each([&](const TrackView::Observed &o) {
                const OmittedSlope net = omitted_by_sigma(state, o.at) - o.at.by_log * mean;
                Globals slope;
                by_globals(state.camera, o.at, static_cast<double>(o.sighting->r2), o.log_falloff, slope);
                pulls += (o.weight * slope) * net.transpose();
                mixed.row(static_cast<int>(o.sighting->keyframe)) += (o.weight * o.at.by_log) * net.transpose();
            });
        }
        pulls -= follow.transpose() * mixed;
    }
    return pulls;
}

GlobalMatrix Window::scatter(const GlobalMatrix &inverse) const {
    GlobalMatrix scatter = GlobalMatrix::Zero();
    for (uint32_t c = 0; c < memory_.state().channels; c++) {
        const MixedMatrix follow = channels_[c].exposures * channels_[c].mixed;
        for (uint32_t t = 0; t < memory_.state().window_count; t++) {
            if (!is_checkable(memory_.window_tracks()[t])) continue;
            TrackEquations track(keyframes_);
            TrackView(memory_, t, c, noise_).equations(track);
            if (!(track.radiance > 0.0)) continue;
            const Globals pull = track.net_globals() - follow.transpose() * track.net_exposures();
            const GlobalMatrix alone = track.own_precision();
            Globals left_out = pull;
            if (alone.cwiseProduct(inverse).sum() > kLeverage)
                left_out =
                    (GlobalMatrix::Identity() - track.net_precision(follow) * inverse).partialPivLu().solve(pull);
            scatter += left_out * left_out.transpose();
        }
    }
    return scatter;
}

}  // namespace online
}  // namespace lensprof
