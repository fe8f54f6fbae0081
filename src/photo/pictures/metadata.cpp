#include "photo/pictures/metadata.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <memory>
#include <mutex>
#include <vector>

#include <exiv2/exiv2.hpp>

#include "photo/base/failure.hpp"
#include "photo/base/utf8.hpp"
#include "photo/pictures/camera_correction.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/coded_metadata.hpp"
#include "photo/pictures/correction_mark.hpp"
#include "photo/pictures/exif_exposure.hpp"
#include "photo/pictures/exif_sensor.hpp"
#include "photo/pictures/exif_value.hpp"
#include "photo/pictures/icc.hpp"
#include "photo/pictures/lens_name.hpp"
#include "photo/pictures/maker_note.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/part_tags.hpp"
#include "photo/pictures/picture_excerpt.hpp"
#include "photo/pictures/png_exif.hpp"
#include "photo/pictures/raw_kind.hpp"

namespace lensprof {

namespace {

using ExivImage = std::unique_ptr<Exiv2::Image>;  // 0.27 of Exiv2 has std::auto_ptr

// Exiv2 unregisters and registers its XMP namespaces whenever it reads or writes XMP; anything another thread writes
// meanwhile silently loses its XMP. Only one thread at a time reads or writes metadata.
std::recursive_mutex &exiv2_mutex() {
    static std::recursive_mutex mutex;
    return mutex;
}

// Exiv2 logs to stderr, and its XMP parser shares state between threads unless it is given a lock.
void prepare_exiv2() {
    static std::once_flag once;
    std::call_once(once, [] {
        Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);
#ifdef EXV_ENABLE_BMFF
        Exiv2::enableBMFF();  // CR3
#endif
        Exiv2::XmpParser::initialize(
            [](void *lock, bool take) {
                std::recursive_mutex *m = static_cast<std::recursive_mutex *>(lock);
                take ? m->lock() : m->unlock();
            },
            &exiv2_mutex());
        register_correction_mark();
    });
}

[[noreturn]] void fail_reading(const std::string &path, const std::exception &error) {
    std::string text = error.what();
    if (text.compare(0, path.size() + 2, path + ": ") == 0) text.erase(0, path.size() + 2);
    throw Failure(LENSPROF_ERROR_READ,
                  path + ": cannot read metadata: " + text + "; check that it is a picture, or copy it again");
}

[[noreturn]] void fail_writing(const std::string &path, const std::exception &error) {
    throw Failure(LENSPROF_ERROR_WRITE, path + ": cannot write metadata: " + error.what() + "; write another format");
}

bool is_big_tiff(const std::string &path) {
    const codec::File file = codec::open_for_reading(path);
    char start[4] = {};
    return std::fread(start, 1, sizeof start, file.get()) == sizeof start
           && (std::memcmp(start, "II+\0", 4) == 0 || std::memcmp(start, "MM\0+", 4) == 0);
}

// Exiv2 adds EXIF of a PNG's standard chunk to that of a text chunk before it.
void read_once(Exiv2::Image &image) {
    const std::lock_guard<std::recursive_mutex> alone(exiv2_mutex());
    image.readMetadata();
    if (image.mimeType() == "image/png") codec::keep_last(image.exifData());
}

ExivImage open_image(const std::string &path) {
    prepare_exiv2();
    codec::open_for_reading(path);  // for its errors, which are more specific than those of Exiv2
    const auto coded = coded_kind(path);
    try {
        if (coded && !raw_kind(path)) {
            const std::lock_guard<std::recursive_mutex> alone(exiv2_mutex());
            return open_coded_image(path, *coded);
        }
        ExivImage image(Exiv2::ImageFactory::open(path).release());
        read_once(*image);
        return image;
    } catch (const Failure &) {
        throw;
    } catch (const std::exception &error) {
        fail_reading(path, error);
    }
}

// Reading.

// Truncates text too long for the field, and records this.
template <size_t size>
void store_text(const std::string &text, char (&field)[size], const char *option, PictureMetadata &metadata) {
    const size_t length = utf8_cut(text, size - 1);
    std::memcpy(field, text.data(), length);
    std::memset(field + length, 0, size - length);
    if (length < text.size()) metadata.cut.emplace_back(option);
}

// The name of the picture style in the maker notes, as text if Exiv2 knows it.
std::string read_style(const Exiv2::ExifData &exif) {
    for (const char *key :
         {"Exif.CanonPr.PictureStyle", "Exif.NikonPc.Name", "Exif.Fujifilm.FilmMode", "Exif.Sony1.ColorReproduction",
          "Exif.Sony2.ColorReproduction", "Exif.OlympusCs.PictureMode", "Exif.Panasonic.PhotoStyle",
          "Exif.Pentax.ImageTone", "Exif.PentaxDng.ImageTone"}) {
        const auto datum = exif.findKey(Exiv2::ExifKey(key));
        if (datum == exif.end() || datum->count() == 0) continue;
        const std::string name = clean_text(datum->print(&exif));
        if (is_name(name)) return name;
    }
    return {};
}

// Serial numbers of camera and lens, as far as known: "BODY", "BODY/LENS" or "/LENS".
std::string read_unit(const Exiv2::ExifData &exif) {
    const auto of_maker = Exiv2::serialNumber(exif);
    const std::string lens = read_text(exif, "Exif.Photo.LensSerialNumber");
    const auto is_nothing = [](const std::string &text) { return text.find_first_not_of("0 .-") == std::string::npos; };
    std::string unit = read_text(exif, "Exif.Photo.BodySerialNumber");
    if (is_nothing(unit) && of_maker != exif.end()) unit = clean_text(of_maker->print(&exif));
    if (is_nothing(unit)) unit.clear();
    return is_nothing(lens) ? unit : unit + "/" + lens;
}

// Maker notes contain "3.5 m", "Infinity", "Unknown" or similar; above 10 km the number means something else.
double parse_distance(const std::string &text) {
    if (text.compare(0, 5, "Infin") == 0) return INFINITY;
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || std::string(end) != " m") return LENSPROF_UNKNOWN;
    return in_range(value, 1e4).value_or(LENSPROF_UNKNOWN);
}

