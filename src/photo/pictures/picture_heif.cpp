// HEIC and AVIF through libheif: the primary picture, assembled from its tiles.
#include <algorithm>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>

#include <libheif/heif.h>

#include "photo/base/events.hpp"
#include "photo/pictures/coded_file.hpp"
#include "photo/pictures/heif_properties.hpp"
#include "photo/pictures/icc.hpp"

namespace lensprof {

namespace codec {

namespace {

template <class T>
using Owned = std::unique_ptr<T, void (*)(T *)>;

void release(const heif_image_handle *handle) { heif_image_handle_release(handle); }
void release_image(const heif_image *image) { heif_image_release(image); }

// Its errors do not name the file or distinguish damage.
class HeifErrors {
public:
    HeifErrors(const std::string &path, const std::string &kind) : path_(path), kind_(kind) {}

    // libheif is written in C++, and exceptions of its parts may propagate.
    template <class Call>
    void run(const Call &call) const {
        heif_error error = {};
        try {
            error = call();
        } catch (const std::bad_alloc &) {
            throw;
        } catch (const std::exception &exception) {
            fail_damaged(path_, kind_ + ": " + exception.what());
        }
        check(error);
    }

    void check(const heif_error &error) const {
        if (error.code == heif_error_Ok) return;
        const std::string text = error.message ? error.message : "no reason given";
        if (error.subcode == heif_suberror_Security_limit_exceeded)
            fail_unsupported(path_, "is a picture in " + kind_ + " beyond libheif's limits (" + text
                                        + "); copy it again, or convert it to TIFF first");
        switch (error.code) {
        case heif_error_Memory_allocation_error: throw std::bad_alloc();
        case heif_error_Unsupported_filetype:
        case heif_error_Unsupported_feature:
        case heif_error_Color_profile_does_not_exist:
        case heif_error_Plugin_loading_error:
            fail_unsupported(path_, "is a picture in " + kind_ + " that libheif " + heif_get_version()
                                        + " does not decode (" + text + "); install its decoders (packages "
                                          "libheif-plugin-...), or convert the file to TIFF or PNG first");
        default: fail_damaged(path_, kind_ + ": " + text);
        }
    }

private:
    std::string path_, kind_;
};

// Loads the plugins once.
void prepare_libheif() {
#if LIBHEIF_HAVE_VERSION(1, 14, 0)
    static std::once_flag once;
    std::call_once(once, [] { heif_init(nullptr); });
#endif
}

class HeifFile {
public:
    HeifFile(const std::string &path, const std::string &kind) : path_(path), kind_(kind), errors_(path, kind) {
        prepare_libheif();
        open_for_reading(path);  // for its errors
        context_.reset(heif_context_alloc());
        if (!context_) throw std::bad_alloc();
        heif_context_set_max_decoding_threads(context_.get(), 0);  // several pictures in parallel are enough
        errors_.run([&] { return heif_context_read_from_file(context_.get(), path.c_str(), nullptr); });
        heif_image_handle *handle = nullptr;
        errors_.check(heif_context_get_primary_image_handle(context_.get(), &handle));
        handle_.reset(handle);
        properties_ = heif_properties(path);
        heif_color_profile_nclx *nclx = nullptr;
        if (heif_image_handle_get_nclx_color_profile(handle_.get(), &nclx).code == heif_error_Ok) take_transfer(nclx);
    }

    const heif_image_handle *handle() const { return handle_.get(); }
    uint16_t orientation() const { return properties_.orientation; }
    bool is_grey() const { return properties_.is_grey; }
    bool is_sideways() const { return properties_.orientation >= 5; }
    uint32_t width() const { return is_sideways() ? rotated_height() : rotated_width(); }  // before rotation
    uint32_t height() const { return is_sideways() ? rotated_width() : rotated_height(); }

    int bits() const {
        return std::max(heif_image_handle_get_luma_bits_per_pixel(handle()),
                        heif_image_handle_get_chroma_bits_per_pixel(handle()));
    }

