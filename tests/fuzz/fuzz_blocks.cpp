// Fuzzing blocks of metadata without the picture around them: EXIF, XMP packets, resources of Photoshop. Invariant for
// any bytes: what is read from a block reads back the same after writing.
#include <algorithm>

#include "fuzz_main.hpp"
#include "photo/pictures/exif_layout.hpp"
#include "photo/pictures/photoshop_block.hpp"
#include "photo/pictures/xmp_packet.hpp"

namespace {

using namespace lensprof;

const char *const kTarget = "fuzz_blocks";
const std::vector<std::string> kWords = {std::string(4, '\0'),
                                         "\xFF\xFF\xFF\xFF",
                                         "II*",
                                         "MM",
                                         "\x69\x87",
                                         "\x87\x69",
                                         "\x25\x88",
                                         "\x7C\x92",
                                         "\x05\xA0",
                                         "\x80",
                                         "\x7F",
                                         "8BIM",
                                         "8BIM\x04\x04",
                                         "\x1C\x02",
                                         "<rdf:Description",
                                         "</rdf:Description>",
                                         "<rdf:li>",
                                         "<rdf:Seq/>",
                                         "<!--",
                                         "<![CDATA[",
                                         " xmlns:a=\"b\"",
                                         "&#0;",
                                         "&amp;",
                                         "<a><a><a><a><a><a><a><a>"};

// What a writer keeps: one field per tag, in order, without pointers to directories.
std::vector<ExifField> kept_fields(std::vector<ExifField> fields) {
    const auto is_left_out = [](const ExifField &field) {
        return field.bytes.empty() || field.tag == exif_pointer || field.tag == gps_pointer
               || field.tag == interoperability_pointer;
    };
    fields.erase(std::remove_if(fields.begin(), fields.end(), is_left_out), fields.end());
    std::stable_sort(fields.begin(), fields.end(), [](const auto &a, const auto &b) { return a.tag < b.tag; });
    fields.erase(std::unique(fields.begin(), fields.end(), [](const auto &a, const auto &b) { return a.tag == b.tag; }),
                 fields.end());
    return fields;
}

// The offsets in a maker note follow its place.
bool are_same(const ExifField &a, const ExifField &b) {
    return a.tag == b.tag && a.type == b.type && a.count == b.count
           && (a.tag == maker_note_tag ? a.bytes.size() == b.bytes.size() : a.bytes == b.bytes);
}

void check_fields(const Exif &given, const Exif &again) {
    for (size_t i = 0; i < exif_groups; i++) {
        const auto before = kept_fields(given.fields[i]), after = kept_fields(again.fields[i]);
        demand(std::equal(before.begin(), before.end(), after.begin(), after.end(), are_same),
               "EXIF does not read back the same");
    }
}

bool try_exif(const std::vector<uint8_t> &bytes) {
    Exif exif = read_exif(bytes);
    check_fields(exif, read_exif(exif_block(exif)));
    Exif turned = exif;
    set_order(turned, {!exif.order.big});
    check_fields(turned, read_exif(exif_block(turned)));
    return !exif.is_empty();
}

// The first writing drops what XML does not permit, such as &#0;, and joins texts around comments.
bool try_xmp(const std::string &text) {
    const Xmp given(text), once(given.packet());
    Xmp twice(once.packet());
    demand(twice.packet() == once.packet(), "XMP does not read back the same");
    const std::pair<const char *, const char *> known[] = {
        {xmp_names::adobe_lens, "Lens"}, {xmp_names::dublin_core, "creator"}, {xmp_names::exif, "PixelXDimension"}};
    for (const auto &[space, name] : known) {
        demand(once.has(space, name) == given.has(space, name), "a property of XMP is lost");
        demand(once.text(space, name) == twice.text(space, name), "a property of XMP changes");
    }
    twice.remove_if([](const std::string &, const std::string &) { return true; });
    demand(twice.packet().empty(), "a property of XMP cannot be removed");
    return !once.packet().empty();
}

bool try_iptc(const std::vector<uint8_t> &bytes) {
    const std::vector<uint8_t> iptc = codec::iptc_of(bytes);
    demand(codec::iptc_of(codec::with_iptc(bytes, iptc)) == iptc, "IPTC does not read back the same");
    demand(codec::iptc_of(codec::with_iptc(bytes, {})).empty(), "IPTC cannot be removed");
    return !iptc.empty();
}

bool try_bytes(const std::vector<char> &bytes) {
    const std::vector<uint8_t> block(bytes.begin(), bytes.end());
    const bool is_exif = try_exif(block), is_xmp = try_xmp(std::string(bytes.begin(), bytes.end()));
    return try_iptc(block) || is_exif || is_xmp;
}

}  // namespace