double read_distance(const Exiv2::ExifData &exif) {
    const auto stated = exif.findKey(Exiv2::ExifKey("Exif.Photo.SubjectDistance"));
    if (stated != exif.end() && stated->count() > 0) {
        const auto *value = dynamic_cast<const Exiv2::URationalValue *>(&stated->value());
        if (value && value->value_[0].first == 0xffffffffu)  // EXIF 2.32: means infinity; 0 means unknown
            return INFINITY;
        const std::optional<double> distance = in_range(number(*stated), 1e4);
        if (distance) return *distance;
    }
    const auto datum = Exiv2::subjectDistance(exif);
    return datum == exif.end() || datum == stated ? LENSPROF_UNKNOWN : parse_distance(clean_text(datum->print(&exif)));
}

// Writing.

template <size_t count>
bool begins_with_one(const std::string &text, const char *const (&starts)[count]) {
    return std::any_of(std::begin(starts), std::end(starts),
                       [&](const char *start) { return text.compare(0, std::strlen(start), start) == 0; });
}

// Reads, changes and writes the metadata of a file in memory, because Exiv2 does not detect a full disk. False if the
// excerpt was not sufficient.
bool edit_excerpt(const std::string &path, const codec::PictureExcerpt &excerpt,
                  const std::function<void(Exiv2::Image &)> &change) {
    ExivImage image;
    try {
        image.reset(
            Exiv2::ImageFactory::open(excerpt.bytes().data(), static_cast<long>(excerpt.bytes().size())).release());
        read_once(*image);
    } catch (const std::exception &error) {
        fail_reading(path, error);
    }
    Exiv2::BasicIo &io = image->io();
    const bool png = image->mimeType() == "image/png";
    const Exiv2::byte *data = nullptr;
    std::vector<uint8_t> exif;
    try {
        const std::lock_guard<std::recursive_mutex> alone(exiv2_mutex());
        change(*image);
        if (png) exif = codec::take_exif(*image);
        image->writeMetadata();
        io.open();
        data = io.mmap();
    } catch (const std::exception &error) {
        fail_writing(path, error);
    }
    if (exif.empty()) return excerpt.replace(data, static_cast<size_t>(io.size()));
    const std::vector<uint8_t> edited = codec::with_exif(data, static_cast<size_t>(io.size()), exif);
    return excerpt.replace(edited.data(), edited.size());
}

