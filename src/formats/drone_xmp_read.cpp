// Falloffs in the XMP packets of drones' cameras to profiles: MicaSense, Parrot, DJI and Sentera.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "falloff/map_fit.hpp"
#include "falloff/refit.hpp"
#include "formats/drone_xmp.hpp"
#include "formats/falloff/falloff_doubt.hpp"
#include "formats/falloff/import.hpp"
#include "formats/falloff/radius.hpp"
#include "formats/text/rdf.hpp"
#include "formats/text/text.hpp"
#include "formats/text/xml.hpp"

namespace lensprof {
namespace {

struct Space {
    std::string_view uri, prefix;  // a part of the one, and what everybody calls it
};

constexpr Space kCamera = {"pix4d.com/camera", "Camera"}, kDji = {"dji.com/drone-dji", "drone-dji"},
                kSentera = {"sentera.com/camera", "Sentera"}, kTiff = {"ns.adobe.com/tiff", "tiff"};
constexpr size_t kMaxTerms = 16;    // of a radial polynomial
constexpr size_t kMaxTerms2d = 64;  // of one in x and y
constexpr double kGridFrom = 0.01;  // relative error of a radial falloff of even powers that a grid is for

struct PixelSize {
    uint32_t width, height;
};

// Properties of one namespace, in all rdf:Description of a packet.
class Packet {
public:
    explicit Packet(const XmlText &xml) : xml_(xml) {
        const pugi::xml_node root = xml.root();
        const pugi::xml_node rdf = local_name(root.name()) == "RDF" ? root : local_child(root, "RDF");
        if (!rdf) fail(root, "no rdf:RDF; give an XMP packet");
        for (pugi::xml_node node : rdf.children())
            if (local_name(node.name()) == "Description") descriptions_.push_back(node);
    }

    [[noreturn]] void fail(const pugi::xml_node &node, const std::string &text,
                           lensprof_status status = LENSPROF_ERROR_SYNTAX) const {
        fail_at_line(xml_.line_of(node), text, status);
    }

    pugi::xml_node first() const { return xml_.root(); }

    // The value, of a list its first item; empty if it is missing.
    std::string text(const Space &space, std::string_view name) const {
        const std::vector<std::string> all = texts(space, name);
        return all.empty() ? std::string() : all.front();
    }

    // Whether there is any property of it.
    bool has(const Space &space) const;

    // A list's numbers, from rdf:li or between commas or blanks. Throws SYNTAX.
    std::vector<double> numbers(const Space &space, std::string_view name, size_t max_count) const;

private:
    std::vector<std::string> texts(const Space &space, std::string_view name) const;

    const XmlText &xml_;
    std::vector<pugi::xml_node> descriptions_;
};

// By the namespace of the prefix; an undeclared prefix by its usual name.
bool in_space(const pugi::xml_node &node, std::string_view name, const Space &space) {
    const std::string_view declared = namespace_of(node, name);
    if (!declared.empty()) return declared.find(space.uri) != std::string_view::npos;
    return name.substr(0, name.find(':')) == space.prefix;
}

bool Packet::has(const Space &space) const {
    for (const pugi::xml_node &description : descriptions_) {
        for (const pugi::xml_attribute &attribute : description.attributes())
            if (in_space(description, attribute.name(), space)) return true;
        for (const pugi::xml_node &child : description.children())
            if (in_space(child, child.name(), space)) return true;
    }
    return false;
}

std::vector<std::string> Packet::texts(const Space &space, std::string_view name) const {
    std::vector<std::string> found;
    for (const pugi::xml_node &description : descriptions_) {
        for (const pugi::xml_attribute &attribute : description.attributes())
            if (local_name(attribute.name()) == name && in_space(description, attribute.name(), space))
                return {one_line(attribute.value())};
        for (const pugi::xml_node &child : description.children()) {
            if (local_name(child.name()) != name || !in_space(child, child.name(), space)) continue;
            for (const pugi::xml_node &item : rdf_items(child)) found.push_back(one_line(item.child_value()));
            if (found.empty()) found.push_back(one_line(child.child_value()));
            return found;
        }
    }
    return found;
}

std::vector<double> Packet::numbers(const Space &space, std::string_view name, size_t max_count) const {
    std::vector<double> values;
    for (const std::string &text : texts(space, name)) {
        std::string_view rest = text;
        while (!rest.empty()) {
            const size_t comma = std::min(rest.find(','), rest.size());
            const std::string part = one_line(rest.substr(0, comma));
            std::string_view words = part;
            do {  // an empty part gives a word that is not a number
                const std::string_view word = next_word(words);
                double value = 0.0;
                if (!read_number(word, value) || std::fabs(value) > 1e100)
                    fail(first(), std::string(name) + " has " + in_quotes(word) + ", not a number; correct it");
                if (values.size() == max_count)
                    fail(first(),
                         std::string(name) + " has over " + std::to_string(max_count)
                             + " numbers; give the packet as written by the camera",
                         LENSPROF_ERROR_SIZE);
                values.push_back(value);
            } while (!words.empty());
            rest.remove_prefix(std::min(comma + 1, rest.size()));
        }
    }
    return values;
}

// 1 + c0 r + c1 r^2 + ..., r in px from the centre; a gain, or an attenuation.
struct RadialPolynomial {
    std::vector<double> terms;
    double center[2];  // px, pixel centres at integers
    bool gain;

