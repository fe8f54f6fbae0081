#include "photo/deflicker/measure.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <thread>

#include "photo/base/databases.hpp"
#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/calibration/sequence_fit.hpp"
#include "photo/calibration/stored_prior.hpp"
#include "photo/deflicker/frame_motion.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/scene/static_camera.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kReadSide = 480;  // px, of the reduced frames: five pixels to a cell
constexpr double kToneError = 0.03;  // of a response that does not fit
constexpr size_t kTestedSteps = 16;  // from one frame to the next that responses are tested with
constexpr uint32_t kFramesAhead = 64;
constexpr size_t kFittedFrames = 8;

using Deflicker = std::unique_ptr<lensprof_deflicker, DeflickerDestroy>;

struct Candidate {
    std::vector<lensprof_response> response;  // 1 or 3
    std::string name;
};

void add_frame(const Frame &frame, const Picture &picture, lensprof_deflicker &deflicker) {
    lensprof_deflicker_facts facts;
    lensprof_deflicker_facts_init(&facts);
    facts.seconds = frame.seconds, facts.settings_ev = frame.settings_ev;
    if (frame.metadata.f_number) facts.f_number = *frame.metadata.f_number;
    const lensprof_image view = picture.view();
    lensprof_error error{};
    const lensprof_status status = lensprof_deflicker_add(&deflicker, &view, &facts, &error);
    if (status != LENSPROF_OK) throw Failure(LENSPROF_ERROR_READ, frame.file + ": " + error.text);
}

lensprof_deflicker_result result_of(lensprof_deflicker &deflicker, const std::string &item) {
    lensprof_deflicker_result result;
    lensprof_deflicker_result_init(&result);
    lensprof_error error{};
    check(lensprof_deflicker_measure(&deflicker, &result, &error), item, &error);
    return result;
}

// Reads the frames in parallel, and adds them in order. Frames that fail get a reason.
class Reading {
public:
    Reading(const MeasureOptions &o, const std::vector<const Frame *> &frames, Events &events)
        : options_(o), frames_(frames), events_(events), pictures_(frames.size()), reasons_(frames.size()) {}

    void run(lensprof_deflicker &deflicker, bool is_checked) {
        const auto count = static_cast<uint32_t>(frames_.size());
        next_ = 0;
        for_each_in_order(
            count, thread_count(options_.threads), [&](uint32_t i) { or_fail([&] { read(i); }); },
            [&](uint32_t i) {
                or_fail([&] {
                    const bool is_added = reasons_[i].empty() && take(i, deflicker);
                    if (is_added) added_.push_back(frames_[i]);
                    pictures_[i] = Picture();
                    events_.update_items("measuring", i + 1, count);
                    if (is_checked) check_motion(is_added, i + 1 == count, deflicker);
                    next_ = i + 1;
                });
            });
    }

    const std::vector<std::string> &reasons() const { return reasons_; }

private:
    // Threads that wait must not wait for one that failed.
    template <class Work>
    void or_fail(const Work &work) {
        try {
            work();
        } catch (...) {
            failed_ = true;
            throw;
        }
    }