// Without the pixels if possible, so that memory does not grow with them.
void edit_metadata(const std::string &path, const std::function<void(Exiv2::Image &)> &change) {
    prepare_exiv2();
    const auto excerpt = codec::excerpt_of(path);
    if (!excerpt || !edit_excerpt(path, *excerpt, change)) edit_excerpt(path, *codec::whole_file(path), change);
}

// Tags of the main directory that describe how pixels are stored, point to other parts of the file, or hold data kept
// elsewhere (ICC, XMP, IPTC).
bool is_structure(uint16_t tag) {
    static const uint16_t tags[] = {254, 255, 256, 257, 258, 259,   262,   263,   264,   265,   266,  273, 277,
                                    278, 279, 280, 281, 284, 288,   289,   290,   291,   292,   293,  317, 320,
                                    321, 322, 323, 324, 325, 326,   327,   328,   330,   332,   334,  336, 338,
                                    339, 340, 341, 342, 347, 512,   513,   514,   515,   517,   518,  519, 520,
                                    521, 529, 530, 532, 700, 33723, 34377, 34665, 34675, 34853, 37724};
    return std::binary_search(std::begin(tags), std::end(tags), tag);
}

// Directories of other pictures in the file.
bool is_other_picture(const std::string &group) {
    static const char *const starts[] = {"Thumbnail", "SubImage", "SubThumb", "Image2", "Image3", "PanaRaw", "MpfInfo"};
    return begins_with_one(group, starts);
}

// Tags of the main directory that describe a mosaic and a DNG; developed pictures do not have them.
bool is_of_raw(uint16_t tag) { return tag == 33421 || tag == 33422 || (tag >= 50706 && tag <= 52600); }

bool keep_exif(const Exiv2::Exifdatum &datum, const Exiv2::ExifData &target, bool to_tiff) {
    static const uint16_t resolution[] = {282, 283, 296};
    const uint16_t tag = datum.tag();
    if (is_other_picture(datum.groupName())) return false;
    if (datum.groupName() != "Image") return true;
    if (to_tiff && tag == 531)  // position of chroma samples, which do not exist here
        return false;
    if (to_tiff && std::find(std::begin(resolution), std::end(resolution), tag) != std::end(resolution))
        return target.findKey(Exiv2::ExifKey("Exif.Image.XResolution")) == target.end();
    return !is_structure(tag);
}

Exiv2::ExifData merge_exif(const Exiv2::ExifData &source, const Exiv2::ExifData &target, bool to_tiff, bool from_raw) {
    Exiv2::ExifData merged = target;
    std::vector<const Exiv2::Exifdatum *> kept;
    for (const Exiv2::Exifdatum &datum : source) {
        const bool is_lost = from_raw && datum.groupName() == "Image" && is_of_raw(datum.tag());
        if (!is_lost && keep_exif(datum, target, to_tiff)) kept.push_back(&datum);
    }
    for (const Exiv2::Exifdatum *datum : kept) {
        const auto old = merged.findKey(Exiv2::ExifKey(datum->key()));
        if (old != merged.end()) merged.erase(old);
    }
    for (const Exiv2::Exifdatum *datum : kept) merged.add(*datum);
    return merged;
}