    uint32_t pictures() const {
        return static_cast<uint32_t>(std::max(heif_context_get_number_of_top_level_images(context_.get()), 1));
    }
    std::vector<std::string> auxiliary_types() const;  // URNs, except those of alpha and depth

    std::vector<uint8_t> icc() const;
    std::vector<uint8_t> block(const char *type, const char *content_type) const;
    Owned<const heif_image> decode(heif_chroma chroma);

private:
    uint32_t rotated_width() const { return static_cast<uint32_t>(std::max(heif_image_handle_get_width(handle()), 0)); }
    uint32_t rotated_height() const {
        return static_cast<uint32_t>(std::max(heif_image_handle_get_height(handle()), 0));
    }
    void take_transfer(heif_color_profile_nclx *nclx);

    std::string path_, kind_;
    HeifErrors errors_;
    Owned<heif_context> context_{nullptr, heif_context_free};
    Owned<const heif_image_handle> handle_{nullptr, release};
    HeifProperties properties_;
    bool is_linear_ = false;
};

// ITU-T H.273, table 3.
void HeifFile::take_transfer(heif_color_profile_nclx *nclx) {
    const int transfer = nclx->transfer_characteristics;
    heif_nclx_color_profile_free(nclx);
    if (transfer == 16) fail_hdr(path_, kind_, "PQ");
    if (transfer == 18) fail_hdr(path_, kind_, "HLG");
    is_linear_ = transfer == 8;
}

std::vector<uint8_t> HeifFile::icc() const {
    std::vector<uint8_t> profile(heif_image_handle_get_raw_color_profile_size(handle()));
    if (profile.empty()) return is_linear_ ? linear_profile(is_grey()) : profile;
    errors_.check(heif_image_handle_get_raw_color_profile(handle(), profile.data()));
    return profile;
}

std::vector<std::string> HeifFile::auxiliary_types() const {
    constexpr int filter = LIBHEIF_AUX_IMAGE_FILTER_OMIT_ALPHA | LIBHEIF_AUX_IMAGE_FILTER_OMIT_DEPTH;
    std::vector<heif_item_id> ids(
        static_cast<size_t>(std::max(heif_image_handle_get_number_of_auxiliary_images(handle(), filter), 0)));
    heif_image_handle_get_list_of_auxiliary_image_IDs(handle(), filter, ids.data(), static_cast<int>(ids.size()));
    std::vector<std::string> types;
    for (const heif_item_id id : ids) {
        heif_image_handle *picture = nullptr;
        if (heif_image_handle_get_auxiliary_image_handle(handle(), id, &picture).code != heif_error_Ok) continue;
        const Owned<const heif_image_handle> owner(picture, release);
        const char *type = nullptr;
        if (heif_image_handle_get_auxiliary_type(picture, &type).code == heif_error_Ok && type) types.push_back(type);
        heif_image_handle_free_auxiliary_types(picture, &type);
    }
    return types;
}

// The first one of a type; empty if not found.
std::vector<uint8_t> HeifFile::block(const char *type, const char *content_type) const {
    std::vector<heif_item_id> ids(
        static_cast<size_t>(std::max(heif_image_handle_get_number_of_metadata_blocks(handle(), type), 0)));
    heif_image_handle_get_list_of_metadata_block_IDs(handle(), type, ids.data(), static_cast<int>(ids.size()));
    for (const heif_item_id id : ids) {
        const char *content = heif_image_handle_get_metadata_content_type(handle(), id);
        if (content_type && (!content || std::strcmp(content, content_type) != 0)) continue;
        std::vector<uint8_t> bytes(heif_image_handle_get_metadata_size(handle(), id));
        if (!bytes.empty()) errors_.check(heif_image_handle_get_metadata(handle(), id, bytes.data()));
        return bytes;
    }
    return {};
}

// Without `strict_decoding` damaged parts are replaced by similar content.
Owned<const heif_image> HeifFile::decode(heif_chroma chroma) {
    const Owned<heif_decoding_options> options(heif_decoding_options_alloc(), heif_decoding_options_free);
    if (!options) throw std::bad_alloc();
    if (options->version >= 3) options->strict_decoding = 1;
    heif_image *image = nullptr;
    errors_.run([&] { return heif_decode_image(handle(), &image, heif_colorspace_RGB, chroma, options.get()); });
    Owned<const heif_image> decoded(image, release_image);
    heif_color_profile_nclx *nclx = nullptr;  // profile of the coded picture, unless the file has its own
    if (heif_image_get_nclx_color_profile(image, &nclx).code == heif_error_Ok) take_transfer(nclx);
    return decoded;
}

// Positions of the pixels of the unrotated picture in the rotated one: `start`, and the steps per column and per row,
// in pixels and rows of the rotated one.
struct Rotated {
    int64_t start_x, start_y, column_x, column_y, row_x, row_y;
};

Rotated rotated(uint16_t orientation, int64_t width, int64_t height) {
    switch (orientation) {
    case 2: return {width - 1, 0, -1, 0, 0, 1};
    case 3: return {width - 1, height - 1, -1, 0, 0, -1};
    case 4: return {0, height - 1, 1, 0, 0, -1};
    case 5: return {0, 0, 0, 1, 1, 0};
    case 6: return {height - 1, 0, 0, 1, -1, 0};
    case 7: return {height - 1, width - 1, 0, -1, -1, 0};
    case 8: return {0, width - 1, 0, -1, 1, 0};
    default: return {0, 0, 1, 0, 0, 1};
    }
}

class HeifSource final : public RowSource {
public:
    HeifSource(const ReadRequest &request, const std::string &kind)
        : path_(request.path), kind_(kind), heif_(request.path, kind) {
        const bool has_alpha = heif_image_handle_has_alpha_channel(heif_.handle()) != 0;
        header_.traits.format = FileFormat::heif;
        header_.traits.is_lossy = true;
        header_.traits.orientation = heif_.orientation();
        if (heif_image_handle_is_premultiplied_alpha(heif_.handle()))
            header_.traits.alpha = PictureTraits::Alpha::associated;
        header_.sample = heif_.bits() > 8 ? LENSPROF_SAMPLE_U16 : LENSPROF_SAMPLE_U8;
        header_.layout = heif_.is_grey() ? (has_alpha ? LENSPROF_LAYOUT_GREY_ALPHA : LENSPROF_LAYOUT_GREY)
                                         : (has_alpha ? LENSPROF_LAYOUT_RGBA : LENSPROF_LAYOUT_RGB);
        header_.icc = heif_.icc();
        set_coded_frame(header_, heif_.width(), heif_.height(), request);
    }

