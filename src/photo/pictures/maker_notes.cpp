#include "photo/pictures/maker_notes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>

#include <exiv2/exiv2.hpp>

#include "photo/pictures/exif_tags.hpp"
#include "photo/pictures/exif_value.hpp"
#include "photo/pictures/maker_correction.hpp"
#include "photo/pictures/maker_note.hpp"

namespace lensprof {

namespace {

// Exiv2 unregisters and registers its XMP namespaces whenever it reads XMP. Only one thread at a time uses it.
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
    });
}

using ExivImage = std::unique_ptr<Exiv2::Image>;  // 0.27 of Exiv2 has std::auto_ptr

ExivImage open_image(const std::string &path) {
    prepare_exiv2();
    ExivImage image(Exiv2::ImageFactory::open(path).release());
    const std::lock_guard<std::recursive_mutex> alone(exiv2_mutex());
    image->readMetadata();
    return image;
}

// EXIF with maker notes; of a block, or of a file whose other parts may matter.
MakerExif read_maker_exif(const std::string &path, const std::vector<uint8_t> &block) {
    MakerExif exif;
    prepare_exiv2();
    if (block.empty()) {
        const ExivImage image = open_image(path);
        exif.data = image->exifData();
        exif.order = image->byteOrder();
    } else {
        exif.order = Exiv2::ExifParser::decode(exif.data, block.data(), static_cast<uint32_t>(block.size()));
    }
    return exif;
}

std::string print_of(const Exiv2::ExifData &exif, const char *key) {
    const auto datum = exif.findKey(Exiv2::ExifKey(key));
    return datum == exif.end() || datum->count() == 0 ? std::string() : clean_text(datum->print(&exif));
}

// Canon's focal lengths are integers in a unit that is stated, too: longest, shortest, units per mm.
std::optional<FocalRange> canon_range(const Exiv2::ExifData &exif) {
    const auto datum = exif.findKey(Exiv2::ExifKey("Exif.CanonCs.Lens"));
    if (datum == exif.end() || datum->count() < 3 || datum->toLong(2) <= 0 || datum->toLong(1) <= 0)
        return std::nullopt;
    const double units = datum->toFloat(2);
    return FocalRange{datum->toFloat(1) / units, datum->toFloat(0) / units};
}

// What Exiv2 prints for the first number that means a lens: its name, a list of names or, if it does not know it or
// several share it, the number.
std::string print_number(const Exiv2::ExifData &exif) {
    std::string unknown;
    for (const char *key : {"Exif.CanonCs.LensType", "Exif.NikonLd1.LensIDNumber", "Exif.NikonLd2.LensIDNumber",
                            "Exif.NikonLd3.LensIDNumber", "Exif.Pentax.LensType", "Exif.PentaxDng.LensType",
                            "Exif.Minolta.LensID", "Exif.SonyMinolta.LensID", "Exif.Sony1.LensID", "Exif.Sony2.LensID",
                            "Exif.OlympusEq.LensType", "Exif.Panasonic.LensType", "Exif.Samsung2.LensType"}) {
        const std::string name = print_of(exif, key);
        if (is_name(name)) return name;
        const bool is_number = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
        if (unknown.empty() && is_number && name != "0" && name != "65535") unknown = name;
    }
    return unknown;
}

void add_numbers(Exiv2::ExifData &exif, const char *key, Exiv2::TypeId type, const std::string &numbers) {
    const auto value = Exiv2::Value::create(type);
    if (value->read(numbers) == 0) exif.add(Exiv2::ExifKey(key), value.get());
}

// The name of the picture style, as text if Exiv2 knows it.
std::string read_style(const Exiv2::ExifData &exif) {
    for (const char *key :
         {"Exif.CanonPr.PictureStyle", "Exif.NikonPc.Name", "Exif.Fujifilm.FilmMode", "Exif.Sony1.ColorReproduction",
          "Exif.Sony2.ColorReproduction", "Exif.OlympusCs.PictureMode", "Exif.Panasonic.PhotoStyle",
          "Exif.Pentax.ImageTone", "Exif.PentaxDng.ImageTone"})
        if (const std::string name = print_of(exif, key); is_name(name)) return name;
    return {};
}