// Removes the thumbnail, and references to parts of the old file that are not copied.
Exiv2::XmpData copy_xmp(Exiv2::XmpData source, bool keeps_parts) {
    codec::remove_extended_tags(source);
    static const char *const removed_prefixes[] = {"Xmp.xmp.Thumbnails", "Xmp.xmpNote."};
    Exiv2::XmpData copy;
    for (const Exiv2::Xmpdatum &datum : source) {
        if (!begins_with_one(datum.key(), removed_prefixes)) copy.add(datum);
    }
    if (!keeps_parts) codec::remove_part_tags(copy);
    return copy;
}

// Updates stated sizes to those of the file.
void set_sizes(Exiv2::ExifData &exif, Exiv2::XmpData &xmp, uint32_t width, uint32_t height) {
    for (const bool x : {true, false}) {
        const uint32_t size = x ? width : height;
        const auto stated =
            exif.findKey(Exiv2::ExifKey(x ? "Exif.Photo.PixelXDimension" : "Exif.Photo.PixelYDimension"));
        if (stated != exif.end()) *stated = size;
        for (const char *key : {x ? "Xmp.exif.PixelXDimension" : "Xmp.exif.PixelYDimension",
                                x ? "Xmp.tiff.ImageWidth" : "Xmp.tiff.ImageLength"}) {
            const auto datum = xmp.findKey(Exiv2::XmpKey(key));
            if (datum != xmp.end()) datum->setValue(std::to_string(size));
        }
    }
}

