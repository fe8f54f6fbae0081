#include "photo/pictures/part_tags.hpp"

#include <algorithm>
#include <iterator>

namespace lensprof {

namespace codec {

namespace {

template <size_t count>
bool is_one_of(const std::string &text, const char *const (&all)[count]) {
    return std::find(std::begin(all), std::end(all), text) != std::end(all);
}

}  // namespace

void remove_part_tags(Xmp &xmp) {
    static const char *const namespaces[] = {
        "http://ns.google.com/photos/1.0/container/", "http://ns.google.com/photos/dd/1.0/device/",
        "http://ns.adobe.com/hdr-gain-map/1.0/", "http://ns.apple.com/HDRGainMap/1.0/",
        "http://ns.apple.com/pixeldatainfo/1.0/"};
    xmp.remove_if([](const std::string &space, const std::string &name) {
        return is_one_of(space, namespaces) || name.rfind("MotionPhoto", 0) == 0 || name.rfind("MicroVideo", 0) == 0;
    });
}

void remove_extended_tags(Xmp &xmp) {
    static const char *const namespaces[] = {"http://ns.google.com/photos/1.0/depthmap/",
                                             "http://ns.google.com/photos/1.0/image/",
                                             "http://ns.google.com/photos/1.0/audio/"};
    if (!xmp.has(xmp_names::extension, "HasExtendedXMP")) return;
    xmp.remove_if([](const std::string &space, const std::string &) { return is_one_of(space, namespaces); });
}

}  // namespace codec

}  // namespace lensprof