    double attenuation(double r) const {
        double sum = 0.0;
        for (size_t n = terms.size(); n-- > 0;) sum = (sum + terms[n]) * r;
        const double value = 1.0 + sum;
        if (!(value > 0.0)) throw FormatFailure{LENSPROF_ERROR_VIGNETTING, "its polynomial is not above 0; correct it"};
        return gain ? 1.0 / value : value;
    }
};

// An attenuation, to any scale, over the frame.
double fit_frame(const std::function<double(double x, double y)> &attenuation, PixelSize frame,
                 lensprof_profile &profile) {
    const auto checked = [&](double x, double y, uint32_t) {
        const double value = attenuation(x, y);
        if (!(value >= kLowestFalloff) || !std::isfinite(value))
            throw FormatFailure{LENSPROF_ERROR_VIGNETTING, "its polynomial is not above 0; correct it"};
        return value;
    };
    return fit_map(sampled_map(frame.width, frame.height, 1, checked), profile);
}

// Odd powers of r have a tip in the centre, which even ones have not: where these come no nearer than 1 %, there is a
// gain grid as well.
double fit_radial(const RadialPolynomial &polynomial, PixelSize frame, lensprof_profile &profile) {
    const double sides[2] = {double(frame.width), double(frame.height)};
    const double rho = lensprof_half_diagonal(frame.width, frame.height);
    lensprof_vignetting &v = profile.vignetting[0];
    for (int axis = 0; axis < 2; axis++) v.center[axis] = (polynomial.center[axis] - (sides[axis] - 1.0) / 2.0) / rho;
    const RadialRefit refit = refit_radial([&](double r2) { return polynomial.attenuation(std::sqrt(r2) * rho); },
                                           farthest_corner(v.center, frame.width, frame.height));
    std::copy(refit.k.begin(), refit.k.end(), v.k);
    if (!(refit.worst > kGridFrom)) return refit.worst;
    return fit_frame(
        [&](double x, double y) {
            return polynomial.attenuation(std::hypot(x - polynomial.center[0], y - polynomial.center[1]));
        },
        frame, profile);
}

// sum c x^i y^j, x and y the pixel's column and row over the frame's sides.
double fit_2d(const std::vector<double> &powers, const std::vector<double> &terms, PixelSize frame,
              lensprof_profile &profile) {
    return fit_frame(
        [&](double column, double row) {
            const double x = std::max(column, 0.0) / frame.width, y = std::max(row, 0.0) / frame.height;
            double value = 0.0;
            for (size_t n = 0; n < terms.size(); n++)
                value += terms[n] * std::pow(x, powers[2 * n]) * std::pow(y, powers[2 * n + 1]);
            return value;
        },
        frame, profile);
}

// A polynomial with its centre, as one of the makers writes them.
struct Written {
    std::vector<double> terms;  // of r, r^2 and so on
    std::vector<double> center;
    const char *center_name;
};

class DroneXmpReader {
public:
    // `maker`: used if the packet does not contain it.
    DroneXmpReader(std::string_view text, PixelSize frame, std::string_view maker)
        : xml_(text, {"x:xmpmeta", "x:xapmeta", "rdf:RDF"}), packet_(xml_), frame_(frame), maker_(maker) {}

    // Fills the profile; returns the text for its doubt.
    std::string read(const char *source, lensprof_profile &profile) const;

private:
    // The centre as written; of a frame without one its middle.
    std::array<double, 2> center(const std::vector<double> &given, const char *name) const;
    bool is_of_dji() const;
    bool is_of_sentera() const;
    Written read_radial() const;
    double read_2d(lensprof_profile &profile) const;
    void read_key(const char *maker, lensprof_profile_key &key) const;