    // Waits until few frames are between this one and the one that is compared next, so that memory is bounded.
    void read(uint32_t i) {
        while (i >= next_ + kFramesAhead && !failed_) {
            stop_if_cancelled();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        try {
            pictures_[i] = read_picture(frames_[i]->file, {kReadSide});
        } catch (const Failure &failure) {
            if (!is_of_input(failure)) throw;
            reasons_[i] = failure.what();
        }
    }

    bool take(uint32_t i, lensprof_deflicker &deflicker) {
        try {
            add_frame(*frames_[i], pictures_[i], deflicker);
            return true;
        } catch (const Failure &failure) {
            if (!is_of_input(failure)) throw;
            reasons_[i] = failure.what();
            return false;
        }
    }

    // After the first frames, and the last.
    void check_motion(bool is_added, bool is_last, lensprof_deflicker &deflicker) {
        const size_t added = added_.size();
        const bool ends_early = is_last && added < warning_frames;
        if (!ends_early && (!is_added || (added != refusal_frames && added != warning_frames))) return;
        lensprof_deflicker_result result;
        lensprof_deflicker_result_init(&result);
        if (lensprof_deflicker_measure(&deflicker, &result, nullptr) != LENSPROF_OK) return;
        if (added == refusal_frames && result.moving && result.levelled >= refusal_frames / 2)
            refuse_moving(*added_[0], result);
        if ((added == warning_frames || ends_early) && !result.moving) warn_of_motion(deflicker, added_, events_);
    }

    const MeasureOptions &options_;
    const std::vector<const Frame *> &frames_;
    std::vector<const Frame *> added_;  // those of them without a reason
    Events &events_;
    std::vector<Picture> pictures_;
    std::vector<std::string> reasons_;
    std::atomic<uint32_t> next_{0};
    std::atomic<bool> failed_{false};
};

std::vector<const Frame *> pointers_to(const std::vector<Frame> &frames) {
    std::vector<const Frame *> all;
    for (const Frame &frame : frames) all.push_back(&frame);
    return all;
}

bool is_linear(const Frame &frame) {
    const uint32_t processing = frame.metadata.key.processing;
    return processing == LENSPROF_PROCESSING_RAW;
}

// The response of a stored profile of the camera; none without one.
std::optional<Candidate> stored_candidate(const MeasureOptions &o, const Frame &frame) {
    const lensprof_profile_key &key = frame.metadata.key;
    if (!*key.camera_model) return std::nullopt;
    StoreOptions store;
    store.dbs = existing_databases(o.dbs);
    if (store.dbs.empty()) return std::nullopt;
    store.db = store.dbs[0], store.no_store = true;
    const EarlierProfile found = find_stored_prior(store, 0, false, key, "");
    if (!found.profile || found.profile->response[0].kind == LENSPROF_RESPONSE_LINEAR) return std::nullopt;
    const lensprof_profile &profile = *found.profile;
    return Candidate{{profile.response, profile.response + profile.responses},
                     "response of profile " + std::to_string(found.id)};
}

// The steps between neighbouring frames that show the response best: the largest.
std::vector<const Frame *> test_frames(const FrameSequence &sequence,
                                       const std::vector<lensprof_deflicker_frame> &measured) {
    std::vector<size_t> steps;
    const auto change = [&](size_t i) { return std::abs(measured[i + 1].exposure.ev - measured[i].exposure.ev); };
    for (size_t i = 0; i + 1 < measured.size(); i++)
        if (measured[i].state == LENSPROF_FRAME_LEVELLED && measured[i + 1].state == LENSPROF_FRAME_LEVELLED
            && measured[i].segment == measured[i + 1].segment)
            steps.push_back(i);
    std::stable_sort(steps.begin(), steps.end(), [&](size_t a, size_t b) { return change(a) > change(b); });
    steps.resize(std::min(steps.size(), kTestedSteps));
    std::sort(steps.begin(), steps.end());
    std::vector<const Frame *> frames;
    for (const size_t i : steps)
        for (const size_t n : {i, i + 1})
            if (frames.empty() || frames.back() != &sequence.frames[n]) frames.push_back(&sequence.frames[n]);
    return frames;
}

double tone_error_of(const MeasureOptions &o, const Candidate &candidate, const std::vector<const Frame *> &frames,
                     Events &events) {
    std::vector<Frame> untimed;  // neighbours in the test need not be neighbours in time
    for (const Frame *frame : frames) untimed.push_back({frame->file, frame->metadata});
    const Deflicker deflicker = new_deflicker(o, candidate.response, frames[0]->metadata.size);
    const std::vector<const Frame *> all = pointers_to(untimed);
    Reading(o, all, events).run(*deflicker, false);
    const lensprof_deflicker_result result = result_of(*deflicker, frames[0]->file);
    return result.tone_error > 0.0 ? result.tone_error + result.unlinked : 1.0;  // frames do not even agree
}

// A response fitted to frames whose exposures are spread evenly.
std::optional<Candidate> fitted_candidate(const FrameSequence &sequence,
                                          const std::vector<lensprof_deflicker_frame> &measured, Events &events) {
    try {
        const std::vector<std::string> files = frames_of_all_exposures(sequence, measured, kFittedFrames);
        Scene scene = static_scene(files, true);
        scene.reference = 0;
        const Fitted fitted = fit_sequence(scene, {}, {}, events);
        if (!fitted.corrects()) return std::nullopt;
        return Candidate{{fitted.result.response}, "response fitted to " + counted(files.size(), "frame")};
    } catch (const Failure &failure) {
        if (!is_of_input(failure)) throw;
        return std::nullopt;
    }
}

std::vector<lensprof_deflicker_frame> frames_of(const lensprof_deflicker &deflicker, size_t count) {
    std::vector<lensprof_deflicker_frame> frames(count);
    for (uint32_t i = 0; i < count; i++) {
        lensprof_deflicker_frame_init(&frames[i]);
        check(lensprof_deflicker_frame_at(&deflicker, i, &frames[i], nullptr), "deflicker");
    }
    return frames;
}

// Measures all frames with one response, and leaves out those that cannot be read.
void measure_with(const MeasureOptions &o, const Candidate &candidate, bool is_checked, FrameSequence &sequence,
                  MeasuredSequence &measured, Events &events) {
    measured.deflicker = new_deflicker(o, candidate.response, sequence.frames[0].metadata.size);
    const std::vector<const Frame *> all = pointers_to(sequence.frames);
    Reading reading(o, all, events);
    reading.run(*measured.deflicker, is_checked);
    events.clear();
    std::vector<Frame> kept;
    for (size_t i = 0; i < sequence.frames.size(); i++) {
        if (reading.reasons()[i].empty())
            kept.push_back(std::move(sequence.frames[i]));
        else
            sequence.left_out.push_back({sequence.frames[i].file, reading.reasons()[i]});
    }
    sequence.frames = std::move(kept);
    if (sequence.frames.size() < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      (sequence.left_out.empty() ? std::string() : sequence.left_out[0].reason + "; ")
                          + "fewer than two frames can be read",
                      LENSPROF_REASON_FEW_PAIRS);
    take_measurement(sequence.frames[0].file, sequence.frames.size(), measured);
    measured.response = candidate.name;
    auto model = std::shared_ptr<lensprof_profile>(new_profile());
    model->responses = static_cast<uint32_t>(candidate.response.size());
    std::copy(candidate.response.begin(), candidate.response.end(), model->response);
    measured.model = model;
}

}  // namespace

