#include "cli/correct/apply_plan.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "cli/profiles/foreign_file.hpp"
#include "cli/program/message.hpp"
#include "cli/program/shard.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/correct/falloff_doubt.hpp"
#include "photo/correct/opcode_copy.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/scene/exposure_reader.hpp"
#include "photo/scene/exposures.hpp"
#include "photo/scene/hugin_project.hpp"

namespace lensprof {
namespace {

// A DNG stays a DNG with the falloff as an opcode, unless the options need more than an opcode can express.
bool becomes_dng(const ApplyOptions &o, const std::string &raw) {
    const CorrectionKind &kind = o.kind;
    const bool is_plain = !kind.linear && !kind.simulate && !kind.chroma && kind.strength == 1.0 && kind.gain_cap == 0.0
                          && !kind.levels.any() && o.project().empty() && o.sheet.empty();
    if (o.raw_output == RawOutput::dng && raw != "DNG")
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--encoding raw=dng: needs DNG files, but one is a " + raw
                                                   + "; convert it to DNG first, or omit the option");
    if (o.raw_output == RawOutput::dng && !is_plain)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--encoding raw=dng: an opcode stores only the falloff; omit --linear, --chroma, --set simulate, "
                      "strength and gain-cap, --pto and --contact-sheet, or use raw=tif");
    return raw == "DNG" && is_plain && o.raw_output != RawOutput::tif;
}

// `named`: the name of the picture, with its folders below the output folder.
std::string target_name(const ApplyOptions &o, const NamedPicture &picture, const std::filesystem::path &named) {
    std::filesystem::path name = named;
    const auto raw = raw_kind(picture.file);
    if (o.kind.linear)
        name.replace_extension(o.linear_end.empty() ? ".tif" : o.linear_end);
    else if ((raw && !becomes_dng(o, *raw)) || (!raw && is_read_alone(picture.file)))
        name.replace_extension(".tif");
    if (raw && becomes_dng(o, *raw)) name.replace_extension(".dng");
    return (std::filesystem::path(o.output) / name).string();
}

// A picture with another aspect ratio is not one the project was made with; another size is accepted.
void check_shape(const Scene &scene, uint32_t image, const std::string &file, PictureSize size) {
    const auto &camera = scene.images[image].camera;
    const double expected = static_cast<double>(camera.width) / camera.height,
                 shape = static_cast<double>(size.width) / size.height;
    const bool is_same = size.width == camera.width && size.height == camera.height;
    const bool is_scalable = scene.models.empty() && !scene.images[image].of_crop;
    if (is_scalable ? std::abs(shape / expected - 1.0) > 0.01 : !is_same)
        throw Failure(LENSPROF_ERROR_READ,
                      file + format(": is %u x %u pixels, but ", size.width, size.height) + scene.path
                          + format(" states %u x %u; use the pictures that the project was made with", camera.width,
                                   camera.height));
}

// A project without a result would change nothing; nobody wants that.
void check_has_result(const Scene &scene) {
    for (const auto &image : scene.images) {
        bool response = std::any_of(image.emor, image.emor + 5, [](double a) { return a != 0.0; });
        bool falloff = std::any_of(image.vignetting.k, image.vignetting.k + 3, [](double k) { return k != 0.0; });
        if (response || falloff || image.response_type == 1) return;
    }
    throw Failure(
        LENSPROF_ERROR_ARGUMENT,
        scene.path
            + ": has neither response nor falloff; give the project that `lensprof build --write pto=FILE` wrote");
}

// If no profile is looked up, an error in the metadata is ignored here: reading the pixels reports it.
PictureMetadata metadata_of(const ApplyOptions &o, const std::string &file) {
    try {
        return read_metadata(file);
    } catch (const Failure &) {
        if (!o.model.profile && o.project().empty()) throw;
        return unknown_metadata();
    }
}

// NotThisOne for a picture already corrected by lensprof.
void check_mark(const ApplyOptions &o, const std::string &file, const PictureMetadata &metadata) {
    const auto &mark = metadata.mark;
    if (o.model.force_falloff || o.kind.simulate || !mark || mark->falloff != CorrectionMark::Falloff::removed) return;
    throw NotThisOne(LENSPROF_ERROR_NOT_FOUND,
                     file + ": already corrected, " + metadata.corrected_by
                         + "; give the original, or use --set force-falloff=yes to correct it again",
                     true);
}

