// Pictures corrected in strips of rows, several at once.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>

#include "cli/correct/correction.hpp"
#include "cli/correct/strip_pipeline.hpp"
#include "cli/fitting/project.hpp"
#include "cli/pictures/icc.hpp"
#include "cli/pictures/picture.hpp"
#include "cli/pictures/raw_kind.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/lookup_report.hpp"
#include "cli/program/interrupt.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/parallel.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

// Rows of a picture, as they were read and as they are written; `after` is empty where they change in place.
struct Strip {
    std::vector<uint8_t> before, after;
    lensprof_image written{};
};

// A plan in memory of its own.
class Plan {
public:
    Plan(const lensprof_apply_options &options, const std::string &item)
        : memory_(lensprof_plan_bytes(&options) / 8 + 1) {
        lensprof_error error{};
        check(lensprof_plan_init(memory_.data(), memory_.size() * 8, &options, &plan_, &error), item, &error);
    }
    const lensprof_plan *get() const { return plan_; }

private:
    std::vector<uint64_t> memory_;
    const lensprof_plan *plan_ = nullptr;
};

lensprof_apply_options options_of(const Picture &source, const Correction &job, const CorrectionKind &kind) {
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    options.direction = kind.simulate ? LENSPROF_DIRECTION_SIMULATE : LENSPROF_DIRECTION_CORRECT;
    options.output = kind.linear ? LENSPROF_ENCODING_LINEAR : LENSPROF_ENCODING_RESPONSE;
    options.strength = kind.strength;
    options.gain_cap = kind.gain_cap;
    options.dither = kind.dither;
    options.frame_width = source.frame_width;
    options.frame_height = source.frame_height;
    options.source_sample = source.sample;
    options.source_layout = source.layout;
    options.target_sample = kind.linear ? static_cast<uint32_t>(LENSPROF_SAMPLE_F32) : source.sample;
    check(lensprof_apply_options_set_profile(&options, job.model.get()), job.source);
    options.source = job.own;
    options.target = job.wanted;
    return options;
}

// The header of what becomes of a picture.
Picture header_of_result(const Picture &source, uint32_t sample) {
    Picture result = source;
    if (source.traits.format == FileFormat::raw) result.icc = linear_profile(source.layout == LENSPROF_LAYOUT_GREY);
    result.sample = sample;
    result.row_bytes =
        static_cast<size_t>(result.width) * lensprof_layout_samples(result.layout) * lensprof_sample_type_bytes(sample);
    return result;
}

// A picture that is complete beside its final name.
struct Finished {
    std::unique_ptr<PictureWriter> writer;
    std::unique_ptr<OutputFile> copy;  // in its place, of a DNG
    bool with_metadata = false;
};

// One picture on its way.
class PictureCorrection {
public:
    PictureCorrection(const Correction &job, const CorrectionKind &kind, bool thumbnails);

    // All of it, with the pixels of every strip told to `done`; encoded on a thread of its own if `split`.
    Finished run(bool split, Throughput &done);

    Thumbnail before, after;

private:
    bool make(Strip &strip);            // reads and corrects the next rows; false when there are no more
    uint64_t take(const Strip &strip);  // writes them; returns their number of pixels

    const Correction &job_;
    PictureReader reader_;
    const lensprof_apply_options options_;
    const Plan plan_;
    const Picture result_;  // no pixels
    std::unique_ptr<PictureWriter> writer_;
    const bool thumbnails_;
    uint32_t strip_rows_, next_row_ = 0;
};

bool has_falloff(const lensprof_profile &model) {
    const auto is_curved = [](const lensprof_vignetting &v) {
        return std::any_of(std::begin(v.k), std::end(v.k), [](double k) { return k != 0.0; });
    };
    return model.grid.columns != 0 || std::any_of(model.vignetting, model.vignetting + model.vignettings, is_curved);
}

CorrectionMark mark_of(const Correction &job, const CorrectionKind &kind) {
    using Falloff = CorrectionMark::Falloff;
    CorrectionMark mark;
    if (has_falloff(*job.model) && kind.strength > 0.0)
        mark.falloff = kind.simulate ? Falloff::added : Falloff::removed;
    mark.linear = kind.linear;
    mark.software = std::string("lensprof ") + lensprof_version();
    mark.model = job.model_name;
    mark.source = std::filesystem::path(job.source).filename().string();
    mark.digest = digest_of(job.source);
    return mark;
}

WriteOptions write_options(const Correction &job, const CorrectionKind &kind) {
    WriteOptions options;
    options.metadata_from = job.source;
    options.mark = mark_of(job, kind);
    return options;
}