Deflicker new_deflicker(const MeasureOptions &o, const std::vector<lensprof_response> &response,
                        const PictureSize &size) {
    lensprof_deflicker_options options;
    lensprof_deflicker_options_init(&options);
    options.response = response.data();
    options.responses = static_cast<uint32_t>(response.size());
    options.rows = o.rows;
    if (!o.region_px.empty()) {
        const double w = size.width, h = size.height;
        options.region[0] = o.region_px[0] / w, options.region[1] = o.region_px[1] / h;
        options.region[2] = std::min((o.region_px[0] + o.region_px[2]) / w, 1.0);
        options.region[3] = std::min((o.region_px[1] + o.region_px[3]) / h, 1.0);
    }
    lensprof_deflicker *made = nullptr;
    lensprof_error error{};
    check(lensprof_deflicker_create(&options, &made, &error), "deflicker", &error);
    return Deflicker(made);
}

void take_measurement(const std::string &item, size_t count, MeasuredSequence &measured) {
    measured.result = result_of(*measured.deflicker, item);
    measured.frames = frames_of(*measured.deflicker, count);
}

uint32_t first_levelled(const std::vector<lensprof_deflicker_frame> &frames) {
    for (uint32_t i = 0; i < frames.size(); i++)
        if (frames[i].state == LENSPROF_FRAME_LEVELLED) return i;
    return 0;
}