void set_text(Exiv2::ExifData &exif, const char *key, const char *text) {
    if (text[0] != '\0') exif[key] = std::string(text);
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

ToneCurve read_tone_curve(Exiv2::Image &image) {
    if (!image.iccProfileDefined()) return ToneCurve::unknown;
#if EXIV2_TEST_VERSION(0, 28, 0)
    return tone_curve_of(image.iccProfile().c_data(), image.iccProfile().size());
#else
    return tone_curve_of(image.iccProfile()->pData_, static_cast<size_t>(image.iccProfile()->size_));
#endif
}

void read_processing(const std::string &path, Exiv2::Image &image, PictureMetadata &metadata) {
    if (raw_kind(path)) {
        metadata.key.processing = LENSPROF_PROCESSING_RAW;
        return;
    }
    const bool is_tiff = image.mimeType() == "image/tiff";
    const ToneCurve curve = read_tone_curve(image);
    const bool is_float = is_tiff && read_number(image.exifData(), {"Exif.Image.SampleFormat"}) == 3;
    if (is_float || curve == ToneCurve::linear) metadata.key.processing = LENSPROF_PROCESSING_RAW;
    metadata.may_be_linear = is_tiff && !is_float && curve == ToneCurve::unknown
                             && read_number(image.exifData(), {"Exif.Image.BitsPerSample"}) == 16;
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
    const ExivImage image = open_image(path);
    repair_maker_note(*image);
    const Exiv2::ExifData &exif = image->exifData();
    try {
        store_text(read_text(exif, "Exif.Image.Make"), metadata.key.camera_maker, "maker", metadata);
        store_text(read_text(exif, "Exif.Image.Model"), metadata.key.camera_model, "camera", metadata);
        metadata.software = read_text(exif, "Exif.Image.Software");
        const LensName lens = read_lens(exif, image->xmpData());
        store_text(lens.name, metadata.key.lens, "lens", metadata);
        metadata.ambiguous_lens = lens.ambiguous;
        read_exposure(exif, metadata);
        metadata.key.aperture = metadata.f_number.value_or(LENSPROF_UNKNOWN);
        metadata.key.focal_mm = in_range(read_number(exif, {"Exif.Photo.FocalLength", "Exif.Image.FocalLength"}), 1e5)
                                    .value_or(LENSPROF_UNKNOWN);
        metadata.key.distance_m = read_distance(exif);
        metadata.size = {static_cast<uint32_t>(image->pixelWidth()), static_cast<uint32_t>(image->pixelHeight())};
        read_sensor(exif, raw_kind(path).has_value(), metadata);
        store_text(read_unit(exif), metadata.key.unit, "unit", metadata);
        store_text(read_style(exif), metadata.key.style, "style", metadata);
        read_processing(path, *image, metadata);
        metadata.is_of_camera = is_of_camera(*image) && !is_of_converter(*image);
        metadata.mark = correction_mark_of(image->xmpData());
        metadata.orientation =
            static_cast<uint16_t>(in_range(read_number(exif, {"Exif.Image.Orientation"}), 9.0).value_or(1.0));
        // corrections stated in a raw file are instructions for its development
        set_corrected(raw_kind(path) ? std::string() : falloff_corrected_by(*image, metadata.key), metadata);
    } catch (const std::exception &error) {
        fail_reading(path, error);
    }
    return metadata;
}

std::string read_xmp_packet(const std::string &path) {
    return is_big_tiff(path) ? std::string() : open_image(path)->xmpPacket();
}

bool copy_metadata(const std::string &source, const std::string &target, const CorrectionMark *mark) {
    if (is_big_tiff(source) || is_big_tiff(target)) return false;
    const ExivImage from = open_image(source);
    const bool from_raw = raw_kind(source).has_value();
    const OtherParts parts = other_parts(source, target);
    edit_metadata(target, [&](Exiv2::Image &to) {
        const bool tiff = to.mimeType() == "image/tiff";
        Exiv2::ExifData exif = merge_exif(from->exifData(), to.exifData(), tiff, from_raw);
        Exiv2::XmpData xmp = copy_xmp(from->xmpData(), !parts.kept.empty());
        if (parts.kept.empty() && !parts.left_out.empty()) codec::remove_gain_map_tags(exif);
        set_sizes(exif, xmp, static_cast<uint32_t>(to.pixelWidth()), static_cast<uint32_t>(to.pixelHeight()));
        const auto mime_type = xmp.findKey(Exiv2::XmpKey("Xmp.dc.format"));
        if (mime_type != xmp.end()) mime_type->setValue(to.mimeType());
        if (mark) set_correction_mark(*mark, xmp);
        to.setExifData(exif);
        to.setXmpData(xmp);
        to.setIptcData(from->iptcData());
        if (!tiff)  // maker notes that Exiv2 does not know are copied byte by byte
            to.setByteOrder(from->byteOrder());
        if (!from->comment().empty() && (to.checkMode(Exiv2::mdComment) & Exiv2::amWrite))
            to.setComment(from->comment());
    });
    return true;
}

bool write_metadata(const std::string &path, const PictureMetadata &metadata) {
    if (is_big_tiff(path)) return false;
    edit_metadata(path, [&](Exiv2::Image &image) {
        const lensprof_profile_key &key = metadata.key;
        Exiv2::ExifData &exif = image.exifData();
        set_text(exif, "Exif.Image.Make", key.camera_maker);
        set_text(exif, "Exif.Image.Model", key.camera_model);
        set_text(exif, "Exif.Image.Software", metadata.software.c_str());
        set_text(exif, "Exif.Photo.LensModel", key.lens);
        set_rational(exif, "Exif.Photo.FocalLength", key.focal_mm);
        set_rational(exif, "Exif.Photo.SubjectDistance", key.distance_m);
        if (std::isinf(key.distance_m)) exif["Exif.Photo.SubjectDistance"] = Exiv2::URational(0xffffffffu, 1);
        write_exposure(metadata, exif);
    });
    return true;
}

std::string packet_of_mark(const CorrectionMark &mark) {
    prepare_exiv2();
    Exiv2::XmpData xmp;
    set_correction_mark(mark, xmp);
    std::string packet;
    return Exiv2::XmpParser::encode(packet, xmp, Exiv2::XmpParser::useCompactFormat) == 0 ? packet : std::string();
}

std::optional<CorrectionMark> mark_of_packet(const std::string &packet) {
    prepare_exiv2();
    Exiv2::XmpData xmp;
    if (Exiv2::XmpParser::decode(xmp, packet) != 0) return std::nullopt;
    return correction_mark_of(xmp);
}

}  // namespace lensprof
