#include "photo/base/input_file.hpp"

#include <cerrno>
#include <fstream>
#include <vector>

#include "photo/base/failure.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

[[noreturn]] void fail_too_large(const std::string &path, uint64_t max_bytes) {
    throw Failure(LENSPROF_ERROR_READ, path + ": exceeds the maximum size of such a file ("
                                           + std::to_string(max_bytes >> 10) + " KiB); check the file name");
}

std::ifstream open_for_reading(const std::string &path) {
    const std::string name = short_name(path);
    require_regular_file(path);
    if (is_folder(path)) throw Failure(LENSPROF_ERROR_READ, name + ": is a folder; give a file");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw Failure(LENSPROF_ERROR_READ,
                      name + ": cannot be opened: " + system_text(errno) + "; check the file name");
    return file;
}

}  // namespace

void require_regular_file(const std::string &path) {
    if (path_exists(path) && !is_regular_file(path) && !is_folder(path))
        throw Failure(LENSPROF_ERROR_READ, path + ": is not a regular file (a device or a pipe); copy it to a file "
                                                   "first");
}

std::string read_text(const std::string &path, uint64_t max_bytes) {
    const std::string name = short_name(path);
    std::ifstream file = open_for_reading(path);
    refuse_other_kind(path);
    const uint64_t bytes = file_bytes(path);
    if (bytes > max_bytes) fail_too_large(name, max_bytes);
    std::string text;
    text.reserve(bytes);
    std::vector<char> buffer(1 << 16);
    while (text.size() <= max_bytes && (file.read(buffer.data(), std::streamsize(buffer.size())), file.gcount() > 0))
        text.append(buffer.data(), static_cast<size_t>(file.gcount()));
    if (file.bad())
        throw Failure(LENSPROF_ERROR_READ, name + ": read error before the end of the file; copy the "
                                                               "file again");
    if (text.size() > max_bytes) fail_too_large(name, max_bytes);  // it grows while being read
    return text;
}

std::string read_head(const std::string &path, size_t max_bytes) {
    std::ifstream file = open_for_reading(path);
    std::string head(max_bytes, 0);
    file.read(head.data(), static_cast<std::streamsize>(max_bytes));
    head.resize(static_cast<size_t>(file.gcount()));
    return head;
}

}  // namespace lensprof