bool shows_still_camera(const std::vector<Frame> &frames, Events &events) {
    constexpr double kStillShift = 0.002, kStillAgreeing = 0.3;  // share of the longer side; share of the cells
    if (frames.size() < refusal_frames) return false;
    std::vector<Frame> spread;
    for (size_t n = 0; n < refusal_frames; n++) {
        const Frame &frame = frames[n * (frames.size() - 1) / (refusal_frames - 1)];
        spread.push_back({frame.file, frame.metadata});
    }
    lensprof_response srgb;
    lensprof_response_set_srgb(&srgb);
    const MeasureOptions options;
    const Deflicker deflicker = new_deflicker(options, {srgb}, spread[0].metadata.size);
    const std::vector<const Frame *> all = pointers_to(spread);
    Reading reading(options, all, events);
    reading.run(*deflicker, false);
    events.clear();
    const auto &reasons = reading.reasons();
    if (std::any_of(reasons.begin(), reasons.end(), [](const std::string &reason) { return !reason.empty(); }))
        return false;
    lensprof_deflicker_result result;
    lensprof_deflicker_result_init(&result);
    if (lensprof_deflicker_measure(deflicker.get(), &result, nullptr) != LENSPROF_OK || result.levelled < refusal_frames
        || result.segments != 1)
        return false;
    const auto measured = frames_of(*deflicker, refusal_frames);
    return std::all_of(measured.begin() + 1, measured.end(), [](const lensprof_deflicker_frame &frame) {
        return std::hypot(frame.shift[0], frame.shift[1]) < kStillShift && frame.agreeing > kStillAgreeing;
    });
}

uint32_t longest_segment(const std::vector<lensprof_deflicker_frame> &measured) {
    std::map<uint32_t, size_t> frames;
    for (const lensprof_deflicker_frame &frame : measured)
        if (frame.state == LENSPROF_FRAME_LEVELLED) frames[frame.segment]++;
    uint32_t longest = 0;
    for (const auto &[segment, count] : frames)
        if (count > frames[longest]) longest = segment;
    return longest;
}

std::vector<std::string> frames_of_all_exposures(const FrameSequence &sequence,
                                                 const std::vector<lensprof_deflicker_frame> &measured, size_t most) {
    std::vector<size_t> order;
    const uint32_t segment = longest_segment(measured);
    for (size_t i = 0; i < measured.size(); i++)
        if (measured[i].state == LENSPROF_FRAME_LEVELLED && measured[i].segment == segment) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return measured[a].exposure.ev < measured[b].exposure.ev; });
    const size_t count = std::min(order.size(), most);
    std::vector<std::string> files;
    for (size_t n = 0; n < count; n++)
        files.push_back(sequence.frames[order[count > 1 ? n * (order.size() - 1) / (count - 1) : 0]].file);
    return files;
}

std::vector<lensprof_exposure> MeasuredSequence::curve(const lensprof_deflicker_target &target, double &window) const {
    std::vector<lensprof_exposure> wanted(frames.size());
    lensprof_error error{};
    check(lensprof_deflicker_curve(deflicker.get(), &target, wanted.data(), static_cast<uint32_t>(wanted.size()),
                                   &window, &error),
          "deflicker", &error);
    return wanted;
}

MeasuredSequence measure_frames(const MeasureOptions &o, FrameSequence &sequence, Events &events) {
    const Frame &first = sequence.frames[0];
    lensprof_response linear, srgb;
    lensprof_response_set_linear(&linear), lensprof_response_set_srgb(&srgb);
    std::vector<Candidate> candidates;
    if (o.response) {
        candidates.push_back({{*o.response}, "given response"});
    } else if (is_linear(first)) {
        candidates.push_back({{linear}, "linear"});
    } else {
        if (auto stored = stored_candidate(o, first)) candidates.push_back(std::move(*stored));
        candidates.push_back({{srgb}, "sRGB"});
    }
    MeasuredSequence measured;
    measure_with(o, candidates[0], true, sequence, measured, events);
    if (measured.result.moving) refuse_moving(sequence.frames[0], measured.result);
    if (o.response || is_linear(sequence.frames[0]) || measured.result.tone_error <= kToneError) return measured;
    // Ratios of dark and bright tones contradict the response: another one is chosen by the frames that show it best.
    const std::vector<const Frame *> tested = test_frames(sequence, measured.frames);
    if (auto fitted = fitted_candidate(sequence, measured.frames, events)) candidates.push_back(std::move(*fitted));
    size_t best = 0;
    double least = INFINITY;
    for (size_t n = 0; n < candidates.size() && least > kToneError; n++) {
        const double error = tone_error_of(o, candidates[n], tested, events);
        if (error < least) best = n, least = error;
    }
    if (best > 0) measure_with(o, candidates[best], false, sequence, measured, events);
    return measured;
}

}  // namespace lensprof