// NotThisOne for a file with several pictures: its copy would have only the first.
void check_several(const std::string &file) {
    const SeveralPictures several = several_pictures(file);
    if (!several.what.empty())
        throw NotThisOne(LENSPROF_ERROR_READ,
                         file + ": " + several.what + ", but only the first would be corrected; " + several.next_step);
}

// NotThisOne for a DNG whose opcodes already correct the falloff.
void check_opcodes(const ApplyOptions &o, const std::string &file) {
    if (o.model.force_falloff || !has_falloff_opcode(file)) return;
    throw NotThisOne(LENSPROF_ERROR_NOT_FOUND,
                     file + ": its opcodes already correct the falloff; use --encoding raw=tif, which ignores them",
                     true);
}

// The name of a model's image, by which the model identifies the output; without folders if these lead outside.
std::filesystem::path name_below(const std::string &name) {
    const auto path = std::filesystem::path(name).lexically_normal();
    const bool leads_out = path.is_absolute() || *path.begin() == "..";
    return leads_out ? path.filename() : path;
}

// The images of the project that a file holds: one, or several in crops of their own.
std::vector<uint32_t> images_of_file(const ApplySource &source, uint32_t first) {
    std::vector<uint32_t> images{first};
    const Scene &scene = *source.scene;
    for (uint32_t i = first + 1; i < scene.files.size() && scene.images[first].of_crop; i++)
        if (scene.images[i].of_crop && source.images->find(scene.files[i]) == first) images.push_back(i);
    return images;
}

bool is_left_out(const ApplySource &source, const std::string &file, const std::string &option) {
    const std::vector<uint32_t> images = images_of_file(source, source.images->at(file, option));
    return std::all_of(images.begin(), images.end(), [&](uint32_t i) { return source.scene->images[i].left_out != 0; });
}

// The crops of a picture whose images have a result in the project.
std::vector<CropCorrection> crops_of(const ApplySource &source, uint32_t first) {
    std::vector<CropCorrection> crops;
    for (const uint32_t i : images_of_file(source, first)) {
        const lensprof_pto_image &image = source.scene->images[i];
        if (!image.of_crop || image.left_out) continue;
        CropCorrection crop{{}, image.crop_circular != 0, nullptr, source.exposures[i], {}};
        std::copy_n(image.crop, 4, crop.crop);
        if (source.has_model) crop.model = source.scene->models[i];
        crops.push_back(crop);
    }
    return crops;
}

// The model of what is not of a crop: without falloff.
std::shared_ptr<const lensprof_profile> without_falloff(const lensprof_profile &model) {
    auto rest = std::shared_ptr<lensprof_profile>(new_profile());
    check(lensprof_profile_copy(rest.get(), &model), "");
    std::fill(std::begin(rest->vignetting), std::end(rest->vignetting), lensprof_vignetting{});
    lensprof_gain_grid_init(&rest->grid);
    rest->covariance_size = 0;
    return rest;
}

Correction make_job(const ApplyOptions &o, const ApplySource &source, const NamedPicture &picture) {
    Correction job;
    job.source = picture.file;
    const PictureSize size = read_size(picture.file);
    job.pixels = uint64_t(size.width) * size.height;
    std::filesystem::path named =
        std::filesystem::path(picture.subfolder) / std::filesystem::path(picture.file).filename();
    lensprof_exposure_init(&job.exposure);
    if (source.scene) {
        const uint32_t image = source.images->at(picture.file, o.project_option());
        check_shape(*source.scene, image, picture.file, size);
        job.exposure = source.exposures[image];
        job.crops = crops_of(source, image);
        if (source.has_model) job.model = source.scene->models[image];
        job.model_name = std::filesystem::path(o.project()).filename().string();
        if (!source.scene->document) named = name_below(source.scene->names[image]);
    }
    job.target = target_name(o, picture, named);
    const PictureMetadata metadata = metadata_of(o, picture.file);
    check_mark(o, picture.file, metadata);
    check_several(picture.file);
    if (source.models->are_used()) source.models->choose(metadata, job);
    for (CropCorrection &crop : job.crops)
        if (!crop.model) crop.model = job.model;
    if (!job.crops.empty()) job.model = without_falloff(*job.crops[0].model);
    if (o.kind.levels.any())
        job.levels = std::make_shared<lensprof_levels>(
            levels_of(o.kind.levels, read_header(picture.file), picture.file, job.model->levels));
    job.copies_dng = is_dng_name(job.target);
    if (job.copies_dng) check_opcodes(o, picture.file);
    return job;
}

