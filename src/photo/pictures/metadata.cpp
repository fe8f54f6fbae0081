#include "photo/pictures/metadata.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "photo/base/utf8.hpp"
#include "photo/pictures/camera_correction.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/copied_metadata.hpp"
#include "photo/pictures/correction_mark.hpp"
#include "photo/pictures/exif_exposure.hpp"
#include "photo/pictures/exif_sensor.hpp"
#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/exif_value.hpp"
#include "photo/pictures/icc.hpp"
#include "photo/pictures/lens_name.hpp"
#include "photo/pictures/maker_notes.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/picture_blocks.hpp"
#include "photo/pictures/raw_kind.hpp"

namespace lensprof {

namespace {

bool is_big_tiff(const std::string &path) {
    const codec::File file = codec::open_for_reading(path);
    char start[4] = {};
    return std::fread(start, 1, sizeof start, file.get()) == sizeof start
           && (std::memcmp(start, "II+\0", 4) == 0 || std::memcmp(start, "MM\0+", 4) == 0);
}

// Truncates text too long for the field, and records this.
template <size_t size>
void store_text(const std::string &text, char (&field)[size], const char *option, PictureMetadata &metadata) {
    const size_t length = utf8_cut(text, size - 1);
    std::memcpy(field, text.data(), length);
    std::memset(field + length, 0, size - length);
    if (length < text.size()) metadata.cut.emplace_back(option);
}

// Serial numbers of camera and lens, as far as known: "BODY", "BODY/LENS" or "/LENS".
std::string read_unit(const Exif &exif, const std::string &of_maker) {
    const auto is_nothing = [](const std::string &text) { return text.find_first_not_of("0 .-") == std::string::npos; };
    const std::string lens = read_text(exif, exif_tags::lens_serial_number);
    std::string unit = read_text(exif, exif_tags::body_serial_number);
    if (is_nothing(unit)) unit = read_text(exif, exif_tags::camera_serial_number);
    if (is_nothing(unit)) unit = of_maker;
    if (is_nothing(unit)) unit.clear();
    return is_nothing(lens) ? unit : unit + "/" + lens;
}

double read_distance(const Exif &exif, double of_maker) {
    constexpr uint32_t infinite = 0xffffffffu;  // EXIF 2.32; 0 means unknown
    const ExifTag tag = exif_tags::subject_distance;
    if (const auto fraction = read_fraction(exif, tag); fraction && fraction->first == infinite) return INFINITY;
    const auto distance = in_range(read_number(exif, {tag, exif_tags::in_image(tag)}), 1e4);
    return distance ? *distance : of_maker;
}

// The mark of lensprof describes the last correction.
void set_corrected(const std::string &by_others, PictureMetadata &metadata) {
    metadata.processing_before = metadata.key.processing;
    const auto &mark = metadata.mark;
    const bool is_marked = mark && mark->falloff != CorrectionMark::Falloff::kept;
    if (is_marked && mark->falloff == CorrectionMark::Falloff::added) return;
    metadata.corrected_by = is_marked ? "by " + mark->software + ", from " + mark->source : by_others;
    if (!metadata.corrected_by.empty()) metadata.key.processing = LENSPROF_PROCESSING_CORRECTED;
}

void read_processing(const PictureBlocks &blocks, bool is_raw, PictureMetadata &metadata) {
    if (is_raw || blocks.mime_type == "image/fits") {
        metadata.key.processing = LENSPROF_PROCESSING_RAW;
        return;
    }
    const bool is_tiff = blocks.mime_type == "image/tiff";
    const ToneCurve curve =
        blocks.icc.empty() ? ToneCurve::unknown : tone_curve_of(blocks.icc.data(), blocks.icc.size());
    const bool is_float = is_tiff && read_number(blocks.exif, {exif_tags::sample_format}) == 3;
    if (is_float || curve == ToneCurve::linear) metadata.key.processing = LENSPROF_PROCESSING_RAW;
    metadata.may_be_linear = is_tiff && !is_float && curve == ToneCurve::unknown
                             && read_number(blocks.exif, {exif_tags::bits_per_sample}) == 16;
}

void read_camera(const Exif &exif, const Xmp &xmp, const MakerNotes &notes, PictureMetadata &metadata) {
    store_text(read_text(exif, exif_tags::make), metadata.key.camera_maker, "maker", metadata);
    store_text(read_text(exif, exif_tags::model), metadata.key.camera_model, "camera", metadata);
    metadata.software = read_text(exif, exif_tags::software);
    const LensName lens = read_lens(exif, xmp, notes);
    store_text(lens.name, metadata.key.lens, "lens", metadata);
    metadata.ambiguous_lens = lens.ambiguous;
    store_text(read_unit(exif, notes.serial_number), metadata.key.unit, "unit", metadata);
    store_text(notes.style, metadata.key.style, "style", metadata);
}

void set_text(Exif &exif, ExifTag tag, const char *text) {
    if (text[0] != '\0') exif.set_text(tag, text);
}

}  // namespace

PictureMetadata unknown_metadata() {
    PictureMetadata metadata = {};
    lensprof_profile_key_init(&metadata.key);
    return metadata;
}

PictureMetadata read_metadata(const std::string &path) {
    PictureMetadata metadata = unknown_metadata();
    if (is_big_tiff(path)) return metadata;
    const PictureBlocks blocks = read_blocks(path);
    const Exif &exif = blocks.exif;
    const Xmp xmp(blocks.xmp);
    const MakerNotes notes = read_maker_notes(path, blocks);
    const bool is_raw = raw_kind(path).has_value();
    read_camera(exif, xmp, notes, metadata);
    read_exposure(exif, notes.iso, metadata);
    metadata.key.aperture = metadata.f_number.value_or(LENSPROF_UNKNOWN);
    const ExifTag focal = exif_tags::focal_length;
    metadata.key.focal_mm =
        in_range(read_number(exif, {focal, exif_tags::in_image(focal)}), 1e5).value_or(LENSPROF_UNKNOWN);
    metadata.key.distance_m = read_distance(exif, notes.distance_m);
    metadata.size = {blocks.width, blocks.height};
    read_sensor(exif, is_raw, metadata);
    if (!is_raw) read_levels(exif, metadata);
    read_processing(blocks, is_raw, metadata);
    metadata.is_of_camera = blocks.is_of_camera && !is_of_converter(exif, xmp);
    metadata.mark = correction_mark_of(xmp);
    metadata.orientation =
        static_cast<uint16_t>(in_range(read_number(exif, {exif_tags::orientation}), 9.0).value_or(1.0));
    // corrections stated in a raw file are instructions for its development
    set_corrected(is_raw ? std::string() : falloff_corrected_by(blocks, xmp, notes.correction, metadata.key), metadata);
    return metadata;
}

std::string read_xmp_packet(const std::string &path) {
    return is_big_tiff(path) ? std::string() : read_blocks(path).xmp;
}

bool copy_metadata(const std::string &source, const std::string &target, const CorrectionMark *mark) {
    if (is_big_tiff(source) || is_big_tiff(target)) return false;
    const PictureBlocks from = read_blocks(source);
    const bool from_raw = raw_kind(source).has_value();
    const OtherParts parts = other_parts(source, target);
    edit_blocks(target, [&](PictureBlocks &to) {
        copy_exif(from, from_raw, to);
        if (parts.kept.empty() && !parts.left_out.empty()) remove_gain_map(to.exif);
        Xmp xmp(from.xmp);
        edit_copied_xmp(!parts.kept.empty(), to, xmp);
        if (mark) set_correction_mark(*mark, xmp);
        to.xmp = xmp.packet();
        to.iptc = from.iptc;
        if (!from.comment.empty()) to.comment = from.comment;
    });
    return true;
}

bool write_metadata(const std::string &path, const PictureMetadata &metadata) {
    if (is_big_tiff(path)) return false;
    edit_blocks(path, [&](PictureBlocks &blocks) {
        const lensprof_profile_key &key = metadata.key;
        set_text(blocks.exif, exif_tags::make, key.camera_maker);
        set_text(blocks.exif, exif_tags::model, key.camera_model);
        set_text(blocks.exif, exif_tags::software, metadata.software.c_str());
        set_text(blocks.exif, exif_tags::lens_model, key.lens);
        set_rational(blocks.exif, exif_tags::focal_length, key.focal_mm);
        set_rational(blocks.exif, exif_tags::subject_distance, key.distance_m);
        if (std::isinf(key.distance_m)) set_fraction(blocks.exif, exif_tags::subject_distance, 0xffffffffu, 1);
        write_exposure(metadata, blocks.exif);
    });
    return true;
}

std::string packet_of_mark(const CorrectionMark &mark) {
    Xmp xmp;
    set_correction_mark(mark, xmp);
    return xmp.packet();
}

std::optional<CorrectionMark> mark_of_packet(const std::string &packet) { return correction_mark_of(Xmp(packet)); }

}  // namespace lensprof
