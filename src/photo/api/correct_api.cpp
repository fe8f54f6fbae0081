// Corrected copies.
#include <filesystem>

#include "photo/api/handles.hpp"
#include "photo/api/sized.hpp"
#include "photo/correct/correction.hpp"
#include "photo/correct/picture_model.hpp"
#include "photo/correct/scene_copies.hpp"

namespace lensprof {
namespace {

constexpr size_t first_correct_options = LENSPROF_FIRST(lensprof_correct_options, dither);

// By the profiles of databases: the falloff alone.
std::vector<Correction> copies_by_profile(const std::vector<CopyNames> &names, const lensprof_correct_options &o) {
    ModelOptions options;
    options.from_db = true, options.force_falloff = o.force_falloff != 0, options.puts_in = o.simulate != 0;
    options.dbs = databases_of(o);
    const PictureModels models(options, true);
    std::vector<Correction> jobs;
    for (const CopyNames &copy : names) {
        Correction job = copy_of_picture(copy);
        models.choose(read_metadata(copy.source), job);
        jobs.push_back(std::move(job));
    }
    return jobs;
}

CorrectionKind kind_of(const lensprof_correct_options &o) {
    CorrectionKind kind;
    kind.linear = o.linear != 0, kind.overwrite = o.overwrite != 0;
    kind.threads = o.threads, kind.strength = o.strength;
    kind.gain_cap = o.gain_cap, kind.dither = o.dither != 0, kind.simulate = o.simulate != 0;
    kind.chroma = o.chroma != 0;
    return kind;
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

void lensprof_correct_options_init_sized(lensprof_correct_options *options, size_t size) {
    lensprof_init_sized(options, size);
    if (size >= first_correct_options) options->strength = 1.0;
}

lensprof_status lensprof_correct_files(const lensprof_calibration *calibration, const lensprof_copy *copies,
                                       uint32_t count, const lensprof_correct_options *given,
                                       const lensprof_events *events, uint32_t *written, lensprof_error *error) {
    CallerEvents caller;
    return photo_call("copies", caller, error, [&] {
        caller.set(events);
        if (count) require(copies, "copies");
        lensprof_correct_options defaults;
        lensprof_correct_options_init(&defaults);
        const lensprof_correct_options o = taken(given, defaults, first_correct_options, "options");
        if (o.exposure > LENSPROF_COPY_EXPOSURE_REFERENCE)
            throw Failure(LENSPROF_ERROR_ARGUMENT, "exposure: is unknown");
        std::vector<CopyNames> names;
        for (uint32_t i = 0; i < count; i++) {
            require(copies[i].source, "source"), require(copies[i].target, "target");
            names.push_back({copies[i].source, copies[i].target});
        }
        if (calibration && !calibration->corrects())
            throw Failure(LENSPROF_ERROR_NOT_USABLE, calibration->result.path + ": corrects nothing: "
                                                         + calibration->of_scene->fit.report.verdict.headline());
        if (!count) {
            if (written) *written = 0;
            return;
        }
        std::vector<Correction> jobs =
            calibration ? copies_of_scene(calibration->result, names, o.exposure) : copies_by_profile(names, o);
        std::vector<std::string> inputs;
        for (const CopyNames &copy : names) inputs.push_back(copy.source);
        if (calibration)
            inputs.insert(inputs.end(), calibration->result.files.begin(), calibration->result.files.end());
        const CorrectionKind kind = kind_of(o);
        check_targets(jobs, inputs, "");
        check_older_outputs(jobs, kind, false);
        const Corrected done = write_corrected(jobs, kind, nullptr, caller);
        if (written) *written = static_cast<uint32_t>(jobs.size() - done.failed.size());
        if (!done.failed.empty()) throw Failure(done.failed[0].failure);
    });
}
