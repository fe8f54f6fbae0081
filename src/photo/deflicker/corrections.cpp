#include "photo/deflicker/corrections.hpp"

#include <algorithm>
#include <filesystem>

#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/raw_kind.hpp"

namespace lensprof {
namespace {

// For the mark, by which the next run recognises the copy.
std::string mark_text(const LevelledFrame &frame, const MeasuredSequence &measured) {
    std::string text = format("deflicker %+.4f EV", frame.change_ev());
    for (const int c : {0, 2}) {
        const double factor = frame.wanted.white_balance[c] / frame.measured.exposure.white_balance[c];
        text += format(", %s %.4f", c == 0 ? "red" : "blue", factor);
    }
    return text + ", " + measured.response;
}

bool is_finished(const Correction &job) {
    if (!is_regular_file(job.target)) return false;
    try {
        const auto mark = read_metadata(job.target).mark;
        return mark && mark->model == job.model_name && mark->digest == digest_of(job.source)
               && mark->source == std::filesystem::path(job.source).filename().string();
    } catch (const Failure &failure) {
        if (!is_of_input(failure)) throw;
        return false;
    }
}

}  // namespace

std::shared_ptr<const lensprof_profile> frame_model(const MeasuredSequence &measured, uint32_t index) {
    lensprof_gain_grid shading;
    check(lensprof_deflicker_shading(measured.deflicker.get(), index, &shading, nullptr), "deflicker");
    if (shading.columns == 0) return measured.model;
    auto model = std::shared_ptr<lensprof_profile>(new_profile());
    check(lensprof_profile_copy(model.get(), measured.model.get()), "deflicker");
    model->grid = shading;
    return model;
}

std::vector<LevelledFrame> levelled_frames(const FrameSequence &sequence, const MeasuredSequence &measured,
                                           const std::vector<lensprof_exposure> &wanted) {
    std::vector<LevelledFrame> frames;
    for (size_t i = 0; i < sequence.frames.size(); i++)
        frames.push_back({sequence.frames[i].file, measured.frames[i], wanted[i]});
    return frames;
}

std::vector<Correction> levelled_copies(const std::vector<LevelledFrame> &frames, const MeasuredSequence &measured,
                                        const std::string &folder) {
    std::vector<Correction> jobs;
    for (uint32_t i = 0; i < frames.size(); i++) {
        const LevelledFrame &frame = frames[i];
        std::filesystem::path name = std::filesystem::path(frame.file).filename();
        if (raw_kind(frame.file) || is_read_alone(frame.file)) name.replace_extension(".tif");
        Correction job;
        job.source = frame.file;
        job.target = (std::filesystem::path(folder) / name).string();
        job.model = frame_model(measured, i);
        job.model_name = mark_text(frame, measured);
        job.exposure = frame.measured.exposure;
        job.target_exposure = frame.wanted;
        job.keeps_falloff = true;
        jobs.push_back(std::move(job));
    }
    return jobs;
}

size_t remove_finished(std::vector<Correction> &jobs) {
    const auto end = std::remove_if(jobs.begin(), jobs.end(), is_finished);
    const auto count = static_cast<size_t>(jobs.end() - end);
    jobs.erase(end, jobs.end());
    return count;
}

}  // namespace lensprof
