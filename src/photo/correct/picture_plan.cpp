#include "photo/correct/picture_plan.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "photo/base/output_file.hpp"
#include "photo/pictures/icc.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

namespace {

// Linear floating point of which only the falloff is corrected may hold counts, and is not clipped at 1. Where exposure
// or white balance change, what is white at 1 has to stay so.
bool holds_counts(const Picture &source, const Correction &job) {
    const lensprof_profile &model = *job.model;
    const bool is_linear = std::all_of(model.response, model.response + model.responses,
                                       [](const lensprof_response &r) { return r.kind == LENSPROF_RESPONSE_LINEAR; });
    const lensprof_exposure &from = job.exposure, &to = job.target_exposure;
    return source.sample == LENSPROF_SAMPLE_F32 && is_linear && !job.encoding && from.ev == to.ev
           && std::equal(from.white_balance, from.white_balance + 3, to.white_balance);
}

}  // namespace

lensprof_apply_options options_of(const Picture &source, const Correction &job, const CorrectionKind &kind) {
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    options.direction = kind.simulate ? LENSPROF_DIRECTION_SIMULATE : LENSPROF_DIRECTION_CORRECT;
    options.output = kind.linear ? LENSPROF_ENCODING_LINEAR : LENSPROF_ENCODING_RESPONSE;
    options.strength = kind.strength;
    options.gain_cap = kind.gain_cap;
    options.dither = kind.dither;
    options.chroma = kind.chroma;
    options.frame_width = source.frame_width;
    options.frame_height = source.frame_height;
    options.source_sample = source.sample;
    options.source_layout = source.layout;
    options.target_sample = kind.linear ? static_cast<uint32_t>(LENSPROF_SAMPLE_F32) : source.sample;
    check(lensprof_apply_options_set_profile(&options, job.model.get()), job.source);
    const bool is_raw = source.traits.format == FileFormat::raw;  // its own levels were applied when it was read
    if (holds_counts(source, job)) options.input = options.output = LENSPROF_ENCODING_LINEAR;
    if (is_raw) options.levels = nullptr;
    if (job.levels) options.levels = options.output_levels = job.levels.get();
    if (kind.linear || is_raw) options.output_levels = nullptr;  // 0 is black there
    if (job.encoding) options.output_response = job.encoding.get(), options.output_responses = 1;
    options.source = job.exposure;
    options.target = job.target_exposure;
    return options;
}

Picture header_of_result(const Picture &source, uint32_t sample) {
    Picture result = source;
    if (source.traits.format == FileFormat::raw) result.icc = linear_profile(source.layout == LENSPROF_LAYOUT_GREY);
    result.sample = sample;
    result.row_bytes =
        static_cast<size_t>(result.width) * lensprof_layout_samples(result.layout) * lensprof_sample_type_bytes(sample);
    return result;
}

namespace {

bool has_falloff(const lensprof_profile &model) {
    const auto is_curved = [](const lensprof_vignetting &v) {
        return std::any_of(std::begin(v.k), std::end(v.k), [](double k) { return k != 0.0; });
    };
    return model.grid.columns != 0 || std::any_of(model.vignetting, model.vignetting + model.vignettings, is_curved);
}

CorrectionMark mark_of(const Correction &job, const CorrectionKind &kind) {
    using Falloff = CorrectionMark::Falloff;
    CorrectionMark mark;
    const bool crops_have = std::any_of(job.crops.begin(), job.crops.end(),
                                        [](const CropCorrection &crop) { return has_falloff(*crop.model); });
    if (!job.keeps_falloff && (has_falloff(*job.model) || crops_have) && kind.strength > 0.0)
        mark.falloff = kind.simulate ? Falloff::added : Falloff::removed;
    mark.linear = kind.linear;
    mark.software = std::string("lensprof ") + lensprof_version();
    mark.model = job.model_name;
    mark.source = std::filesystem::path(job.source).filename().string();
    mark.digest = digest_of(job.source);
    return mark;
}

}  // namespace

WriteOptions write_options(const Correction &job, const CorrectionKind &kind) {
    WriteOptions options;
    options.metadata_from = job.source;
    options.mark = mark_of(job, kind);
    options.mark->is_exposure_measured = job.exif != nullptr;
    options.metadata = job.exif.get();
    return options;
}

}  // namespace lensprof
