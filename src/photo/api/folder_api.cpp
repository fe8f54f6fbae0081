// The whole job of a folder.
#include "photo/api/boundary.hpp"
#include "photo/api/sized.hpp"
#include "photo/folder/calibrate_folder.hpp"

using namespace lensprof;

namespace {

constexpr size_t first_folder_options = LENSPROF_FIRST(lensprof_folder_options, databases),
                 first_folder_result = LENSPROF_FIRST(lensprof_folder_result, reserved);

FolderOptions folder_options(const lensprof_folder_options &from) {
    FolderOptions o;
    o.one_lens = from.one_lens != 0, o.overwrite = from.overwrite != 0, o.threads = from.threads;
    o.store.no_store = from.no_store != 0;
    o.store.dbs = databases_of(from);
    if (!o.store.dbs.empty()) o.store.db = o.store.dbs.front();
    return o;
}

}  // namespace

lensprof_status lensprof_calibrate_folder(const char *const *paths, uint32_t count, const char *output,
                                          const lensprof_folder_options *given, const lensprof_events *events,
                                          lensprof_folder_result *result, lensprof_error *error) {
    CallerEvents caller;
    return photo_call("folder", caller, error, [&] {
        caller.set(events);
        require(output, "output"), require(count ? paths : nullptr, "paths");
        if (result) check_sized(*result, first_folder_result, "result");
        lensprof_folder_options defaults;
        lensprof_folder_options_init(&defaults);
        FolderOptions o = folder_options(taken(given, defaults, first_folder_options, "options"));
        o.output = output;
        for (uint32_t i = 0; i < count; i++) {
            require(paths[i], "path");
            o.inputs.emplace_back(paths[i]);
        }
        const FolderResult done = calibrate_folder(o, caller);
        lensprof_folder_result found;
        lensprof_folder_result_init(&found);
        found.found = static_cast<uint32_t>(done.inputs.found);
        found.panoramas = static_cast<uint32_t>(done.panoramas.list.size());
        found.fitted = done.panoramas.fitted;
        found.corrected = static_cast<uint32_t>(done.pictures.list.size());
        found.written = done.pictures.written;
        found.left_out = static_cast<uint32_t>(done.summary["left_out"].size());
        if (result) give(found, result, first_folder_result, "result");
    });
}
