// Adobe lens profiles (.lcp) to profiles.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "formats/each_format.h"

#include "falloff/map_fit.hpp"
#include "falloff/refit.hpp"
#include "formats/falloff/falloff_doubt.hpp"
#include "formats/falloff/import.hpp"
#include "formats/falloff/radius.hpp"
#include "formats/lcp.hpp"
#include "formats/text/rdf.hpp"
#include "formats/text/text.hpp"
#include "formats/text/xml.hpp"

namespace lensprof {
namespace {

constexpr size_t kMaxEntries = 20000, kMaxKnots = 1000;
constexpr double kLargestRefit = 0.01;  // relative error of a radial falloff without a grid

// A radius in focal lengths and the attenuation there.
using Knot = std::pair<double, double>;

// A VignetteModel.
struct LcpFalloff {
    std::array<double, 3> alpha{};
    std::vector<Knot> knots;                          // instead of alpha where there are some
    double focal[2] = {0, 0};                         // in longer sides of the frame
    double center[2] = {0.5, 0.5};                    // in 0..1 of the frame
    uint32_t width = kLcpWidth, height = kLcpHeight;  // of the frame, px

    double attenuation(double r) const;
};

double LcpFalloff::attenuation(double r) const {
    if (knots.empty()) return 1.0 + r * r * (alpha[0] + r * r * (alpha[1] + r * r * alpha[2]));
    const auto above =
        std::upper_bound(knots.begin(), knots.end(), r, [](double a, const Knot &b) { return a < b.first; });
    if (above == knots.begin()) return knots.front().second;
    if (above == knots.end()) return knots.back().second;
    const Knot &below = *(above - 1);
    return below.second + (above->second - below.second) * (r - below.first) / (above->first - below.first);
}

// N = 2^(Av / 2), which Adobe writes with six decimals: an N of two decimals that is written so is meant.
double f_number(double av) {
    const double n = std::exp2(av / 2.0), rounded = std::round(n * 100.0) / 100.0;
    const double slack = av == std::round(av * 1e6) / 1e6 ? 1e-6 : 1e-12;
    return rounded > 0.0 && std::fabs(2.0 * std::log2(rounded) - av) <= slack ? rounded : n;
}

class LcpReader {
public:
    LcpReader(std::string_view text, const char *source)
        : xml_(text, {"x:xmpmeta", "rdf:RDF"}), profile_(new lensprof_profile) {
        lensprof_profile_init(profile_.get());
        set_import_provenance(*profile_, source, "Adobe lens profile");
        const pugi::xml_node list = xml_.root().find_node(
            [](const pugi::xml_node &node) { return local_name(node.name()) == "CameraProfiles"; });
        if (!list) fail(xml_.root(), "no photoshop:CameraProfiles; give a lens profile (.lcp)");
        items_ = rdf_items(list);
        if (items_.size() > kMaxEntries) fail(list, "over 20000 entries; split the file", LENSPROF_ERROR_SIZE);
    }

    // Calls use(profile, falloff, remark) for every entry with a falloff until it does not return OK.
    template <typename Use>
    lensprof_status walk(Use use);

private:
    [[noreturn]] void fail(const pugi::xml_node &node, const std::string &text,
                           lensprof_status status = LENSPROF_ERROR_SYNTAX) const {
        fail_at_line(xml_.line_of(node), text, status);
    }

    double read(const RdfResource &from, const char *name, const std::string &text, double low, double high,
                double fallback) const;
    double number(const RdfResource &from, const char *name, double low, double high, double fallback) const {
        return read(from, name, from.text(name), low, high, fallback);
    }
    std::string common(const RdfResource &entry, const char *name);
    double common_number(const RdfResource &entry, const char *name, double high) {
        return read(entry, name, common(entry, name), 0.0, high, 0.0);
    }
    void read_key(const RdfResource &entry);
    LcpFalloff read_falloff(const RdfResource &entry, const RdfResource &model);
    void read_focal(const RdfResource &entry, const RdfResource &model, LcpFalloff &falloff) const;
    std::vector<Knot> read_knots(const RdfResource &model) const;

