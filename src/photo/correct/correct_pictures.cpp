// Corrects pictures in strips of rows, several in parallel.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>

#include "photo/base/events.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/throughput.hpp"
#include "photo/correct/copy_losses.hpp"
#include "photo/correct/correction.hpp"
#include "photo/correct/crop_plans.hpp"
#include "photo/correct/left_out_parts.hpp"
#include "photo/correct/lookup_report.hpp"
#include "photo/correct/opcode_copy.hpp"
#include "photo/correct/picture_plan.hpp"
#include "photo/correct/strip_pipeline.hpp"
#include "photo/pictures/icc.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/pictures/thumbnail.hpp"
#include "photo/scene/scene.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

// Rows of a picture, before and after correction; `after` is empty if they change in place.
struct Strip {
    std::vector<uint8_t> before, after;
    lensprof_target written{};
};

// A finished picture under its temporary name.
struct Finished {
    std::unique_ptr<PictureWriter> writer;
    std::unique_ptr<OutputFile> copy;  // instead of it, for a DNG
    std::optional<Failure> failure;    // instead of both
    bool with_metadata = false;
    double more_clipped = 0.0;  // share of the pixels that the correction clips, minus that clipped before
    bool keeps_offset = false;  // CopyLosses::add
};

// One picture in events.
class PictureCorrection {
public:
    // `thumbnail_side`: the longer side of the thumbnails, in pixels; 0 = none.
    PictureCorrection(const Correction &job, const CorrectionKind &kind, uint32_t thumbnail_side);

    // Corrects and writes the whole picture and reports the pixels of every strip to `done`; encodes on a separate
    // thread if `split`.
    Finished run(bool split, Throughput &done);

    // Corrects the whole picture for its thumbnails alone.
    void run_unwritten();

    SmallCopies small() const { return {before_.upright(1), after_.upright(1)}; }

private:
    bool make(Strip &strip);  // reads and corrects the next rows; false at the end

    const Correction &job_;
    const CorrectionKind &kind_;
    PictureReader reader_;
    const lensprof_apply_options options_;
    const Plan plan_;
    const CropPlans crops_;
    const Picture result_;  // no pixels
    ClippedPixels clipped_before_, clipped_after_;
    const bool has_no_offset_;  // the model, which belongs to the samples
    bool exceeds_one_ = false;
    const bool thumbnails_;
    Thumbnail before_, after_;
    uint32_t strip_rows_, next_row_ = 0;
};

PictureCorrection::PictureCorrection(const Correction &job, const CorrectionKind &kind, uint32_t thumbnail_side)
    : job_(job),
      kind_(kind),
      reader_(job.source),
      options_(options_of(reader_.header(), job, kind)),
      plan_(options_, job.source),
      crops_(reader_.header(), job, kind),
      result_(header_of_result(reader_.header(), options_.target_sample)),
      has_no_offset_(lacks_offset_of_counts(job) && reader_.header().sample == LENSPROF_SAMPLE_F32),
      thumbnails_(thumbnail_side > 0),
      strip_rows_(kind.strip_rows) {
    const Picture &source = reader_.header();
    if (strip_rows_ == 0)
        strip_rows_ = static_cast<uint32_t>(std::max<size_t>(strip_bytes / std::max<size_t>(source.row_bytes, 1), 1));
    if (!thumbnails_) return;
    before_ = after_ = Thumbnail(source.width, source.height, thumbnail_side);
}

bool PictureCorrection::make(Strip &strip) {
    stop_if_cancelled();
    const Picture &source = reader_.header();
    uint32_t rows = std::min(strip_rows_, source.height - next_row_);
    if (rows == 0) return false;
    bool in_place = result_.sample == source.sample;
    strip.before.resize(source.row_bytes * rows);
    strip.after.resize(in_place ? 0 : result_.row_bytes * rows);
    const lensprof_target read{strip.before.data(), static_cast<ptrdiff_t>(source.row_bytes),
                               source.width,        rows,
                               source.sample,       source.layout};
    const lensprof_image from = image_of(read);
    strip.written = read;
    if (!in_place)
        strip.written = {strip.after.data(), static_cast<ptrdiff_t>(result_.row_bytes),
                         result_.width,      rows,
                         result_.sample,     result_.layout};
    reader_.read(read);
    check_finite(from, next_row_, 1, job_.source);
    if (thumbnails_) before_.add(from);
    clipped_before_.add(from, next_row_);
    exceeds_one_ = exceeds_one_ || (has_no_offset_ && has_samples_above_one(from));
    if (job_.crops.empty())
        check(lensprof_apply(plan_.get(), &from, &strip.written, 0, next_row_), job_.source);
    else
        crops_.apply(plan_, from, strip.written, next_row_);
    if (thumbnails_) after_.add(image_of(strip.written));
    clipped_after_.add(image_of(strip.written), next_row_);
    next_row_ += rows;
    return true;
}

