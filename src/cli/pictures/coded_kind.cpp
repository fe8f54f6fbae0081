#include "cli/pictures/coded_kind.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace lensprof {
namespace {

using namespace std::string_view_literals;

constexpr size_t max_start = 512;  // of a file: enough for its first box with the brands

// ISO/IEC 23008-12, annexes B and E, and AV1 Image File Format, 6: brands of still pictures and of sequences.
constexpr struct {
    std::string_view brand;
    const char *name;
} brands[] = {{"heic"sv, "HEIC"}, {"heix"sv, "HEIC"}, {"heim"sv, "HEIC"}, {"heis"sv, "HEIC"},
              {"hevc"sv, "HEIC"}, {"hevx"sv, "HEIC"}, {"avif"sv, "AVIF"}, {"avis"sv, "AVIF"},
              {"mif1"sv, "HEIF"}, {"mif2"sv, "HEIF"}, {"msf1"sv, "HEIF"}};

const char *name_of_brand(std::string_view brand) {
    for (const auto &entry : brands)
        if (brand == entry.brand) return entry.name;
    return nullptr;
}

// ISO/IEC 14496-12, 4.3: size, "ftyp", the major brand, its version, and compatible brands, which name the coding where
// the major one is that of all such files.
const char *name_of_brands(std::string_view start) {
    if (start.size() < 16 || start.substr(4, 4) != "ftyp"sv) return nullptr;
    size_t size = 0;
    for (const char c : start.substr(0, 4)) size = size << 8 | static_cast<uint8_t>(c);
    const char *name = name_of_brand(start.substr(8, 4));
    for (size_t offset = 16; offset + 4 <= std::min(size, start.size()); offset += 4) {
        const char *other = name_of_brand(start.substr(offset, 4));
        if (other && (!name || name == "HEIF"sv)) name = other;
    }
    return name;
}

}  // namespace

std::optional<CodedKind> coded_kind(const std::string &path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    char bytes[max_start] = {};
    file.read(bytes, sizeof bytes);
    const std::string_view start(bytes, static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    if (start.substr(0, 4) == "RIFF"sv && start.size() >= 12 && start.substr(8, 4) == "WEBP"sv)
        return CodedKind{FileFormat::webp, "WebP"};
    // ISO/IEC 18181-2: a codestream, or one in a container
    if (start.substr(0, 2) == "\xff\x0a"sv || start.substr(0, 12) == "\0\0\0\x0cJXL \r\n\x87\n"sv)
        return CodedKind{FileFormat::jxl, "JPEG XL"};
    if (const char *name = name_of_brands(start)) return CodedKind{FileFormat::heif, name};
    return std::nullopt;
}

std::optional<CodedKind> coded_kind_of_name(const std::string &path) {
    static constexpr struct {
        const char *end;
        CodedKind kind;
    } ends[] = {{".heic", {FileFormat::heif, "HEIC"}}, {".heif", {FileFormat::heif, "HEIF"}},
                {".hif", {FileFormat::heif, "HEIF"}},  {".avif", {FileFormat::heif, "AVIF"}},
                {".webp", {FileFormat::webp, "WebP"}}, {".jxl", {FileFormat::jxl, "JPEG XL"}}};
    std::string extension = std::filesystem::path(path).extension().string();
    for (char &c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const auto &entry : ends)
        if (extension == entry.end) return entry.kind;
    return std::nullopt;
}

bool is_read_alone(const std::string &path) { return coded_kind(path) || coded_kind_of_name(path); }

}  // namespace lensprof
