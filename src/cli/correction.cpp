#include "correction.hpp"

#include <cmath>
#include <filesystem>
#include <set>

#include "interrupt.hpp"
#include "picture.hpp"
#include "project.hpp"

namespace lensprof {
namespace {

Picture correct(Picture &source, const Correction &job, const CorrectionKind &kind) {
    lensprof_apply_options options;
    lensprof_apply_options_init(&options);
    options.direction = kind.simulate ? LENSPROF_DIRECTION_SIMULATE : LENSPROF_DIRECTION_CORRECT;
    options.output = kind.linear ? LENSPROF_ENCODING_LINEAR : LENSPROF_ENCODING_RESPONSE;
    options.frame_width = source.frame_width;
    options.frame_height = source.frame_height;
    options.source_sample = source.sample;
    options.source_layout = source.layout;
    options.target_sample = kind.linear ? static_cast<uint32_t>(LENSPROF_SAMPLE_F32) : source.sample;
    options.responses = job.model->responses;
    options.vignettings = job.model->vignettings;
    options.response = job.model->response;
    options.vignetting = job.model->vignetting;
    options.grid = &job.model->grid;
    options.source = job.own;
    options.target = job.wanted;
    std::vector<uint64_t> memory(lensprof_plan_bytes(&options) / 8 + 1);
    const lensprof_plan *plan = nullptr;
    check(lensprof_plan_init(memory.data(), memory.size() * 8, &options, &plan), job.source);

    Picture result = source;
    result.sample = options.target_sample;
    result.row_bytes = static_cast<size_t>(result.width) * lensprof_layout_samples(result.layout)
        * lensprof_sample_bytes(result.sample);
    result.pixels.assign(result.row_bytes * result.height, 0);
    lensprof_image from = source.view(), to = result.view();
    check(lensprof_apply(plan, &from, &to, 0, 0), job.source);
    return result;
}

}  // namespace

lensprof_exposure mean_exposure(const std::vector<lensprof_exposure> &exposures) {
    lensprof_exposure mean{};
    double logs[3] = {0, 0, 0}, share = 1.0 / static_cast<double>(exposures.size());
    for (const auto &e : exposures) {
        mean.ev += e.ev * share;
        for (int c = 0; c < 3; c++) logs[c] += std::log(e.white_balance[c]) * share;
    }
    for (int c = 0; c < 3; c++) mean.white_balance[c] = std::exp(logs[c]);
    return mean;
}

namespace {

/* One name for every way to write a path, whether or not there is a file. */
std::string one_name(const std::string &path) {
    std::error_code error;
    auto name = std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
    return (error ? std::filesystem::absolute(path).lexically_normal() : name).string();
}

}  // namespace

void check_targets(const std::vector<Correction> &jobs, const std::vector<std::string> &inputs,
                   const std::string &sheet) {
    std::set<std::string> read, written;
    for (const std::string &file : inputs) read.insert(one_name(file));
    for (const Correction &job : jobs) read.insert(one_name(job.source));
    for (const Correction &job : jobs) {
        read_header(job.source);  /* an unreadable picture shows before anything is written */
        const std::string target = one_name(job.target);
        if (target == one_name(job.source) || is_same_file(job.source, job.target))
            throw Failure(ExitCode::usage,
                          job.source + ": would be overwritten by its correction; give another folder with -o");
        if (read.count(target))
            throw Failure(ExitCode::usage,
                          job.target + ": would overwrite a picture of the same call; give another folder with -o");
        if (!written.insert(target).second)
            throw Failure(ExitCode::usage,
                          job.target + ": two pictures would get this name; correct them one folder at a time");
    }
    if (!sheet.empty() && (read.count(one_name(sheet)) || written.count(one_name(sheet))))
        throw Failure(ExitCode::usage,
                      sheet + ": the contact sheet would overwrite a picture; give it another name");
}

void make_folder(const std::string &folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Failure(ExitCode::failed, folder + ": cannot be made: " + error.message());
}

Json write_corrected(const std::vector<Correction> &jobs, const CorrectionKind &kind, ContactSheet *sheet,
                     Progress &progress, Streams &streams) {
    Json written = Json::array();
    for (size_t i = 0; i < jobs.size(); i++) {
        stop_if_interrupted();
        progress.update("correcting", static_cast<double>(i) / static_cast<double>(jobs.size()));
        const Correction &job = jobs[i];
        Picture before = read_picture(job.source);
        check_finite(before, job.source);
        Picture after = correct(before, job, kind);
        WriteOptions write;
        write.metadata_from = job.source;
        if (!write_picture(job.target, after, write))
            streams.err << "lensprof: warning: " << job.target
                        << ": written without EXIF, which this kind of file cannot hold here\n";
        if (sheet) sheet->add(before, after);
        Json entry = {{"file", job.source}, {"output", job.target}};
        if (job.profile_id) entry["profile"] = job.profile_id;
        written.push_back(entry);
    }
    return written;
}

}  // namespace lensprof