    XmlText xml_;
    Packet packet_;
    PixelSize frame_;
    std::string_view maker_;
};

bool DroneXmpReader::is_of_dji() const {
    return packet_.text(kTiff, "Make") == "DJI" || !packet_.text(kDji, "VignettingData").empty()
           || !packet_.text(kDji, "Version").empty();
}

bool DroneXmpReader::is_of_sentera() const {
    const std::string make = packet_.text(kTiff, "Make");
    const std::string_view known = make.empty() ? maker_ : std::string_view(make);
    return known.substr(0, kSentera.prefix.size()) == kSentera.prefix || packet_.has(kSentera);
}

// Properties under the maker's own name come first; no terms if nothing is found.
Written DroneXmpReader::read_radial() const {
    Written written{packet_.numbers(kDji, "VignettingData", kMaxTerms),
                    packet_.numbers(kDji, "CalibratedOpticalCenterX", 1), "CalibratedOpticalCenter"};
    const std::vector<double> below = packet_.numbers(kDji, "CalibratedOpticalCenterY", 1);
    written.center.insert(written.center.end(), below.begin(), below.end());
    if (!written.terms.empty()) return written;
    for (const Space &space : {kSentera, kCamera}) {
        Written found{packet_.numbers(space, "VignettingPolynomial", kMaxTerms),
                      packet_.numbers(space, "VignettingCenter", 2), "VignettingCenter"};
        if (is_of_sentera()) std::reverse(found.terms.begin(), found.terms.end());  // the highest power comes first
        if (!found.terms.empty()) return found;
    }
    return {};
}

std::array<double, 2> DroneXmpReader::center(const std::vector<double> &given, const char *name) const {
    if (given.empty()) return {(frame_.width - 1.0) / 2.0, (frame_.height - 1.0) / 2.0};
    if (given.size() != 2) packet_.fail(packet_.first(), std::string(name) + " does not have two numbers; correct it");
    if (!(given[0] >= 0.0 && given[0] <= frame_.width && given[1] >= 0.0 && given[1] <= frame_.height))
        packet_.fail(packet_.first(), std::string(name) + " is outside a frame of " + std::to_string(frame_.width)
                                          + " x " + std::to_string(frame_.height)
                                          + " px; pass the size of this picture");
    return {given[0], given[1]};
}

double DroneXmpReader::read_2d(lensprof_profile &profile) const {
    const std::vector<double> powers = packet_.numbers(kCamera, "VignettingPolynomial2DName", 2 * kMaxTerms2d),
                              terms = packet_.numbers(kCamera, "VignettingPolynomial2D", kMaxTerms2d);
    if (powers.size() != 2 * terms.size())
        packet_.fail(packet_.first(),
                     "VignettingPolynomial2DName does not have two powers for each number of "
                     "VignettingPolynomial2D; correct it");
    for (double power : powers)
        if (power != std::floor(power) || power < 0.0 || power > 20.0)
            packet_.fail(packet_.first(), "VignettingPolynomial2DName has " + number_text(power)
                                              + ", not an integer power of 0 to 20; correct it");
    return fit_2d(powers, terms, frame_, profile);
}

void DroneXmpReader::read_key(const char *maker, lensprof_profile_key &key) const {
    key.processing = LENSPROF_PROCESSING_RAW;
    const std::string make = packet_.text(kTiff, "Make"), model = packet_.text(kTiff, "Model");
    const std::string shown = make.empty() ? maker : make;
    xml_.check_key_text(packet_.first(), "tiff:Make: ", shown, sizeof key.camera_maker);
    xml_.check_key_text(packet_.first(), "tiff:Model: ", model, sizeof key.camera_model);
    put_text(key.camera_maker, sizeof key.camera_maker, shown);
    put_text(key.camera_model, sizeof key.camera_model, model);
}

std::string DroneXmpReader::read(const char *source, lensprof_profile &profile) const {
    const Written radial = read_radial();
    const bool dji = is_of_dji();
    read_key(dji ? "DJI" : is_of_sentera() ? "Sentera" : "", profile.key);
    set_import_provenance(profile, source, dji ? "XMP of DJI" : "XMP of a camera");
    double worst = 0.0;
    if (!radial.terms.empty()) {
        const std::array<double, 2> c = center(radial.center, radial.center_name);
        worst = fit_radial({radial.terms, {c[0], c[1]}, dji}, frame_, profile);
    } else if (!packet_.numbers(kCamera, "VignettingPolynomial2D", kMaxTerms2d).empty()) {
        worst = read_2d(profile);
    } else {
        throw FormatFailure{
            LENSPROF_ERROR_NOT_FOUND,
            "no VignettingPolynomial or VignettingPolynomial2D of Camera or Sentera, and no drone-dji:VignettingData; "
            "give the XMP of a picture that contains one"};
    }
    if (dji && packet_.text(kDji, "VignettingFlag") == "1")
        return "VignettingFlag: the camera corrected this picture itself";
    return refit_remark(worst);
}

}  // namespace

lensprof_status read_drone_packet(const DronePacket &in, lensprof_import_visitor visit, void *user,
                                  lensprof_error *error) {
    lensprof_status visited = LENSPROF_OK;
    const lensprof_status status = at_boundary(error, [&] {
        const auto profile = std::make_unique<lensprof_profile>();
        lensprof_profile_init(profile.get());
        std::string_view packet = view_of(in.data, in.size);
        while (!packet.empty() && packet.back() == '\0') packet.remove_suffix(1);  // padding of the tag
        const DroneXmpReader reader(packet, {in.width, in.height}, in.maker ? in.maker : "");
        const std::string remark = reader.read(in.source, *profile);
        visited = visit_entry(*profile, remark, visit, user);
    });
    return status == LENSPROF_OK ? visited : status;
}

}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_drone_xmp_read(const void *data, size_t size, uint32_t width, uint32_t height, const char *source,
                                  lensprof_import_visitor visit, void *user, lensprof_error *error) {
    if ((!data && size) || !visit || !width || !height) {
        set_error(error,
                  "lensprof_import: data or visit is NULL, or a side is 0; pass a packet, its picture's size "
                  "and a function");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return read_drone_packet({data, size, width, height, source, nullptr}, visit, user, error);
}