Finished PictureCorrection::run(bool split, Throughput &done) {
    auto writer = std::make_unique<PictureWriter>(job_.target, result_, write_options(job_, kind_));
    make_and_take<Strip>(
        split, [&](Strip &strip) { return make(strip); },
        [&](const Strip &strip) {
            stop_if_cancelled();
            writer->write(image_of(strip.written));
            done.add_pixels(uint64_t(strip.written.width) * strip.written.height);
        });
    const bool with_metadata = writer->finish();
    return {std::move(writer), nullptr, std::nullopt, with_metadata, clipped_after_.share() - clipped_before_.share(),
            exceeds_one_};
}

void PictureCorrection::run_unwritten() {
    for (Strip strip; make(strip);) {
    }
}

// Adds the falloff as an opcode; everything else of the DNG stays unchanged.
Finished copy_dng(const Correction &job) {
    auto output = std::make_unique<OutputFile>(job.target);
    write_opcodes(job.source, output->temporary(), *job.model);
    output->sync();
    return {nullptr, std::move(output), std::nullopt, true};
}

}  // namespace

SmallCopies small_copies_of(const Correction &job, const CorrectionKind &kind, uint32_t side) {
    PictureCorrection picture(job, kind, side);
    picture.run_unwritten();
    return picture.small();
}

Corrected write_corrected(const std::vector<Correction> &jobs, const CorrectionKind &kind, const CopySink *sink,
                          Events &events) {
    auto count = static_cast<uint32_t>(jobs.size());
    uint32_t threads = thread_count(kind.threads);
    uint64_t pixels = 0;
    for (const Correction &job : jobs) pixels += job.pixels;
    Throughput throughput(events, "correcting", count, pixels);
    std::vector<Finished> finished(count);
    const auto correct_one = [&](uint32_t i) {
        make_folder(std::filesystem::path(absolute_path(jobs[i].target)).parent_path().string());
        if (jobs[i].copies_dng) {
            finished[i] = copy_dng(jobs[i]);
            return;
        }
        PictureCorrection picture(jobs[i], kind, sink ? sink->side : 0);
        finished[i] = picture.run(threads / 2 >= count, throughput);
        if (sink) sink->put(i, picture.small());
    };
    auto work = [&](uint32_t i) {
        try {
            correct_one(i);
        } catch (const Failure &failure) {
            if (!is_of_input(failure)) throw;
            finished[i] = {nullptr, nullptr, failure};
            if (sink) sink->put(i, SmallCopies());
        }
    };
    Corrected corrected;
    LeftOutParts parts;
    CopyLosses losses;
    auto finish = [&](uint32_t i) {
        throughput.add_picture();
        if (finished[i].failure) {
            corrected.failed.push_back({jobs[i].source, *finished[i].failure});
            return;
        }
        finished[i].copy ? finished[i].copy->commit() : finished[i].writer->commit();
        parts.add(jobs[i].source, jobs[i].target);
        if (!kind.simulate) losses.add(jobs[i], finished[i].more_clipped, finished[i].keeps_offset);
        finished[i] = {nullptr, nullptr, std::nullopt, finished[i].with_metadata};
        warn_of_written(jobs[i], finished[i].with_metadata, events);
        Json entry = {{"file", jobs[i].source}, {"output", jobs[i].target}};
        if (jobs[i].profile_id) entry["profile"] = jobs[i].profile_id;
        if (jobs[i].lookup) entry["lookup"] = lookup_json(*jobs[i].lookup);
        corrected.pictures.push_back(entry);
    };
    try {
        for_each_in_order(count, threads, work, finish);
    } catch (...) {
        parts.warn(events);
        throw;
    }
    parts.warn(events);
    for (const std::string &text : losses.warnings()) events.warn({}, text);
    corrected.seconds = throughput.seconds();
    corrected.megapixels = throughput.megapixels();
    if (count > 1) events.finish("corrected " + throughput.summary());
    return corrected;
}

}  // namespace lensprof
