#include "cli/program/input_file.hpp"

#include <cerrno>
#include <fstream>
#include <vector>

#include "cli/program/error.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

[[noreturn]] void fail_too_large(const std::string &path, uint64_t most_bytes) {
    throw Failure(ExitCode::unreadable, path + ": exceeds the maximum size of such a file ("
                                            + std::to_string(most_bytes >> 10) + " KiB); check the file name");
}

std::ifstream opened(const std::string &path) {
    const std::string name = short_name(path);
    demand_ordinary(path);
    if (is_folder(path)) throw Failure(ExitCode::unreadable, name + ": is a folder; give a file");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw Failure(ExitCode::unreadable,
                      name + ": cannot be opened: " + system_text(errno) + "; check the file name");
    return file;
}

}  // namespace

void demand_ordinary(const std::string &path) {
    if (path_exists(path) && !is_regular_file(path) && !is_folder(path))
        throw Failure(ExitCode::unreadable, path + ": is not a regular file (a device or a pipe); copy it to a file "
                                                   "first");
}

std::string read_text(const std::string &path, uint64_t most_bytes) {
    const std::string name = short_name(path);
    std::ifstream file = opened(path);
    const uint64_t bytes = file_bytes(path);
    if (bytes > most_bytes) fail_too_large(name, most_bytes);
    std::string text;
    text.reserve(bytes);
    std::vector<char> room(1 << 16);
    while (text.size() <= most_bytes && (file.read(room.data(), std::streamsize(room.size())), file.gcount() > 0))
        text.append(room.data(), static_cast<size_t>(file.gcount()));
    if (file.bad())
        throw Failure(ExitCode::unreadable, name + ": read error before the end of the file; copy the "
                                                               "file again");
    if (text.size() > most_bytes) fail_too_large(name, most_bytes);  // it grows while being read
    return text;
}

std::string read_head(const std::string &path, size_t most_bytes) {
    std::ifstream file = opened(path);
    std::string head(most_bytes, 0);
    file.read(head.data(), static_cast<std::streamsize>(most_bytes));
    head.resize(static_cast<size_t>(file.gcount()));
    return head;
}

}  // namespace lensprof