PictureCorrection::PictureCorrection(const Correction &job, const CorrectionKind &kind, bool thumbnails)
    : job_(job),
      reader_(job.source),
      options_(options_of(reader_.header(), job, kind)),
      plan_(options_, job.source),
      result_(header_of_result(reader_.header(), options_.target_sample)),
      writer_(std::make_unique<PictureWriter>(job.target, result_, write_options(job, kind))),
      thumbnails_(thumbnails),
      strip_rows_(kind.strip_rows) {
    const Picture &source = reader_.header();
    if (strip_rows_ == 0)
        strip_rows_ = static_cast<uint32_t>(std::max<size_t>(strip_bytes / std::max<size_t>(source.row_bytes, 1), 1));
    if (!thumbnails_) return;
    before = Thumbnail(source.width, source.height);
    after = Thumbnail(source.width, source.height);
}

bool PictureCorrection::make(Strip &strip) {
    stop_if_interrupted();
    const Picture &source = reader_.header();
    uint32_t rows = std::min(strip_rows_, source.height - next_row_);
    if (rows == 0) return false;
    bool in_place = result_.sample == source.sample;
    strip.before.resize(source.row_bytes * rows);
    strip.after.resize(in_place ? 0 : result_.row_bytes * rows);
    lensprof_image from{strip.before.data(), static_cast<ptrdiff_t>(source.row_bytes),
                        source.width,        rows,
                        source.sample,       source.layout};
    strip.written = from;
    if (!in_place)
        strip.written = {strip.after.data(), static_cast<ptrdiff_t>(result_.row_bytes),
                         result_.width,      rows,
                         result_.sample,     result_.layout};
    reader_.read(from);
    check_finite(from, next_row_, 1, job_.source);
    if (thumbnails_) before.add(from);
    check(lensprof_apply(plan_.get(), &from, &strip.written, 0, next_row_), job_.source);
    if (thumbnails_) after.add(strip.written);
    next_row_ += rows;
    return true;
}

uint64_t PictureCorrection::take(const Strip &strip) {
    stop_if_interrupted();
    writer_->write(strip.written);
    return uint64_t(strip.written.width) * strip.written.height;
}

Finished PictureCorrection::run(bool split, Throughput &done) {
    make_and_take<Strip>(
        split, [&](Strip &strip) { return make(strip); }, [&](const Strip &strip) { done.add_pixels(take(strip)); });
    bool with_metadata = writer_->finish();
    return {std::move(writer_), nullptr, with_metadata};
}

// The falloff as an opcode; all else of the DNG stays as it is.
Finished copy_dng(const Correction &job) {
    auto output = std::make_unique<OutputFile>(job.target);
    write_opcodes(job.source, output->temporary(), *job.model);
    output->sync();
    return {nullptr, std::move(output), true};
}

}  // namespace

Corrected write_corrected(const std::vector<Correction> &jobs, const CorrectionKind &kind, ContactSheet *sheet,
                          Progress &progress) {
    auto count = static_cast<uint32_t>(jobs.size());
    uint32_t threads = thread_count(kind.threads);
    uint64_t pixels = 0;
    for (const Correction &job : jobs) pixels += job.pixels;
    Throughput throughput(progress, "correcting", count, pixels);
    if (sheet) sheet->reserve(count);
    std::vector<Finished> finished(count);
    auto work = [&](uint32_t i) {
        make_folder(std::filesystem::path(absolute_path(jobs[i].target)).parent_path().string());
        if (is_dng_name(jobs[i].target)) {
            finished[i] = copy_dng(jobs[i]);
            return;
        }
        PictureCorrection picture(jobs[i], kind, sheet != nullptr);
        finished[i] = picture.run(threads / 2 >= count, throughput);
        if (sheet) sheet->put(i, std::move(picture.before), std::move(picture.after));
    };
    Corrected corrected;
    auto finish = [&](uint32_t i) {
        finished[i].copy ? finished[i].copy->commit() : finished[i].writer->commit();
        finished[i] = {nullptr, nullptr, finished[i].with_metadata};
        throughput.add_picture();
        if (!finished[i].with_metadata)
            progress.warn(jobs[i].target + ": written without the metadata of " + jobs[i].source
                          + ", which are not read from or written to such a file (a BigTIFF); copy them with exiftool");
        Json entry = {{"file", jobs[i].source}, {"output", jobs[i].target}};
        if (jobs[i].profile_id) entry["profile"] = jobs[i].profile_id;
        if (jobs[i].lookup) entry["lookup"] = lookup_json(*jobs[i].lookup);
        corrected.pictures.push_back(entry);
    };
    for_each_in_order(count, threads, work, finish);
    corrected.seconds = throughput.seconds();
    corrected.megapixels = throughput.megapixels();
    if (count > 1) progress.say("corrected " + throughput.summary());
    return corrected;
}

}  // namespace lensprof
