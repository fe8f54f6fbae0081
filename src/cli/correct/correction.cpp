#include "cli/correct/correction.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/pictures/picture.hpp"
#include "cli/program/options.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {

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

void check_targets(std::vector<Correction> &jobs, const std::vector<std::string> &inputs, const std::string &sheet) {
    std::set<std::string> read, written;
    for (const std::string &file : inputs) read.insert(one_name(file));
    for (const Correction &job : jobs) read.insert(one_name(job.source));
    for (Correction &job : jobs) {
        PictureSize size = read_size(job.source);  // an unreadable picture shows before anything is written
        job.pixels = uint64_t(size.width) * size.height;
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
        throw Failure(ExitCode::usage, sheet + ": the contact sheet would overwrite a picture; give it another name");
}

std::vector<std::string> expand_folders(const std::vector<std::string> &names) {
    namespace fs = std::filesystem;
    std::vector<std::string> files;
    std::error_code error;
    for (const std::string &name : names) {
        if (name.empty()) throw Failure(ExitCode::usage, "FILES: a name is empty; name a picture or a folder");
        if (!is_folder(name)) {
            files.push_back(name);
            continue;
        }
        std::vector<std::string> found;
        for (fs::directory_iterator entry(name, error), end; !error && entry != end; entry.increment(error)) {
            const std::string file = entry->path().filename().string();
            if (file[0] != '.' && is_picture_name(file) && !is_folder(entry->path().string()))
                found.push_back(entry->path().string());
        }
        if (error) throw Failure(ExitCode::unreadable, name + ": cannot be listed: " + error.message());
        if (found.empty())
            throw Failure(ExitCode::usage, name + ": is a folder without pictures (.jpg, .png, .tif); name another");
        std::sort(found.begin(), found.end());
        files.insert(files.end(), found.begin(), found.end());
    }
    return files;
}

void add_speed(const Corrected &corrected, Json &json) {
    json["seconds"] = corrected.seconds;
    json["megapixels_per_second"] =
        corrected.megapixels > 0.0 ? Json(corrected.megapixels / std::max(corrected.seconds, 1e-6)) : Json();
}

void declare_threads(Command &command, uint32_t &threads) {
    command.count("--threads", threads, 0, 1024, "threads that correct pictures; 0 = all cores (default)");
}

}  // namespace lensprof
