// Profiles to an Adobe lens profile (.lcp).
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <tuple>

#include "formats/each_format.h"

#include "falloff/refit.hpp"
#include "formats/falloff/export.hpp"
#include "formats/falloff/radius.hpp"
#include "formats/lcp.hpp"
#include "formats/text/text.hpp"
#include "formats/text/xml.hpp"

namespace lensprof {
namespace {

struct FrameSize {
    uint32_t width, height;
    bool known;
};

class LcpWriter {
public:
    explicit LcpWriter(FrameSize frame) : frame_(frame) {
        append_remark(document_, std::string(" written by lensprof ") + lensprof_version() + " ");
        pugi::xml_node meta = append_element(document_, "x:xmpmeta");
        append_attribute(meta, "xmlns:x", "adobe:ns:meta/");
        pugi::xml_node rdf = append_element(meta, "rdf:RDF");
        append_attribute(rdf, "xmlns:rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#");
        pugi::xml_node description = append_element(rdf, "rdf:Description");
        append_attribute(description, "rdf:about", "");
        append_attribute(description, "xmlns:photoshop", "http://ns.adobe.com/photoshop/1.0/");
        append_attribute(description, "xmlns:stCamera", "http://ns.adobe.com/photoshop/1.0/camera-profile");
        list_ = append_element(append_element(description, "photoshop:CameraProfiles"), "rdf:Seq");
    }

    void append(const lensprof_profile &profile, uint32_t index);

    std::string text() const { return document_text(document_); }

private:
    using Setting = std::tuple<double, double, double>;  // focal length, aperture, distance

    void check_key(const lensprof_profile &profile, uint32_t index);
    void append_key(pugi::xml_node entry, const lensprof_profile_key &key);

