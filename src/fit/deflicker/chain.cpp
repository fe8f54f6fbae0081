#include "fit/deflicker/chain.hpp"

#include <algorithm>
#include <cmath>

#include "fit/deflicker/shading.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kStride = 4;           // ratio of the distances of two levels of comparisons
constexpr size_t kLevels = 12;            // the last distance is 4^11 frames
constexpr size_t kMostWaiting = 3;        // frames that may disagree before those after them agree again
constexpr double kFewestValid = 0.05;     // share of the cells that a frame with information has
constexpr size_t kSlowLevel = 3;          // 4^3 frames
constexpr float kMemory = 0.9f;           // of the agreement of a cell, per ratio
constexpr double kAgreeingSpreads = 2.5;  // of the cells, within which one agrees
constexpr double kToneStep = 0.15;        // EV, smallest ratio that shows the response
constexpr double kSmallestSigma = 1e-4;   // EV, of a ratio

bool has_equal_cells(const FrameCells &a, const FrameCells &b) {
    for (size_t c = 0; c < 3; c++) {
        if (a.ev[c].size() != b.ev[c].size()) return false;
        for (size_t n = 0; n < a.ev[c].size(); n++)
            if (a.ev[c][n] != b.ev[c][n] && !(std::isnan(a.ev[c][n]) && std::isnan(b.ev[c][n]))) return false;
    }
    return true;
}

}  // namespace

double ToneSums::error_rms() const {
    double total = 0.0, mean = 0.0, square = 0.0;
    for (size_t n = 0; n < kBins; n++) total += weight[n], mean += error[n];
    if (!(total > 0.0)) return 0.0;
    mean /= total;
    double used = 0.0;
    for (size_t n = 0; n < kBins; n++) {
        if (weight[n] < 0.02 * total) continue;
        const double off = error[n] / weight[n] - mean;
        square += off * off, used += 1.0;
    }
    return used > 1.0 ? std::sqrt(square / used) : 0.0;
}

void FrameChain::note_agreement(size_t level, const FrameCells &cells, const FrameRatio &ratio) {
    if (ratio.shift[0] != 0.0 || ratio.shift[1] != 0.0) {
        agreement_.assign(kLevels, {});
        return;
    }
    const uint32_t main = main_channel(grid_);
    const std::vector<float> &before = kept_[level].cells.ev[main], &after = cells.ev[main];
    const auto limit = static_cast<float>(std::min(kAgreeingSpreads * ratio.spread, kAgreement));
    Agreement &agreement = agreement_[level];
    agreement.agreed.resize(after.size(), 0.0f);
    agreement.ratios = kMemory * agreement.ratios + 1.0f;
    for (size_t n = 0; n < after.size(); n++) {
        const float residual = after[n] - before[n] - static_cast<float>(ratio.ev[main]);
        agreement.agreed[n] = kMemory * agreement.agreed[n] + (std::abs(residual) < limit ? 1.0f : 0.0f);
    }
}

// Weights of the cells: those that often change over this or a shorter distance count little. What changes within some
// dozens of frames, such as slow clouds, biases the ratio of neighbours, too.
const std::vector<float> &FrameChain::steadiness(size_t level) {
    steadiness_.assign(grid_.cells(), 1.0f);
    for (size_t k = 0; k <= std::max(level, kSlowLevel); k++) {
        const Agreement &agreement = agreement_[k];
        for (size_t n = 0; n < agreement.agreed.size(); n++)
            steadiness_[n] = std::min(steadiness_[n], (agreement.agreed[n] + 1.0f) / (agreement.ratios + 2.0f));
    }
    for (float &share : steadiness_) share = share * share * share * share;
    return steadiness_;
}

void FrameChain::note_tones(const FrameCells &cells, const FrameRatio &ratio) {
    const uint32_t main = main_channel(grid_);
    const double step = ratio.ev[main];
    if (std::abs(step) < kToneStep || ratio.shift[0] != 0.0 || ratio.shift[1] != 0.0) return;
    const std::vector<float> &before = kept_[0].cells.ev[main], &after = cells.ev[main];
    for (size_t n = 0; n < after.size(); n++) {
        const double d = static_cast<double>(after[n] - before[n]);
        if (!(std::abs(d - step) < kAgreement + 0.3 * std::abs(step))) continue;
        const double tone = static_cast<double>(after[n] + before[n]) / 2.0;
        const auto bin = static_cast<size_t>(
            std::clamp(tone + static_cast<double>(ToneSums::kBins), 0.0, static_cast<double>(ToneSums::kBins) - 1.0));
        tones_.weight[bin] += step * step, tones_.error[bin] += step * (d - step);
    }
}

void FrameChain::start_segment(Kept first) {
    if (segment_frames_ > 0) segment_++;
    segment_frames_ = 0;
    kept_.clear(), agreement_.assign(kLevels, {});
    frames_[first.frame].shift = {};
    frames_[first.frame].rows.assign(has_rows_ ? grid_.rows : 0, 0.0f);
    append(first.frame, std::move(first.cells));
}

