#include "photo/pictures/correction_mark.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <vector>

#include "photo/base/format.hpp"
#include "photo/pictures/codec.hpp"
#include "photo/pictures/xmp_packet.hpp"

namespace lensprof {
namespace {

constexpr char mark_namespace[] = "urn:lensprof:correction:1/", mark_prefix[] = "lensprof";
constexpr const char *falloff_words[] = {"kept", "removed", "added"};

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

std::optional<CorrectionMark> correction_mark_of(const Xmp &xmp) {
    const auto read = [&](const char *name) { return xmp.text(mark_namespace, name); };
    const std::string falloff = read("Falloff");
    for (size_t i = 0; i < std::size(falloff_words); i++) {
        if (falloff != falloff_words[i]) continue;
        CorrectionMark mark;
        mark.falloff = static_cast<CorrectionMark::Falloff>(i);
        mark.linear = read("Encoding") == "linear";
        mark.is_exposure_measured = read("Exposure") == "measured";
        mark.software = read("Software");
        mark.model = read("Model");
        mark.source = read("Source");
        mark.digest = read("SourceDigest");
        return mark;
    }
    return std::nullopt;
}

void set_correction_mark(const CorrectionMark &mark, Xmp &xmp) {
    const auto older = correction_mark_of(xmp);
    const bool keeps = older && mark.falloff == CorrectionMark::Falloff::kept;
    std::vector<std::pair<std::string, std::string>> texts = {
        {"Falloff", falloff_words[static_cast<size_t>(keeps ? older->falloff : mark.falloff)]},
        {"Encoding", mark.linear ? "linear" : ""},
        {"Exposure", mark.is_exposure_measured ? "measured" : ""},
        {"Software", mark.software},
        {"Model", mark.model},
        {"Source", mark.source},
        {"SourceDigest", mark.digest}};
    texts.erase(std::remove_if(texts.begin(), texts.end(), [](const auto &text) { return text.second.empty(); }),
                texts.end());
    xmp.remove_if([](const std::string &space, const std::string &) { return space == mark_namespace; });
    xmp.add(mark_namespace, mark_prefix, texts);
}

}  // namespace lensprof