    FrameSize frame_;
    pugi::xml_document document_;
    pugi::xml_node list_;
    lensprof_profile_key first_{};
    std::set<Setting> settings_;
};

pugi::xml_node append_resource(pugi::xml_node parent, const char *name) {
    pugi::xml_node node = append_element(parent, name);
    append_attribute(node, "rdf:parseType", "Resource");
    return node;
}

void append_value(pugi::xml_node parent, const char *name, double value) {
    append_text(parent, name, number_text(value));
}

void LcpWriter::check_key(const lensprof_profile &profile, uint32_t index) {
    check_exported(profile, index, "a lens profile");
    check_no_grid(profile, index, "a lens profile");
    const lensprof_profile_key &key = profile.key;
    for (const char *text : {key.camera_maker, key.camera_model})
        demand_of_profile(find_not_utf8(text) == std::strlen(text), index,
                          "its camera " + in_quotes(text) + " is not UTF-8; correct the key");
    if (list_.first_child()) {
        const bool same = !std::strcmp(key.camera_maker, first_.camera_maker)
                          && !std::strcmp(key.camera_model, first_.camera_model) && !std::strcmp(key.lens, first_.lens)
                          && key.crop_factor == first_.crop_factor && key.processing == first_.processing;
        demand_of_profile(same, index,
                          "differs from profile 0 in camera, lens, crop factor or processing, but a "
                          "lens profile holds only one; write a file for each");
    } else {
        first_ = key;
    }
    demand_of_profile(settings_.insert({key.focal_mm, key.aperture, key.distance_m}).second, index,
                      "same setting as an earlier profile; leave one out");
}

void LcpWriter::append_key(pugi::xml_node entry, const lensprof_profile_key &key) {
    append_text(entry, "stCamera:Author", std::string("lensprof ") + lensprof_version());
    const std::string camera = key.camera_model[0] ? std::string(key.camera_model) + ", " : "";
    append_text(entry, "stCamera:ProfileName", camera + key.lens);
    if (key.camera_maker[0]) append_text(entry, "stCamera:Make", key.camera_maker);
    if (key.camera_model[0]) {
        append_text(entry, "stCamera:Model", key.camera_model);
        append_text(entry, "stCamera:UniqueCameraModel", key.camera_model);
        append_text(entry, "stCamera:CameraPrettyName", key.camera_model);
    }
    append_text(entry, "stCamera:CameraRawProfile", key.processing == LENSPROF_PROCESSING_RAW ? "True" : "False");
    append_text(entry, "stCamera:Lens", key.lens);
    append_text(entry, "stCamera:LensPrettyName", key.lens);
    append_value(entry, "stCamera:SensorFormatFactor", key.crop_factor);
    if (frame_.known) {
        append_value(entry, "stCamera:ImageWidth", frame_.width);
        append_value(entry, "stCamera:ImageLength", frame_.height);
    }
    append_value(entry, "stCamera:FocalLength", key.focal_mm);
    if (key.distance_m != LENSPROF_UNKNOWN)
        append_value(entry, "stCamera:FocusDistance", std::isinf(key.distance_m) ? kLcpInfinityM : key.distance_m);
    append_value(entry, "stCamera:ApertureValue", 2.0 * std::log2(key.aperture));
}

void LcpWriter::append(const lensprof_profile &profile, uint32_t index) {
    check_key(profile, index);
    const lensprof_profile_key &key = profile.key;
    pugi::xml_node entry = append_resource(list_, "rdf:li");
    append_key(entry, key);
    // A focal length in longer sides of the frame, and the radius in it.
    const double sides[2] = {double(frame_.width), double(frame_.height)}, longer = std::max(sides[0], sides[1]);
    const double rho = lensprof_half_diagonal(frame_.width, frame_.height);
    const double unit = key.focal_mm / half_diagonal_mm(key.crop_factor), focal = unit * rho / longer;
    pugi::xml_node model = append_resource(entry, "stCamera:PerspectiveModel");
    append_text(model, "stCamera:Version", "2");
    append_value(model, "stCamera:FocalLengthX", focal);
    append_value(model, "stCamera:FocalLengthY", focal);
    pugi::xml_node vignette = append_resource(model, "stCamera:VignetteModel");
    append_value(vignette, "stCamera:FocalLengthX", focal);
    append_value(vignette, "stCamera:FocalLengthY", focal);
    const double *center = profile.vignetting[0].center;
    append_value(vignette, "stCamera:ImageXCenter", 0.5 + center[0] * rho / sides[0]);
    append_value(vignette, "stCamera:ImageYCenter", 0.5 + center[1] * rho / sides[1]);
    const std::array<double, 3> alpha = in_half_diagonals(mean_curve(profile), 1.0 / unit);
    const char *const names[3] = {"stCamera:VignetteModelParam1", "stCamera:VignetteModelParam2",
                                  "stCamera:VignetteModelParam3"};
    for (int n = 0; n < 3; n++) append_value(vignette, names[n], alpha[n]);
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_lcp_write(const lensprof_profile *const *profiles, uint32_t profile_count, uint32_t width,
                             uint32_t height, void *data, size_t capacity, size_t *count, lensprof_error *error) {
    if ((!profiles && profile_count) || (!data && capacity)) {
        set_error(error, "lensprof_export: profiles or data is NULL; pass a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] {
        const bool known = width && height;
        if (!known && (width || height))
            throw FormatFailure{LENSPROF_ERROR_ARGUMENT,
                                "a frame with only one side; pass width and height, or 0 for 3:2"};
        if (width > 1000000 || height > 1000000)
            throw FormatFailure{LENSPROF_ERROR_SIZE, "a side of over a million pixels; pass the size of the frame"};
        LcpWriter writer({known ? width : kLcpWidth, known ? height : kLcpHeight, known});
        for (uint32_t i = 0; i < profile_count; i++) {
            demand_of_profile(profiles[i] != nullptr, i, "is NULL; pass a profile");
            writer.append(*profiles[i], i);
        }
        return writer.text();
    });
}