void FrameChain::append(uint32_t frame, FrameCells cells) {
    frames_[frame].state = LENSPROF_FRAME_LEVELLED;
    frames_[frame].segment = segment_;
    if (kept_.empty()) kept_.resize(kLevels);
    uint32_t distance = kStride;
    for (size_t level = 1; level < kLevels && segment_frames_ % distance == 0; level++, distance *= kStride) {
        if (segment_frames_ > 0) link_over(level, frame, cells);
        kept_[level] = {frame, cells};
    }
    kept_[0] = {frame, std::move(cells)};
    segment_frames_++;
}

void FrameChain::link_over(size_t level, uint32_t frame, const FrameCells &cells) {
    const Kept &earlier = kept_[level];
    CellShift shift = frames_[frame].shift;
    for (size_t a = 0; a < 2; a++) shift[a] -= frames_[earlier.frame].shift[a];
    const FrameRatio ratio = compare_frames(grid_, earlier.cells, cells, steadiness(level), shift);
    if (!ratio.is_valid()) return;
    links_.push_back({earlier.frame, frame, ratio.ev, std::max(ratio.sigma, kSmallestSigma),
                      std::exp2(2.0 * static_cast<double>(level))});
    note_agreement(level, cells, ratio);
}

void FrameChain::note_falloff(const FrameCells &cells, const FrameRatio &ratio, const ChainFrame &frame) {
    const double before = frames_[kept_[0].frame].f_number;
    if (!std::isfinite(before) || !std::isfinite(frame.f_number) || before == frame.f_number) return;
    falloff_steps_.push_back({before, frame.f_number, falloff_ratio(grid_, kept_[0].cells, cells, ratio)});
}

bool FrameChain::join(uint32_t frame, const FrameCells &cells) {
    const Kept &last = kept_[0];
    ChainFrame &f = frames_[frame];
    FrameRatio ratio = register_frames(grid_, last.cells, cells, steadiness(0), {});
    if (has_rows_) {  // the ratio of what is left without the flicker of lines
        f.rows = row_ratios(grid_, last.cells, cells, ratio);
        ratio = register_frames(grid_, last.cells, without_rows(grid_, cells, f.rows), steadiness(0), {});
        const std::vector<float> &before = frames_[last.frame].rows;
        for (size_t j = 0; j < before.size(); j++) f.rows[j] += before[j];
    }
    f.agreeing = ratio.agreeing, f.sigma = ratio.sigma;
    f.motion = std::hypot(ratio.shift[0], ratio.shift[1]);
    if (!ratio.is_valid()) {
        f.rows.clear();
        return false;
    }
    f.repeats = last.frame + 1 == frame && has_equal_cells(last.cells, cells);
    for (size_t a = 0; a < 2; a++) f.shift[a] = frames_[last.frame].shift[a] + ratio.shift[a];
    links_.push_back({last.frame, frame, ratio.ev, std::max(ratio.sigma, kSmallestSigma), 1.0});
    note_tones(cells, ratio);
    note_falloff(cells, ratio, f);
    note_agreement(0, cells, ratio);
    return true;
}

void FrameChain::add(FrameCells cells, const lensprof_deflicker_facts &facts) {
    const auto frame = static_cast<uint32_t>(frames_.size());
    ChainFrame next;
    next.seconds = facts.seconds, next.settings_ev = facts.settings_ev, next.f_number = facts.f_number;
    next.white_share = cells.white_share, next.dark_share = cells.dark_share;
    next.segment = segment_;
    const bool is_empty = cells.valid_share < kFewestValid;
    next.state = !is_empty                ? LENSPROF_FRAME_DISAGREES
                 : cells.dark_share > 0.5 ? LENSPROF_FRAME_DARK
                                          : LENSPROF_FRAME_WHITE;
    frames_.push_back(next);
    if (is_empty) return;
    if (kept_.empty()) return start_segment({frame, std::move(cells)});
    if (join(frame, cells)) {
        waiting_.clear();
        return append(frame, std::move(cells));
    }
    // A cut, if this frame continues one that disagreed.
    if (!waiting_.empty() && register_frames(grid_, waiting_.back().cells, cells, {}, {}).is_valid()) {
        std::vector<Kept> later;
        later.swap(waiting_);
        start_segment(std::move(later.back()));
        join(frame, cells);
        return append(frame, std::move(cells));
    }
    waiting_.push_back({frame, std::move(cells)});
    if (waiting_.size() <= kMostWaiting) return;
    Kept first = std::move(waiting_.back());
    waiting_.clear();
    start_segment(std::move(first));
}

void FrameChain::solve() {
    // What biases a ratio of neighbours, such as slow clouds, biases the next ones alike: the error of a sum of four is
    // four times theirs, not twice. A ratio over four times the distance therefore counts four times as much.
    std::vector<uint8_t> is_first(frames_.size(), 1);
    for (const ChainRatio &link : links_) is_first[link.to] = 0;
    const auto levels = chained_levels(links_, is_first, main_channel(grid_));
    for (size_t i = 0; i < frames_.size(); i++) frames_[i].ev = levels[i];
}

}  // namespace lensprof
