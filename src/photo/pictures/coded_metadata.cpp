#include "photo/pictures/coded_metadata.hpp"

#include "photo/pictures/coded_file.hpp"
#include "photo/pictures/exif_tags.hpp"

namespace lensprof {
namespace {

std::string mime_type_of(const CodedKind &kind) {
    if (kind.format == FileFormat::webp) return "image/webp";
    if (kind.format == FileFormat::jxl) return "image/jxl";
    if (kind.format == FileFormat::fits) return "image/fits";
    const std::string name = kind.name;
    return name == "HEIC" ? "image/heic" : name == "AVIF" ? "image/avif" : "image/heif";
}

codec::CodedMetadata read_coded(const std::string &path, const CodedKind &kind) {
    if (kind.format == FileFormat::webp) return codec::webp_metadata(path);
    if (kind.format == FileFormat::jxl) return codec::jxl_metadata(path);
    if (kind.format == FileFormat::fits) return codec::fits_metadata(path);
    return codec::heif_metadata(path, kind.name);
}

}  // namespace

// An invalid EXIF block counts as missing, as in a JPEG.
PictureBlocks read_coded_blocks(const std::string &path, const CodedKind &kind) {
    codec::CodedMetadata coded = read_coded(path, kind);
    PictureBlocks blocks;
    blocks.mime_type = mime_type_of(kind);
    blocks.is_of_camera = kind.format == FileFormat::heif ? blocks.mime_type == "image/heic" : coded.is_camera_jpeg;
    blocks.width = coded.width;
    blocks.height = coded.height;
    blocks.exif = read_exif(coded.exif);
    blocks.exif_block = std::move(coded.exif);
    blocks.xmp.assign(coded.xmp.begin(), coded.xmp.end());
    blocks.icc = std::move(coded.icc);
    if (coded.orientation != 0 && (coded.orientation != 1 || blocks.exif.find(exif_tags::orientation)))
        blocks.exif.set_number(exif_tags::orientation, tiff_short, coded.orientation);
    return blocks;
}

}  // namespace lensprof
