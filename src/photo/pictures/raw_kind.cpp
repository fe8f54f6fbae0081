#include "photo/pictures/raw_kind.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "photo/base/paths.hpp"
#include "photo/pictures/tiff_directory.hpp"
#include "photo/pictures/tiff_tags.hpp"

namespace lensprof {
namespace {

using namespace std::string_view_literals;

// Files that are not a TIFF, by their first bytes.
constexpr struct {
    size_t offset;
    std::string_view bytes;
    const char *kind;
} starts[] = {{0, "FUJIFILMCCD-RAW"sv, "Fujifilm RAF"},
              {4, "ftypcrx "sv, "Canon CR3"},
              {6, "HEAPCCDR"sv, "Canon CRW"},
              {0, "IIRO"sv, "Olympus ORF"},
              {0, "IIRS"sv, "Olympus ORF"},
              {0, "MMOR"sv, "Olympus ORF"},
              {0, "IIU\0"sv, "Panasonic RW2"},
              {0, "FOVb"sv, "Sigma X3F"},
              {0, "\0MRM"sv, "Minolta MRW"}};

// Extensions of raw files, and the kind if the TIFF structure alone does not determine it.
constexpr struct {
    const char *extension, *kind;
} raw_extensions[] = {
    {"3fr", "Hasselblad 3FR"}, {"arw", "Sony ARW"},      {"cr2", "Canon CR2"},   {"cr3", "Canon CR3"},
    {"crw", "Canon CRW"},      {"dcr", "Kodak DCR"},     {"dng", "DNG"},         {"erf", "Epson ERF"},
    {"fff", "Hasselblad FFF"}, {"iiq", "Phase One IIQ"}, {"k25", "Kodak K25"},   {"kdc", "Kodak KDC"},
    {"mef", "Mamiya MEF"},     {"mos", "Leaf MOS"},      {"mrw", "Minolta MRW"}, {"nef", "Nikon NEF"},
    {"nrw", "Nikon NRW"},      {"orf", "Olympus ORF"},   {"pef", "Pentax PEF"},  {"raf", "Fujifilm RAF"},
    {"raw", "camera RAW"},     {"rw2", "Panasonic RW2"}, {"rwl", "Leica RWL"},   {"sr2", "Sony SR2"},
    {"srf", "Sony SRF"},       {"srw", "Samsung SRW"},   {"x3f", "Sigma X3F"}};

// TIFF-based raw files, by their maker.
constexpr struct {
    std::string_view maker;
    const char *kind;
} makers[] = {{"NIKON"sv, "Nikon NEF"},        {"SONY"sv, "Sony ARW"},       {"PENTAX"sv, "Pentax PEF"},
              {"RICOH"sv, "Pentax PEF"},       {"SAMSUNG"sv, "Samsung SRW"}, {"CANON"sv, "Canon CR2"},
              {"EPSON"sv, "Epson ERF"},        {"LEICA"sv, "Leica RWL"},     {"HASSELBLAD"sv, "Hasselblad 3FR"},
              {"MAMIYA"sv, "Mamiya MEF"},      {"LEAF"sv, "Leaf MOS"},       {"EASTMAN"sv, "Kodak DCR"},
              {"PHASE ONE"sv, "Phase One IIQ"}};

const char *kind_of_name(const std::string &path) {
    const std::string extension = lowercase_extension(path);
    for (const auto &name : raw_extensions)
        if (extension == name.extension) return name.kind;
    return nullptr;
}

std::string kind_of_maker(TiffReader &reader, const TiffDirectory &first, const std::string &path) {
    if (first.find(tag_dng_version)) return "DNG";
    std::string maker;
    const TiffEntry *entry = first.find(tag_make);
    if (entry && entry->count < 256) {
        const std::vector<uint8_t> bytes = reader.bytes(*entry);
        maker.assign(bytes.begin(), bytes.end());
    }
    for (char &c : maker) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (const char *named = kind_of_name(path)) return named;
    for (const auto &known : makers)
        if (maker.find(known.maker) != std::string::npos) return known.kind;
    return "TIFF of a mosaic";
}

std::optional<std::string> kind_of_tiff(TiffReader &reader, const std::string &path) {
    std::optional<TiffDirectory> first;
    const auto is_raw = [&](const TiffDirectory &directory) {
        const uint32_t photometric = reader.number(directory, tag_photometric, 0);
        return photometric == photometric_cfa || photometric == photometric_linear_raw;
    };
    for (uint64_t pointer = 4; pointer;) {
        const TiffDirectory directory = reader.directory(pointer);
        if (!first) first = directory;
        if (is_raw(directory)) return kind_of_maker(reader, *first, path);
        for (uint64_t child : reader.children(directory))
            if (is_raw(reader.directory(child))) return kind_of_maker(reader, *first, path);
        pointer = directory.next ? directory.next_pointer() : 0;
    }
    return std::nullopt;
}

}  // namespace

bool is_raw_name(const std::string &path) { return kind_of_name(path) != nullptr; }
bool is_dng_name(const std::string &path) { return lowercase_extension(path) == "dng"; }

std::optional<std::string> raw_kind(const std::string &path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    char start[16] = {};
    file.read(start, sizeof start);
    const std::string_view head(start, static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    for (const auto &entry : starts)
        if (head.size() >= entry.offset + entry.bytes.size()
            && head.substr(entry.offset, entry.bytes.size()) == entry.bytes)
            return entry.kind;
    if (head.substr(0, 4) != "II*\0"sv && head.substr(0, 4) != "MM\0*"sv) return std::nullopt;
    if (head.substr(0, 2) == "II"sv && head.size() >= 10 && head.substr(8, 2) == "CR"sv) return "Canon CR2";
    file.clear();
    file.seekg(0, std::ios::end);
    const uint64_t size = static_cast<uint64_t>(std::max<std::streamoff>(file.tellg(), 0));
    try {
        TiffReader reader(size, [&](uint64_t offset, uint8_t *bytes, size_t count) {
            file.clear();
            file.seekg(static_cast<std::streamoff>(offset));
            if (!file.read(reinterpret_cast<char *>(bytes), static_cast<std::streamsize>(count)))
                throw UnusableTiff(TiffDefect::cut_off);
        });
        if (auto kind = kind_of_tiff(reader, path)) return kind;
    } catch (const UnusableTiff &) {  // its reader reports the error
    }
    const char *named = kind_of_name(path);
    return named ? std::optional<std::string>(named) : std::nullopt;
}

}  // namespace lensprof
