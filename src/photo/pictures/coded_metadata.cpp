#include "photo/pictures/coded_metadata.hpp"

#include <algorithm>
#include <cstring>

#include "photo/pictures/coded_file.hpp"

namespace lensprof {
namespace {

#if EXIV2_TEST_VERSION(0, 28, 0)
constexpr auto no_type = Exiv2::ImageType::none;
#else
constexpr int no_type = Exiv2::ImageType::none;
#endif

std::string mime_type_of(const CodedKind &kind) {
    if (kind.format == FileFormat::webp) return "image/webp";
    if (kind.format == FileFormat::jxl) return "image/jxl";
    const std::string name = kind.name;
    return name == "HEIC" ? "image/heic" : name == "AVIF" ? "image/avif" : "image/heif";
}

codec::CodedMetadata read_blocks(const std::string &path, const CodedKind &kind) {
    if (kind.format == FileFormat::webp) return codec::webp_metadata(path);
    if (kind.format == FileFormat::jxl) return codec::jxl_metadata(path);
    return codec::heif_metadata(path, kind.name);
}

// Holds metadata read elsewhere.
class CodedImage final : public Exiv2::Image {
public:
    CodedImage(const CodedKind &kind, const codec::CodedMetadata &blocks)
        : Exiv2::Image(no_type, Exiv2::mdExif | Exiv2::mdXmp | Exiv2::mdIccProfile,
                       Exiv2::ImageFactory::createIo("a picture that Exiv2 does not open", false)),
          mime_type_(mime_type_of(kind)),
          is_of_camera_(kind.format == FileFormat::heif ? mime_type_ == "image/heic" : blocks.is_camera_jpeg) {
        // 0.28 of Exiv2 has unsigned sizes
        pixelWidth_ = static_cast<decltype(pixelWidth_)>(blocks.width);
        pixelHeight_ = static_cast<decltype(pixelHeight_)>(blocks.height);
        read_exif(blocks);
        read_xmp(blocks);
        if (blocks.icc.empty()) return;
        Exiv2::DataBuf profile(blocks.icc.data(), static_cast<long>(blocks.icc.size()));
#if EXIV2_TEST_VERSION(0, 28, 0)
        setIccProfile(std::move(profile), false);
#else
        setIccProfile(profile, false);
#endif
    }

    void readMetadata() override {}
    void writeMetadata() override {}
    std::string mimeType() const override { return mime_type_; }
    bool is_of_camera() const { return is_of_camera_; }

private:
    // An invalid EXIF block counts as missing, as in a JPEG.
    void read_exif(const codec::CodedMetadata &blocks) {
        if (!blocks.exif.empty()) {
            const Exiv2::ByteOrder order =
                Exiv2::ExifParser::decode(exifData(), blocks.exif.data(), static_cast<uint32_t>(blocks.exif.size()));
            if (order == Exiv2::invalidByteOrder)
                exifData().clear();
            else
                setByteOrder(order);
        }
        if (blocks.orientation == 0) return;
        const auto stated = exifData().findKey(Exiv2::ExifKey("Exif.Image.Orientation"));
        if (blocks.orientation != 1 || stated != exifData().end())
            exifData()["Exif.Image.Orientation"] = blocks.orientation;
    }

    void read_xmp(const codec::CodedMetadata &blocks) {
        if (blocks.xmp.empty()) return;
        xmpPacket_.assign(blocks.xmp.begin(), blocks.xmp.end());
        if (Exiv2::XmpParser::decode(xmpData(), xmpPacket_) != 0) xmpData().clear();
    }

    std::string mime_type_;
    bool is_of_camera_;
};

}  // namespace

std::unique_ptr<Exiv2::Image> open_coded_image(const std::string &path, const CodedKind &kind) {
    return std::make_unique<CodedImage>(kind, read_blocks(path, kind));
}

bool is_of_camera(const Exiv2::Image &image) {
    const auto *coded = dynamic_cast<const CodedImage *>(&image);
    return coded ? coded->is_of_camera() : image.mimeType() == "image/jpeg";
}

}  // namespace lensprof
