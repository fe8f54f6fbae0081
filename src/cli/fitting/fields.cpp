#include "cli/fitting/fields.hpp"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "cli/fitting/store_options.hpp"
#include "cli/page/page.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/progress.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/memory_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/outcome.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

// Whether a file is in a folder or below it; false if `folder` is not a folder.
bool lies_in(const std::string &file, const std::string &folder) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) return false;
    const auto inside = std::filesystem::weakly_canonical(file, error)
                            .lexically_relative(std::filesystem::weakly_canonical(folder, error));
    return !inside.empty() && *inside.begin() != "..";
}

// A picture of the shading is float TIFF. None may replace an input, the database or another output.
void check_field_outputs(const FieldsCommand &o) {
    std::vector<std::string> reserved = o.files;
    reserved.insert(reserved.end(), o.dark_files.begin(), o.dark_files.end());
    if (!o.fit.store.no_store) reserved.push_back(store_path(o.fit.store.db));
    if (!o.report.empty()) reserved.push_back(o.report);
    for (const std::string &output : o.outputs) {
        const std::string extension = lowercase_extension(output);
        if (extension != "tif" && extension != "tiff")
            throw Failure(LENSPROF_ERROR_ARGUMENT, output + ": the shading of --fields is written as float TIFF; give a "
                                                            "name ending in .tif");
        for (const std::string &name : o.files)
            if (lies_in(output, name))
                throw Failure(LENSPROF_ERROR_ARGUMENT,
                              output + ": would lie among the pictures of " + name + "; give another folder");
        check_not_reserved(output, "output", reserved);
        check_output_file(output);
        reserved.push_back(output);
    }
}

void check_fields_options(const FieldsCommand &o) {
    const bool has_response = o.fit.gamma || o.fit.profile;
    if (has_response && !o.dark_files.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--dark: is of linear samples; omit it, or gamma and profile");
    if (has_response && !o.fit.levels.black.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--black: is of linear samples; omit it, or gamma and profile");
    check_report(o.report, o.files, o.fit.store);
    check_field_outputs(o);
    check_store(o.fit.store);
}

// The bytes of the shading as a picture, which is written with the other outputs, after the profile was stored.
std::string shading_file(const FieldFit &found) {
    constexpr uint64_t most = uint64_t(8) << 30;
    const TemporaryFolder folder;
    const std::string path = folder.path() + "/shading.tif";
    write_picture(path, shading_picture(found));
    return read_text(path, most);
}

ExitCode exit_code_of(const FieldFit &found) {
    if (!found.fit.usable) return ExitCode::not_usable;
    return found.left_out.empty() ? ExitCode::done : ExitCode::unreadable;
}

}  // namespace

int fit_fields_command(FieldsCommand o, Streams &streams) {
    check_fields_options(o);
    Progress progress(streams, o.progress);
    if (!o.dark_files.empty()) o.fit.dark = dark_level(o.dark_files, 0, o.fit.channel, progress);
    FieldFit found = fit_fields_of(o.files, o.fit, progress);
    stop_if_cancelled();
    const StoreOptions &store = o.fit.store;
    const bool is_kept = found.fit.usable || store.force;
    OutputFiles outputs;
    if (!o.report.empty())
        outputs.add(o.report, fields_page(found, o.files.front(), command_text(streams.words), streams.warnings));
    if (is_kept)
        for (const std::string &output : o.outputs) outputs.add(output, shading_file(found));
    if (is_kept && !store.no_store) store_fields(store, found);
    outputs.commit();
    if (o.json)
        print_json(fields_json(found), streams.out);
    else
        print_fields(found, streams.out);
    if (found.profile_id && !o.json)
        streams.out << "stored    profile " << found.profile_id << " in " << store_path(store.db) << ": "
                    << describe_key(found.key) << "\n";
    const std::string &first = found.names.front();
    if (!found.fit.usable)
        print_message(streams, not_usable_text(first, found.verdict, store));
    else if (o.json)  // otherwise they are in the table
        report_findings(found.verdict, first, progress);
    return static_cast<int>(exit_code_of(found));
}

}  // namespace lensprof