    void read(uint8_t *row) override;

private:
    void decode();
    template <class Sample>
    void copy_row(Sample *row) const;

    std::string path_, kind_;
    HeifFile heif_;
    Owned<const heif_image> image_{nullptr, release_image};
    const uint8_t *pixels_ = nullptr;
    int row_bytes_ = 0;
    uint32_t white_ = 255, samples_ = 3, next_ = 0;  // of the decoded picture
};

void HeifSource::decode() {
    const bool deep = header_.sample == LENSPROF_SAMPLE_U16;
    const bool has_alpha = lensprof_layout_samples(header_.layout) % 2 == 0;
    const uint16_t probe = 1;
    uint8_t first = 0;
    std::memcpy(&first, &probe, 1);
    const heif_chroma native =
        first ? (has_alpha ? heif_chroma_interleaved_RRGGBBAA_LE : heif_chroma_interleaved_RRGGBB_LE)
              : (has_alpha ? heif_chroma_interleaved_RRGGBBAA_BE : heif_chroma_interleaved_RRGGBB_BE);
    const heif_chroma shallow = has_alpha ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB;
    stop_if_cancelled();
    image_ = heif_.decode(deep ? native : shallow);
    stop_if_cancelled();
    pixels_ = heif_image_get_plane_readonly(image_.get(), heif_channel_interleaved, &row_bytes_);
    const int bits = heif_image_get_bits_per_pixel_range(image_.get(), heif_channel_interleaved);
    const bool is_sideways = heif_.is_sideways();
    const int width = heif_image_get_width(image_.get(), heif_channel_interleaved),
              height = heif_image_get_height(image_.get(), heif_channel_interleaved);
    samples_ = has_alpha ? 4 : 3;
    if (!pixels_ || bits < 1 || bits > (deep ? 16 : 8)
        || heif_image_get_chroma_format(image_.get()) != (deep ? native : shallow)
        || static_cast<uint32_t>(is_sideways ? height : width) != header_.frame_width
        || static_cast<uint32_t>(is_sideways ? width : height) != header_.frame_height)
        fail_damaged(path_, kind_ + ": libheif decodes a picture other than the declared one");
    white_ = (1u << bits) - 1;
}

template <class Sample>
void HeifSource::copy_row(Sample *row) const {
    constexpr uint32_t full = sizeof(Sample) == 1 ? 255 : 65535;
    const Rotated t = rotated(heif_.orientation(), header_.frame_width, header_.frame_height);
    const int64_t pixel = static_cast<int64_t>(samples_ * sizeof(Sample));
    const int64_t step = t.column_x * pixel + t.column_y * row_bytes_;
    const uint8_t *from = pixels_ + (t.start_x + t.row_x * next_) * pixel + (t.start_y + t.row_y * next_) * row_bytes_;
    const uint32_t count = lensprof_layout_samples(header_.layout);
    for (uint32_t x = 0; x < header_.frame_width; ++x, from += step) {
        Sample pixel_samples[4];
        std::memcpy(pixel_samples, from, static_cast<size_t>(pixel));
        if (count < 3) pixel_samples[1] = pixel_samples[samples_ - 1];  // grey: red, green and blue are equal
        for (uint32_t c = 0; c < count; ++c)
            *row++ = static_cast<Sample>((std::min<uint32_t>(pixel_samples[c], white_) * uint64_t(full) + white_ / 2)
                                         / white_);
    }
}

void HeifSource::read(uint8_t *row) {
    if (!image_) decode();
    if (header_.sample == LENSPROF_SAMPLE_U16)
        copy_row(reinterpret_cast<uint16_t *>(row));
    else
        copy_row(row);
    ++next_;
}

}  // namespace

std::unique_ptr<RowSource> open_heif(const ReadRequest &request, const std::string &kind) {
    return std::make_unique<HeifSource>(request, kind);
}

CodedMetadata heif_metadata(const std::string &path, const std::string &kind) {
    const HeifFile heif(path, kind);
    CodedMetadata metadata;
    metadata.exif = exif_of_item(heif.block("Exif", nullptr));
    metadata.xmp = heif.block("mime", "application/rdf+xml");
    metadata.icc = heif.icc();
    metadata.width = heif.width();
    metadata.height = heif.height();
    metadata.orientation = heif.orientation();
    return metadata;
}

HeifParts heif_parts(const std::string &path, const std::string &kind) {
    const HeifFile heif(path, kind);
    const HeifContents contents = heif_contents(path);
    HeifParts parts;
    parts.is_sequence = contents.has_frames;
    parts.pictures = heif.pictures();
    bool has_gain_map = contents.has_tone_map;
    for (const std::string &type : heif.auxiliary_types()) {
        const bool is_gain_map = type.find("hdrgainmap") != std::string::npos;
        has_gain_map |= is_gain_map;
        if (!is_gain_map) parts.names.push_back("an auxiliary picture (" + type + ")");
    }
    if (contents.has_tone_map && parts.pictures == 2) parts.pictures = 1;  // the gain map may be listed as a picture
    if (has_gain_map) parts.names.push_back("a gain map (HDR)");
    if (heif_image_handle_has_depth_image(heif.handle())) parts.names.push_back("a depth map");
    if (contents.has_video) parts.names.push_back("a video");
    return parts;
}

}  // namespace codec

bool can_read_heif() { return true; }

}  // namespace lensprof