    XmlText xml_;
    std::unique_ptr<lensprof_profile> profile_;
    std::vector<pugi::xml_node> items_;
    std::map<std::string, std::string, std::less<>> of_first_;  // its texts that were asked for
};

// A number of [low, high], or `fallback` where the property is missing.
double LcpReader::read(const RdfResource &from, const char *name, const std::string &text, double low, double high,
                       double fallback) const {
    if (text.empty()) return fallback;
    double value = 0.0;
    if (!read_number(text, value) || value < low || value > high)
        fail(from.node(), std::string(name) + " is " + in_quotes(text) + ", not a number of " + number_text(low)
                              + " to " + number_text(high) + "; correct it");
    return value;
}

// Values that all entries share may be present only in the first one.
std::string LcpReader::common(const RdfResource &entry, const char *name) {
    const std::string text = entry.text(name);
    if (!text.empty()) return text;
    const auto found = of_first_.find(name);
    if (found != of_first_.end()) return found->second;
    return of_first_[name] = RdfResource(items_.front()).text(name);
}

void LcpReader::read_key(const RdfResource &entry) {
    lensprof_profile_key &key = profile_->key;
    lensprof_profile_key_init(&key);
    const auto put = [&](char *field, size_t capacity, const std::string &text) {
        xml_.check_key_text(entry.node(), "", text, capacity);
        put_text(field, capacity, text);
    };
    put(key.camera_maker, sizeof key.camera_maker, common(entry, "Make"));
    put(key.camera_model, sizeof key.camera_model, common(entry, "Model"));
    const std::string lens = common(entry, "Lens");
    put(key.lens, sizeof key.lens, lens.empty() ? common(entry, "LensPrettyName") : lens);
    const auto known = [](double value) { return value > 0.0 ? value : LENSPROF_UNKNOWN; };
    key.crop_factor = known(common_number(entry, "SensorFormatFactor", 1e4));
    key.focal_mm = known(number(entry, "FocalLength", 0.0, 1e5, 0.0));
    const double distance = number(entry, "FocusDistance", 0.0, 1e300, 0.0);
    key.distance_m = distance >= kLcpFarM ? INFINITY : known(distance);
    const double av = number(entry, "ApertureValue", -10.0, 30.0, -100.0);
    key.aperture = av < -10.0 ? LENSPROF_UNKNOWN : f_number(av);
    const std::string raw = common(entry, "CameraRawProfile");
    key.processing = raw == "True" || raw == "true" ? LENSPROF_PROCESSING_RAW : LENSPROF_PROCESSING_JPEG;
}

void LcpReader::read_focal(const RdfResource &entry, const RdfResource &model, LcpFalloff &falloff) const {
    const lensprof_profile_key &key = profile_->key;
    double &x = falloff.focal[0], &y = falloff.focal[1];
    x = number(model, "FocalLengthX", 0.0, 1e3, 0.0);
    if (!(x > 0.0)) {
        if (key.focal_mm == LENSPROF_UNKNOWN || key.crop_factor == LENSPROF_UNKNOWN)
            fail(entry.node(),
                 "a VignetteModel without FocalLengthX, and without FocalLength and SensorFormatFactor to derive "
                 "it from; add one of them");
        x = key.focal_mm * key.crop_factor / 35.0;
    }
    y = number(model, "FocalLengthY", 0.0, 1e3, 0.0);
    if (!(y > 0.0)) y = x;
}

// "r, attenuation", r rising.
std::vector<Knot> LcpReader::read_knots(const RdfResource &model) const {
    std::vector<Knot> knots;
    for (const std::string &item : model.items("VignetteModelPiecewiseParam")) {
        const size_t comma = std::min(item.find(','), item.size());
        double r = 0.0, value = 0.0;
        if (!read_number(one_line(item.substr(0, comma)), r)
            || !read_number(one_line(item.substr(std::min(comma + 1, item.size()))), value))
            fail(model.node(), "VignetteModelPiecewiseParam has " + in_quotes(item) + ", not two numbers; correct it");
        if (r < 0.0 || (!knots.empty() && !(r > knots.back().first)))
            fail(model.node(), "VignetteModelPiecewiseParam: the radius of " + in_quotes(item)
                                   + " is not above the one before; sort them");
        if (knots.size() == kMaxKnots)
            fail(model.node(), "VignetteModelPiecewiseParam: over 1000 knots; leave some out", LENSPROF_ERROR_SIZE);
        knots.emplace_back(r, value);
    }
    return knots;
}

LcpFalloff LcpReader::read_falloff(const RdfResource &entry, const RdfResource &model) {
    LcpFalloff falloff;
    const double width = common_number(entry, "ImageWidth", 1e6), height = common_number(entry, "ImageLength", 1e6);
    if (width >= 1.0 && height >= 1.0)
        falloff.width = static_cast<uint32_t>(width), falloff.height = static_cast<uint32_t>(height);
    read_focal(entry, model, falloff);
    falloff.center[0] = number(model, "ImageXCenter", -10.0, 10.0, 0.5);
    falloff.center[1] = number(model, "ImageYCenter", -10.0, 10.0, 0.5);
    const char *const names[3] = {"VignetteModelParam1", "VignetteModelParam2", "VignetteModelParam3"};
    for (int n = 0; n < 3; n++) falloff.alpha[n] = number(model, names[n], -1e300, 1e300, 0.0);
    falloff.knots = read_knots(model);
    return falloff;
}

template <typename Use>
lensprof_status LcpReader::walk(Use use) {
    for (const pugi::xml_node &item : items_) {
        const RdfResource entry(item);
        RdfResource model = entry.resource("PerspectiveModel");
        if (!model) model = entry.resource("FisheyeModel");
        const RdfResource vignette = model.resource("VignetteModel");
        if (!vignette
            || (vignette.text("VignetteModelParam1").empty() && vignette.items("VignetteModelPiecewiseParam").empty()))
            continue;
        read_key(entry);
        const LcpFalloff falloff = read_falloff(entry, vignette);
        const lensprof_status status = use(*profile_, falloff);
        if (status != LENSPROF_OK) return status;
    }
    return LENSPROF_OK;
}

// A falloff that M does not hold, because it has other knots or elliptical contours, as a map of the frame: M and a
// gain grid. Returns the largest relative error.
double fit_places(const LcpFalloff &falloff, lensprof_profile &profile) {
    const uint32_t longer = std::max(falloff.width, falloff.height);
    const auto attenuation = [&](double column, double row, uint32_t) {
        const double x = (column + 0.5 - falloff.center[0] * falloff.width) / falloff.focal[0];
        const double y = (row + 0.5 - falloff.center[1] * falloff.height) / falloff.focal[1];
        const double value = falloff.attenuation(std::hypot(x, y) / longer);
        if (!(value >= kLowestFalloff)) throw FormatFailure{LENSPROF_ERROR_VIGNETTING, "M falls below 0.001"};
        return value;
    };
    return fit_map(sampled_map(falloff.width, falloff.height, 1, attenuation), profile);
}

// Sets the vignetting; returns the largest relative error.
double set_falloff(const LcpFalloff &falloff, lensprof_profile &profile) {
    profile.vignettings = 1;
    lensprof_gain_grid_init(&profile.grid);
    if (falloff.focal[0] != falloff.focal[1]) return fit_places(falloff, profile);
    const double sides[2] = {double(falloff.width), double(falloff.height)};
    const double rho = lensprof_half_diagonal(falloff.width, falloff.height);
    const double unit = falloff.focal[0] * std::max(sides[0], sides[1]) / rho;  // half diagonals
    lensprof_vignetting &v = profile.vignetting[0];
    for (int axis = 0; axis < 2; axis++) v.center[axis] = (falloff.center[axis] - 0.5) * sides[axis] / rho;
    RadialRefit refit{in_half_diagonals(falloff.alpha, unit), 0.0};
    if (!falloff.knots.empty())
        refit = refit_radial([&](double r2) { return falloff.attenuation(std::sqrt(r2) / unit); },
                             farthest_corner(v.center, falloff.width, falloff.height));
    if (refit.worst > kLargestRefit) return fit_places(falloff, profile);
    std::copy(refit.k.begin(), refit.k.end(), v.k);
    return refit.worst;
}

lensprof_status visit_falloff(lensprof_profile &profile, const LcpFalloff &falloff, lensprof_import_visitor visit,
                              void *user) {
    std::string remark;
    try {
        remark = refit_remark(set_falloff(falloff, profile));
    } catch (const FormatFailure &failure) {  // what no falloff comes near
        profile.vignettings = 1;
        lensprof_gain_grid_init(&profile.grid);
        profile.vignetting[0] = {{NAN, NAN, NAN}, {0.0, 0.0}};
        put_text(profile.provenance.doubt, sizeof profile.provenance.doubt, failure.text);
        const lensprof_import_entry entry = {&profile, 0, 0, 0.0};
        return visit(user, &entry);
    }
    return visit_entry(profile, remark, visit, user);
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_lcp_read(const void *data, size_t size, const char *source, lensprof_import_visitor visit,
                            void *user, lensprof_error *error) {
    if ((!data && size) || !visit) {
        set_error(error, "lensprof_import: data or visit is NULL; pass a buffer and a function");
        return LENSPROF_ERROR_ARGUMENT;
    }
    lensprof_status visited = LENSPROF_OK;
    const lensprof_status status = at_boundary(error, [&] {
        LcpReader reader(view_of(data, size), source);
        reader.walk(
            [](lensprof_profile &, const LcpFalloff &) { return LENSPROF_OK; });  // all entries are checked first
        visited = reader.walk([&](lensprof_profile &profile, const LcpFalloff &falloff) {
            return visit_falloff(profile, falloff, visit, user);
        });
    });
    return status == LENSPROF_OK ? visited : status;
}