// Named pictures are all wanted: all reasons are printed, and nothing is written.
[[noreturn]] void fail_refused(const std::vector<NotThisOne> &refused, size_t count, Streams &streams) {
    if (refused.size() == 1)
        throw Failure(refused[0].status, refused[0].what() + std::string(count > 1 ? "; or skip it with --skip" : ""));
    for (const NotThisOne &failure : refused) print_message(streams, failure.what());
    throw Failure(refused[0].status,
                  std::to_string(refused.size()) + " of " + counted(count, "picture")
                      + " cannot be corrected, and nothing was written; use --skip to leave them out");
}

// All images of the project in its result. An image that cannot be written itself still contributes; the reason is
// printed.
std::vector<PlacedCorrection> placed_images(const ApplyOptions &o, const ApplySource &source, const ApplyWork &work,
                                            Streams &streams) {
    std::vector<PlacedCorrection> placed;
    std::optional<uint32_t> layout;
    const Scene &scene = *source.scene;
    std::set<uint32_t> written;
    for (const Correction &job : work.jobs) {
        written.insert(source.images->at(job.source, "--pto"));
        check_mergeable(job.source, layout);
    }
    for (uint32_t i = 0; i < scene.images.size(); i++) {
        const std::string &file = scene.files[i];
        if (scene.images[i].left_out) continue;
        try {
            check_shape(scene, i, file, read_size(file));
            check_mark(o, file, metadata_of(o, file));
            check_mergeable(file, layout);
        } catch (const Failure &failure) {
            if (written.count(i) || failure.group() == LENSPROF_ERROR_CANCELLED) throw;
            warn(streams, failure.what() + std::string("; it is not merged"));
            continue;
        }
        Correction job;
        job.source = file, job.exposure = source.exposures[i], job.model = scene.models[i];
        placed.push_back({job, i});
    }
    return placed;
}

// A project has no pairs to check its falloffs against. Each doubt is printed once, with the first image.
void warn_of_falloffs(const ApplySource &source, const std::vector<Correction> &jobs, Streams &streams) {
    std::map<std::string, std::vector<std::string>> images;  // by doubt
    const auto add = [&](const std::string &file, const std::string &doubt) {
        if (doubt.empty()) return;
        std::vector<std::string> &files = images[doubt];
        if (files.empty() || files.back() != file) files.push_back(file);
    };
    for (const Correction &job : jobs) {
        const lensprof_camera &camera = source.scene->images[source.images->at(job.source, "--pto")].camera;
        for (const CropCorrection &of : job.crops)
            add(job.source, impossible_falloff(*of.model, static_cast<uint32_t>(of.crop[2] - of.crop[0]),
                                               static_cast<uint32_t>(of.crop[3] - of.crop[1]), of.is_circular));
        if (job.crops.empty()) add(job.source, impossible_falloff(*job.model, camera.width, camera.height));
    }
    for (const auto &[doubt, files] : images)
        warn(streams, files[0] + (files.size() > 1 ? format(" and %zu more", files.size() - 1) : "") + ": " + doubt
                          + ", as with no lens; check the result, or fit the project again with `lensprof build`");
}

