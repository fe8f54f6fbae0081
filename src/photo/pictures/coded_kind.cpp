#include "photo/pictures/coded_kind.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "photo/base/file_kind.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

using namespace std::string_view_literals;

}  // namespace

std::optional<CodedKind> coded_kind(const std::string &path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    char bytes[kind_bytes] = {};
    file.read(bytes, sizeof bytes);
    const std::string_view start(bytes, static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    if (start.substr(0, 4) == "RIFF"sv && start.size() >= 12 && start.substr(8, 4) == "WEBP"sv)
        return CodedKind{FileFormat::webp, "WebP"};
    // ISO/IEC 18181-2: a codestream, or one in a container
    if (start.substr(0, 2) == "\xff\x0a"sv || start.substr(0, 12) == "\0\0\0\x0cJXL \r\n\x87\n"sv)
        return CodedKind{FileFormat::jxl, "JPEG XL"};
    if (start.substr(0, 9) == "SIMPLE  ="sv) return CodedKind{FileFormat::fits, "FITS"};  // FITS 4.0, 4.4.1
    if (const char *name = heif_brand(start)) return CodedKind{FileFormat::heif, name};
    return std::nullopt;
}

std::optional<CodedKind> coded_kind_of_name(const std::string &path) {
    static constexpr struct {
        const char *end;
        CodedKind kind;
    } ends[] = {{"heic", {FileFormat::heif, "HEIC"}}, {"heif", {FileFormat::heif, "HEIF"}},
                {"hif", {FileFormat::heif, "HEIF"}},  {"avif", {FileFormat::heif, "AVIF"}},
                {"webp", {FileFormat::webp, "WebP"}}, {"jxl", {FileFormat::jxl, "JPEG XL"}},
                {"fits", {FileFormat::fits, "FITS"}}, {"fit", {FileFormat::fits, "FITS"}},
                {"fts", {FileFormat::fits, "FITS"}}};
    const std::string extension = lowercase_extension(path);
    for (const auto &entry : ends)
        if (extension == entry.end) return entry.kind;
    return std::nullopt;
}

bool is_read_alone(const std::string &path) { return coded_kind(path) || coded_kind_of_name(path); }

}  // namespace lensprof