// Maker notes contain "3.5 m", "Infinity", "Unknown" or similar; above 10 km the number means something else.
double parse_distance(const std::string &text) {
    if (text.compare(0, 5, "Infin") == 0) return INFINITY;
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || std::string(end) != " m") return LENSPROF_UNKNOWN;
    return in_range(value, 1e4).value_or(LENSPROF_UNKNOWN);
}

// What Exiv2 finds in the notes of any maker; not in the plain EXIF.
std::string print_of_maker(const Exiv2::ExifData &exif,
                           Exiv2::ExifData::const_iterator (*find)(const Exiv2::ExifData &)) {
    const auto datum = find(exif);
    if (datum == exif.end() || datum->groupName() == "Photo") return {};
    return clean_text(datum->print(&exif));
}

MakerNotes notes_of(const MakerExif &exif) {
    MakerNotes notes;
    const auto model = exif.data.findKey(Exiv2::ExifKey("Exif.Canon.LensModel"));
    if (model != exif.data.end()) notes.lens_model = clean_text(model->toString());
    notes.lens_of_number = print_number(exif.data);
    notes.lens_range = canon_range(exif.data);
    notes.style = read_style(exif.data);
    notes.serial_number = print_of_maker(exif.data, Exiv2::serialNumber);
    notes.distance_m = parse_distance(print_of_maker(exif.data, Exiv2::subjectDistance));
    // the readable form is the standard number, the raw one often is not
    notes.iso = in_range(std::strtod(print_of_maker(exif.data, Exiv2::isoSpeed).c_str(), nullptr), 1e8);
    notes.correction = correction_in_notes(exif);
    return notes;
}

}  // namespace

MakerNotes read_maker_notes(const std::string &path, const PictureBlocks &blocks) {
    const bool is_plain = !blocks.exif_block.empty() || blocks.mime_type == "image/tiff" || blocks.exif.is_empty();
    if (is_plain && !blocks.exif.find(exif_tags::maker_note) && !blocks.exif.find(exif_tags::dng_private_data))
        return {};
    try {
        MakerExif exif = read_maker_exif(path, blocks.exif_block);
        repair_maker_note(exif);
        return notes_of(exif);
    } catch (const std::exception &) {  // of Exiv2: the plain EXIF counts
        return {};
    }
}

std::string lens_of_number(const std::string &maker, const std::string &model, const std::string &number,
                           const std::optional<FocalRange> &range) {
    static const struct {
        const char *maker, *key;
        Exiv2::TypeId type;
    } keys[] = {{"Canon", "Exif.CanonCs.LensType", Exiv2::unsignedShort},
                {"SONY", "Exif.Sony2.LensID", Exiv2::unsignedLong}};
    for (const auto &entry : keys) {
        if (maker.compare(0, std::strlen(entry.maker), entry.maker) != 0) continue;
        Exiv2::ExifData exif;
        exif["Exif.Image.Make"] = maker;
        exif["Exif.Image.Model"] = model;
        add_numbers(exif, entry.key, entry.type, number);
        if (range)
            add_numbers(exif, "Exif.CanonCs.Lens", Exiv2::unsignedShort,
                        std::to_string(std::lround(range->longest)) + " " + std::to_string(std::lround(range->shortest))
                            + " 1");
        return print_number(exif);
    }
    return {};
}

std::optional<PictureBlocks> read_other_blocks(const std::string &path) {
    const ExivImage image = open_image(path);
    PictureBlocks blocks;
    blocks.mime_type = image->mimeType();
    blocks.width = static_cast<uint32_t>(image->pixelWidth());
    blocks.height = static_cast<uint32_t>(image->pixelHeight());
    blocks.xmp = image->xmpPacket();
    blocks.comment = image->comment();
    Exiv2::Blob block;
    Exiv2::ExifParser::encode(block, image->byteOrder() == Exiv2::bigEndian ? Exiv2::bigEndian : Exiv2::littleEndian,
                              image->exifData());
    blocks.exif = read_exif(block);
    return blocks;
}

}  // namespace lensprof