void take_shard(const Shard &shard, std::vector<NamedPicture> &pictures) {
    const size_t first = shard.first(pictures.size()), end = shard.end(pictures.size());
    if (first == end && !pictures.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      format("--shard %u/%u: contains none of the %zu pictures; use fewer parts", shard.number,
                             shard.count, pictures.size()));
    pictures.erase(pictures.begin() + static_cast<std::ptrdiff_t>(end), pictures.end());
    pictures.erase(pictures.begin(), pictures.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace

ApplySource open_source(const ApplyOptions &o) {
    for (const std::string &file : o.files) refuse_other_kind(file);
    ApplySource source;
    if (o.files.empty() && o.project().empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "no pictures to correct; give pictures "
                      "or folders");
    source.models = std::make_unique<PictureModels>(o.model, o.project().empty());
    const bool from_store = source.models->are_used();
    if (!from_store && o.project().empty())
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            "no correction given and no database found; give the database with --db FILE, or --pto FILE or --model "
            "FILE");
    if (!o.project().empty()) {
        source.scene =
            std::make_unique<Scene>(o.pto.empty() ? read_exposures(o.exposures, o.images) : read_hugin_project(o.pto));
        source.images = std::make_unique<ImagesByFile>(*source.scene);
        source.exposures = relative_to_joined(*source.scene);
        source.has_model = !from_store;
    } else if (o.exposure == OutputExposure::mean || o.exposure == OutputExposure::reference) {
        throw Failure(LENSPROF_ERROR_ARGUMENT, std::string("--set exposure=")
                                           + (o.exposure == OutputExposure::mean ? "mean" : "reference")
                                           + " needs the exposures of a project; give the project with --pto or "
                                             "--model");
    }
    return source;
}

ApplyWork plan_work(const ApplyOptions &o, const ApplySource &source, Streams &streams) {
    Progress events(streams);
    std::vector<NamedPicture> pictures;
    std::vector<std::string> other_kinds;
    if (o.files.empty() && source.scene)
        for (uint32_t i = 0; i < source.scene->files.size(); i++) {
            const std::string &file = source.scene->files[i];
            const bool is_again = source.scene->images[i].of_crop && source.images->find(file) != i;
            if (!is_again) pictures.push_back({file, "", false});
        }
    else
        pictures = named_pictures(o.files, o.output, other_kinds), extract_outputs(pictures, events);
    for (const std::string &text : other_kinds) warn(streams, text);
    if (o.merge) refuse_crops(*source.scene, "--merge");
    take_shard(shard_of(o.shard), pictures);
    if (pictures.empty()) throw Failure(LENSPROF_ERROR_ARGUMENT, "no pictures to correct; give pictures or folders");
    ApplyWork work;
    lensprof_exposure_init(&work.mean);
    if (source.scene) work.mean = mean_exposure(joined_exposures(*source.scene, source.exposures));
    std::vector<std::string> inputs = source.scene ? source.scene->files : std::vector<std::string>();
    std::vector<NotThisOne> refused;
    for (const NamedPicture &picture : pictures) {
        inputs.push_back(picture.file);
        note_instead(picture, events);
        if (source.scene && picture.in_folder && !source.images->find(picture.file)) {
            work.left_out.push_back({picture.file, picture.file + ": is not a picture of " + o.project()});
            continue;
        }
        if (source.scene && is_left_out(source, picture.file, o.project_option())) {
            const std::string reason =
                picture.file + ": not corrected: the project has no exposure for it; use the original";
            warn(streams, reason);
            work.unjoined.push_back({picture.file, reason});
            continue;
        }
        try {
            work.jobs.push_back(make_job(o, source, picture));
        } catch (const NotThisOne &failure) {
            if (o.skip || picture.in_folder)
                work.left_out.push_back({picture.file, failure.what(), failure.corrected_already, failure.status});
            else
                refused.push_back(failure);
        } catch (const Failure &failure) {
            // A name without a file is a mistake in the call.
            const bool is_mistaken = !o.files.empty() && !picture.in_folder && !path_exists(picture.file);
            if (failure.group() != LENSPROF_ERROR_READ || is_mistaken || o.merge || pictures.size() == 1) throw;
            work.left_out.push_back({picture.file, failure.what(), false, failure.status});
        }
    }
    if (!refused.empty()) fail_refused(refused, pictures.size(), streams);
    if (!o.sheet.empty()) format_of_name(o.sheet);  // for its errors, before anything is written
    check_targets(work.jobs, inputs, o.sheet);
    check_older_outputs(work.jobs, o.kind, o.has_output);
    if (source.has_model && !o.pto.empty()) check_has_result(*source.scene);
    if (source.has_model) warn_of_falloffs(source, work.jobs, streams);
    if (o.merge) work.lit = placed_images(o, source, work, streams);
    return work;
}

}  // namespace lensprof
