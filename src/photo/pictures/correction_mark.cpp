#include "photo/pictures/correction_mark.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <vector>

#include <exiv2/exiv2.hpp>

#include "photo/base/format.hpp"
#include "photo/pictures/codec.hpp"

namespace lensprof {
namespace {

constexpr char uri[] = "urn:lensprof:correction:1/", prefix[] = "lensprof";
constexpr const char *falloff_words[] = {"kept", "removed", "added"};

std::string read_property(const Exiv2::XmpData &xmp, const char *name) {
    const auto datum = xmp.findKey(Exiv2::XmpKey(std::string("Xmp.") + prefix + "." + name));
    return datum == xmp.end() ? std::string() : datum->toString();
}

void set_property(const char *name, const std::string &value, Exiv2::XmpData &xmp) {
    const Exiv2::XmpKey key(std::string("Xmp.") + prefix + "." + name);
    const auto old = xmp.findKey(key);
    if (old != xmp.end()) xmp.erase(old);
    if (!value.empty()) xmp[key.key()] = value;
}

void add_bytes(const std::vector<uint8_t> &bytes, uint64_t &hash) {
    for (const uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
}

}  // namespace

std::string digest_of(const std::string &path) {
    constexpr uint64_t end_bytes = 64 * 1024;
    const codec::File file = codec::open_for_reading(path);
    const uint64_t size = codec::file_bytes(file.get());
    uint64_t hash = 0xcbf29ce484222325;
    std::vector<uint8_t> bytes(8);
    for (size_t i = 0; i < 8; i++) bytes[i] = static_cast<uint8_t>(size >> (8 * i));
    add_bytes(bytes, hash);
    for (const uint64_t start : {uint64_t(0), size > 2 * end_bytes ? size - end_bytes : end_bytes}) {
        if (start >= size) continue;
        bytes.resize(static_cast<size_t>(std::min(end_bytes, size - start)));
        if (std::fseek(file.get(), static_cast<long>(start), SEEK_SET) != 0
            || std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
            codec::fail_damaged(path, "file is truncated");
        add_bytes(bytes, hash);
    }
    return format("%016llx", static_cast<unsigned long long>(hash));
}

void register_correction_mark() { Exiv2::XmpProperties::registerNs(uri, prefix); }

std::optional<CorrectionMark> correction_mark_of(const Exiv2::XmpData &xmp) {
    const std::string falloff = read_property(xmp, "Falloff");
    for (size_t i = 0; i < std::size(falloff_words); i++) {
        if (falloff != falloff_words[i]) continue;
        CorrectionMark mark;
        mark.falloff = static_cast<CorrectionMark::Falloff>(i);
        mark.linear = read_property(xmp, "Encoding") == "linear";
        mark.is_exposure_measured = read_property(xmp, "Exposure") == "measured";
        mark.software = read_property(xmp, "Software");
        mark.model = read_property(xmp, "Model");
        mark.source = read_property(xmp, "Source");
        mark.digest = read_property(xmp, "SourceDigest");
        return mark;
    }
    return std::nullopt;
}

void set_correction_mark(const CorrectionMark &mark, Exiv2::XmpData &xmp) {
    const auto older = correction_mark_of(xmp);
    const bool keeps = older && mark.falloff == CorrectionMark::Falloff::kept;
    set_property("Falloff", falloff_words[static_cast<size_t>(keeps ? older->falloff : mark.falloff)], xmp);
    set_property("Encoding", mark.linear ? "linear" : "", xmp);
    set_property("Exposure", mark.is_exposure_measured ? "measured" : "", xmp);
    set_property("Software", mark.software, xmp);
    set_property("Model", mark.model, xmp);
    set_property("Source", mark.source, xmp);
    set_property("SourceDigest", mark.digest, xmp);
}

}  // namespace lensprof
