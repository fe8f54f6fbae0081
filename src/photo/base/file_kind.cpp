#include "photo/base/file_kind.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <optional>

#include "photo/base/failure.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/shell_word.hpp"

namespace lensprof {
namespace {

using namespace std::string_view_literals;

// What to do with the file, whose name replaces FILE, and whether it shows pictures, as a video does.
struct NextStep {
    const char *text;
    bool has_pictures;
};

constexpr NextStep video = {"make frames of it first, for example with `ffmpeg -i FILE -vf fps=2 frame_%04d.png`",
                            true};
constexpr NextStep sound = {"give pictures", false};
constexpr NextStep animation = {"save its frames as PNG first, for example with `magick FILE frame_%04d.png`", true};
constexpr NextStep picture = {"convert it to PNG or TIFF first, for example with `magick FILE picture.png`", true};
constexpr NextStep layers = {"save it as a flat TIFF or PNG first", true};
constexpr NextStep science = {
    "convert it to TIFF of 16 bit or float first, in Siril or with the Python packages astropy and tifffile", true};
constexpr NextStep light = {
    "convert it to a TIFF of 32 bit float first, for example with `oiiotool FILE -o picture.tif`", true};
constexpr NextStep document = {"extract its pictures first, for example with `pdfimages -all FILE picture`", false};
constexpr NextStep web_page = {"download the file itself, not the page that shows it", false};
constexpr NextStep archive = {"unpack it and give the files in it", false};
constexpr NextStep values_file = {"write its values as a TIFF or PNG first", false};

struct Kind {
    const char *name;
    NextStep next_step;
};

constexpr struct {
    size_t offset;
    std::string_view bytes;
    Kind kind;
} starts[] = {
    {0, "\x1a\x45\xdf\xa3"sv, {"a video (MKV)", video}},
    {0, "\0\0\x01\xba"sv, {"a video (MPEG)", video}},
    {0, "\0\0\x01\xb3"sv, {"a video (MPEG)", video}},
    {0, "\x30\x26\xb2\x75\x8e\x66\xcf\x11"sv, {"a video (WMV)", video}},
    {0, "FLV\x01"sv, {"a video (FLV)", video}},
    {0, "OggS"sv, {"a video or sound (Ogg)", video}},
    {0, "\x06\x0e\x2b\x34\x02\x05\x01\x01"sv, {"a video (MXF)", video}},
    {4, "RED1"sv, {"a video (REDCODE)", video}},
    {4, "RED2"sv, {"a video (REDCODE)", video}},
    {0, "YUV4MPEG2 "sv, {"a video (Y4M)", video}},
    {0, "LUCAM-RECORDER"sv, {"a video (SER)", {"save its frames as TIFF or PNG first, in Siril or SER Player", true}}},
    {0, "ID3"sv, {"sound (MP3)", sound}},
    {0, "fLaC"sv, {"sound (FLAC)", sound}},
    {0, "GIF87a"sv, {"a GIF picture", animation}},
    {0, "GIF89a"sv, {"a GIF picture or animation", animation}},
    {0, "\0\0\0\x0cjP  \r\n\x87\n"sv, {"a JPEG 2000 picture", picture}},
    {0, "\xff\x4f\xff\x51"sv, {"a JPEG 2000 picture", picture}},
    {0, "II\xbc\x01"sv, {"a JPEG XR picture", picture}},
    {0, "BPG\xfb"sv, {"a BPG picture", picture}},
    {0, "qoif"sv, {"a QOI picture", picture}},
    {0, "DDS "sv, {"a DDS texture", picture}},
    {0, "SDPX"sv, {"a DPX picture", picture}},
    {0, "XPDS"sv, {"a DPX picture", picture}},
    {0, "AT&TFORM"sv, {"a DjVu document", document}},
    {0, "8BPS"sv, {"a Photoshop file (PSD)", layers}},
    {0, "gimp xcf"sv, {"a GIMP file (XCF)", layers}},
    {0, "XISF0100"sv, {"an XISF file", science}},
    {128, "DICM"sv, {"a DICOM file", science}},
    {0, "\x89HDF\r\n\x1a\n"sv, {"an HDF5 file", values_file}},
    {0, "\x93NUMPY"sv, {"a NumPy array", values_file}},
    {0, "MATLAB 5.0"sv, {"a MATLAB file", values_file}},
    {0, "ZISRAWFILE"sv, {"a microscope's file (CZI)", {"export its pictures as TIFF first", true}}},
    {0, "\x76\x2f\x31\x01"sv, {"an OpenEXR picture", light}},
    {0, "#?RADIANCE"sv, {"a Radiance picture (HDR)", light}},
    {0, "#?RGBE"sv, {"a Radiance picture (HDR)", light}},
    {0, "%PDF-"sv, {"a PDF document", document}},
    {0, "%!PS"sv, {"a PostScript document", {"convert it to PNG or TIFF first", false}}},
    {0, "<!DOCTYPE html"sv, {"a web page", web_page}},
    {0, "<!doctype html"sv, {"a web page", web_page}},
    {0, "<html"sv, {"a web page", web_page}},
    {0, "PK\x03\x04"sv, {"a ZIP archive", archive}},
    {0, "\x1f\x8b\x08"sv, {"a gzip archive", archive}},
    {0, "BZh"sv, {"a bzip2 archive", archive}},
    {0, "\xfd\x37zXZ\0"sv, {"an XZ archive", archive}},
    {0, "\x28\xb5\x2f\xfd"sv, {"a Zstandard archive", archive}},
    {0, "7z\xbc\xaf\x27\x1c"sv, {"a 7-Zip archive", archive}},
    {0, "Rar!\x1a\x07"sv, {"a RAR archive", archive}},
    {257, "ustar"sv, {"a tar archive", archive}},
};

bool has(std::string_view start, size_t offset, std::string_view bytes) {
    return start.size() >= offset + bytes.size() && start.substr(offset, bytes.size()) == bytes;
}

uint32_t big_endian(std::string_view bytes) {
    uint32_t value = 0;
    for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<uint8_t>(c);
    return value;
}

// ISO/IEC 14496-12, 4.3: size, "ftyp", the major brand, its version, and compatible brands. Calls `visit` for each
// brand, the major one first.
template <class Visit>
void each_brand(std::string_view start, const Visit &visit) {
    if (start.size() < 12 || !has(start, 4, "ftyp"sv)) return;
    visit(start.substr(8, 4));
    const size_t end = std::min<size_t>(big_endian(start), start.size());
    for (size_t offset = 16; offset + 4 <= end; offset += 4) visit(start.substr(offset, 4));
}

// ISO/IEC 23008-12, annexes B and E, and AV1 Image File Format, 6: brands of still pictures and of sequences.
constexpr struct {
    std::string_view brand;
    const char *name;
} heif_brands[] = {{"heic"sv, "HEIC"}, {"heix"sv, "HEIC"}, {"heim"sv, "HEIC"}, {"heis"sv, "HEIC"},
                   {"hevc"sv, "HEIC"}, {"hevx"sv, "HEIC"}, {"avif"sv, "AVIF"}, {"avis"sv, "AVIF"},
                   {"mif1"sv, "HEIF"}, {"mif2"sv, "HEIF"}, {"msf1"sv, "HEIF"}};

// Files of the container of QuickTime and MP4 other than HEIF and Canon CR3. Old QuickTime files have no brands and
// start with one of the other boxes.
std::optional<Kind> kind_of_boxes(std::string_view start) {
    if (start.size() < 8) return std::nullopt;
    const std::string_view type = start.substr(4, 4);
    if (type == "ftyp"sv) {
        const std::string_view major = start.substr(8, 4);
        if (major == "crx "sv || heif_brand(start)) return std::nullopt;
        if (major == "qt  "sv) return Kind{"a video (MOV)", video};
        if (major.substr(0, 3) == "M4A"sv || major.substr(0, 3) == "M4B"sv) return Kind{"sound (M4A)", sound};
        if (major.substr(0, 2) == "3g"sv) return Kind{"a video (3GP)", video};
        return Kind{"a video (MP4)", video};
    }
    const bool is_box = type == "moov"sv || type == "mdat"sv || type == "wide"sv || type == "pnot"sv;
    const uint32_t size = big_endian(start);
    const bool is_size = size < 2 || (size >= 8 && (type == "mdat"sv || size < 1u << 24));
    return is_box && is_size ? std::optional<Kind>({"a video (MOV)", video}) : std::nullopt;
}

// Two letters, then a comment, two sizes, or the words of PAM.
bool is_netpbm(std::string_view start) {
    if (start.size() < 4 || start[0] != 'P' || "1234567Ff"sv.find(start[1]) == std::string_view::npos) return false;
    if (start[2] != '\n' && start[2] != ' ') return false;
    const std::string_view rest = start.substr(3);
    if (rest[0] == '#' || (start[1] == '7' && has(rest, 0, "WIDTH"sv))) return true;
    const size_t blank = rest.find_first_not_of("0123456789"sv);
    return blank != 0 && blank + 1 < rest.size() && (rest[blank] == ' ' || rest[blank] == '\n')
           && std::isdigit(static_cast<unsigned char>(rest[blank + 1]));
}

// Kinds whose mark is short or repeats.
std::optional<Kind> kind_of_pattern(std::string_view start) {
    if (has(start, 0, "RIFF"sv) && has(start, 8, "AVI "sv)) return Kind{"a video (AVI)", video};
    if (has(start, 0, "RIFF"sv) && has(start, 8, "WAVE"sv)) return Kind{"sound (WAV)", sound};
    if (has(start, 0, "\x1a\x45\xdf\xa3"sv) && start.find("webm"sv) < 64) return Kind{"a video (WebM)", video};
    // the header's size, and 4 reserved bytes
    if (has(start, 0, "BM"sv) && has(start, 6, "\0\0\0\0"sv) && has(start, 15, "\0\0\0"sv))
        return Kind{"a BMP picture", picture};
    // packets of 188 bytes, those of a camera with a time of 4 bytes in front
    if ((has(start, 0, "G"sv) && has(start, 188, "G"sv) && has(start, 376, "G"sv))
        || (has(start, 4, "G"sv) && has(start, 196, "G"sv) && has(start, 388, "G"sv)))
        return Kind{"a video (MPEG transport stream)", video};
    if (is_netpbm(start)) return Kind{"a Netpbm picture (PBM, PGM, PPM, PAM, PFM)", picture};
    return std::nullopt;
}

std::optional<Kind> kind_of(std::string_view start) {
    if (const auto kind = kind_of_boxes(start)) return kind;
    if (const auto kind = kind_of_pattern(start)) return kind;
    for (const auto &entry : starts)
        if (has(start, entry.offset, entry.bytes)) return entry.kind;
    return std::nullopt;
}

}  // namespace

const char *heif_brand(std::string_view start) {
    const char *name = nullptr;
    each_brand(start, [&](std::string_view brand) {
        for (const auto &entry : heif_brands)
            if (brand == entry.brand && (!name || name == "HEIF"sv)) name = entry.name;
    });
    return name;
}

// The kind of a file, and what to do.
static std::string reason_of(const Kind &kind, const std::string &path) {
    std::string next_step = kind.next_step.text;
    const size_t place = next_step.find("FILE");
    if (place != std::string::npos) next_step.replace(place, 4, shell_word(path));
    return std::string(kind.name) + ", which lensprof does not read; " + next_step;
}

void refuse_other_kind(const std::string &path, std::string_view start) {
    if (const auto kind = kind_of(start))
        throw Failure(LENSPROF_ERROR_READ, short_name(path) + ": is " + reason_of(*kind, path));
}

static std::string start_of(const std::string &path) {
    std::string bytes(kind_bytes, 0);
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return bytes;
}

void refuse_other_kind(const std::string &path) {
    if (is_regular_file(path)) refuse_other_kind(path, start_of(path));
}

std::optional<OtherPictures> other_pictures(const std::string &path) {
    if (!is_regular_file(path)) return std::nullopt;
    const std::string start = start_of(path);
    const auto kind = kind_of(start);
    if (!kind || !kind->next_step.has_pictures) return std::nullopt;
    return OtherPictures{kind->name, reason_of(*kind, path)};
}

}  // namespace lensprof
