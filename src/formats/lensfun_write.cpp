// Profiles to a Lensfun database: a new one, or added to the text of one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "formats/each_format.h"

#include "core/profile.h"
#include "falloff/refit.hpp"
#include "formats/falloff/export.hpp"
#include "formats/lensfun.hpp"
#include "formats/lensfun_names.hpp"
#include "formats/text/text.hpp"
#include "formats/text/xml.hpp"

namespace lensprof {
namespace {

constexpr double kNearM = 10.0;           // the other distance of Lensfun's entries for infinity
constexpr double kSameCropFactor = 0.02;  // relative: a profile of the whole sensor of the camera
constexpr uint32_t kSide = 96;            // samples of the longer side of the frame

using Setting = std::tuple<double, double, double>;  // focal length, aperture, distance
using Curve = std::array<double, 3>;

struct LensEntries {
    LensfunName name;
    std::string mount, crop_factor, profile_name;
    std::map<Setting, Curve> measured, far;  // far: at the distances that represent infinity
};

// ---- What Lensfun can hold of a falloff ----

struct Frame {
    uint32_t width, height;
};

Frame frame_of(const lensprof_export_options *o) {
    if (!o || !o->width || !o->height) return {kSide, kSide * 2 / 3};
    const double longer = std::max(o->width, o->height);
    const auto side = [&](uint32_t px) {
        return std::max(2u, static_cast<uint32_t>(std::lround(kSide * px / longer)));
    };
    return {side(o->width), side(o->height)};
}

double mean_falloff(const lensprof_profile &profile, Frame frame, double x, double y) {
    double sum = 0.0;
    for (uint32_t c = 0; c < 3; c++)
        sum += lensprof_profile_falloff(&profile, c, frame.width, frame.height, x, y, nullptr);
    return sum / 3.0;
}

bool is_written_as_is(const lensprof_profile &profile) {
    const double *center = profile.vignetting[0].center;
    return profile.grid.columns == 0 && center[0] == 0.0 && center[1] == 0.0;
}

// The falloff inside of the image circle, about the middle of the frame.
std::vector<FrameSample> samples_of(const lensprof_profile &profile, Frame frame) {
    const lensprof_vignetting about_middle = {{0, 0, 0}, {0, 0}};
    const lensprof_image_circle circle = lp_profile_circle(&profile);
    std::vector<FrameSample> samples;
    for (uint32_t y = 0; y < frame.height; y++)
        for (uint32_t x = 0; x < frame.width; x++)
            if (lensprof_image_circle_contains(&circle, frame.width, frame.height, x, y))
                samples.push_back({lensprof_vignetting_r2(&about_middle, frame.width, frame.height, x, y, nullptr),
                                   mean_falloff(profile, frame, x, y)});
    return samples;
}

// Relative errors of a curve that is right in the middle of the frame; nothing where it falls to 0.
std::vector<double> errors_of(const Curve &k, const std::vector<FrameSample> &samples) {
    std::vector<double> errors;
    double nearest = INFINITY, middle = 0.0;
    for (const FrameSample &at : samples) {
        const double m = 1.0 + at.r2 * (k[0] + at.r2 * (k[1] + at.r2 * k[2]));
        if (!(m > 0.0)) return {};
        errors.push_back(std::log(m / at.attenuation));
        if (at.r2 < nearest) nearest = at.r2, middle = errors.back();
    }
    for (double &error : errors) error = std::fabs(error - middle);
    return errors;
}

double worst_of(const std::vector<double> &errors) {
    return errors.empty() ? INFINITY : *std::max_element(errors.begin(), errors.end());
}

bool is_valid(const Curve &k) {
    const lensprof_vignetting curve = {{k[0], k[1], k[2]}, {0, 0}};
    return lensprof_vignetting_validate(&curve) == LENSPROF_OK;
}

// That with the least largest error over the frame: of the profile's own curve and of those fitted to the falloff with
// its grid and centre, by least squares whose weights follow the errors (Lawson 1961), as plain ones leave the corners
// of a deep falloff. Takes fewer powers where a curve would fall to 0.
Curve best_about_middle(const lensprof_profile &profile, Frame frame) {
    constexpr int kRounds = 20;
    Curve best = mean_curve(profile);
    std::vector<FrameSample> samples = samples_of(profile, frame);
    double least = worst_of(errors_of(best, samples));
    for (int count = 3; count > 0; count--) {
        for (FrameSample &at : samples) at.weight = 1.0;
        for (int round = 0; round < kRounds; round++) {
            const Curve k = refit_samples(samples, count);
            const std::vector<double> errors = errors_of(k, samples);
            const double worst = worst_of(errors);
            if (is_valid(k) && worst < least) least = worst, best = k;
            if (!(worst > 0.0) || !std::isfinite(worst)) break;
            for (size_t i = 0; i < samples.size(); i++) samples[i].weight *= 1e-3 + errors[i] / worst;
        }
    }
    return best;
}

std::string decimals(double value, int count) {
    char text[400];
    std::snprintf(text, sizeof text, "%.*f", count, value);
    for (char *c = text; *c; c++)
        if (*c == ',') *c = '.';  // whatever the process locale
    return text;
}

double to_four_decimals(double k) { return std::round(1e4 * k) / 1e4; }

Curve written_curve(const lensprof_profile &profile, Frame frame) {
    Curve k = is_written_as_is(profile) ? mean_curve(profile) : best_about_middle(profile, frame);
    for (double &term : k) term = to_four_decimals(term) + 0.0;
    return k;
}

// The last place inside of the image circle on the way from the middle of the frame.
std::array<double, 2> last_inside(const lensprof_image_circle &circle, Frame frame, double x, double y) {
    const double middle[2] = {0.5 * (frame.width - 1.0), 0.5 * (frame.height - 1.0)};
    double inside = 0.0, outside = 1.0;
    const auto place = [&](double part) {
        return std::array<double, 2>{middle[0] + part * (x - middle[0]), middle[1] + part * (y - middle[1])};
    };
    const auto contains = [&](double part) {
        return lensprof_image_circle_contains(&circle, frame.width, frame.height, place(part)[0], place(part)[1]) != 0;
    };
    if (contains(1.0)) return place(1.0);
    for (int i = 0; i < 30; i++) (contains(0.5 * (inside + outside)) ? inside : outside) = 0.5 * (inside + outside);
    return place(inside);
}

// In the corners, or where the image circle ends on the way to them.
double cost_of(const lensprof_profile &profile, const Curve &k, Frame frame) {
    const double w = frame.width, h = frame.height;
    const lensprof_vignetting written = {{k[0], k[1], k[2]}, {0, 0}};
    const lensprof_image_circle circle = lp_profile_circle(&profile);
    double cost = 0.0;
    for (uint32_t c = 0; c < 3; c++)
        for (double corner_x : {-0.5, w - 0.5})
            for (double corner_y : {-0.5, h - 0.5}) {
                const auto at = [&](double x, double y) {
                    return lp_profile_continued_falloff(&profile, c, frame.width, frame.height, x, y);
                };
                const auto [x, y] = last_inside(circle, frame, corner_x, corner_y);
                const double r2 = lensprof_vignetting_r2(&written, frame.width, frame.height, x, y, nullptr);
                const double ratio =
                    at(x, y) / at((w - 1) / 2, (h - 1) / 2) / lensprof_vignetting_eval(&written, r2, nullptr);
                cost = std::max(cost, ratio > 0.0 ? std::fabs(std::log2(ratio)) : INFINITY);
            }
    return cost;
}

// ---- Entries ----

LensEntries begin_lens(const lensprof_profile &profile, const lensprof_camera_model *camera) {
    const lensprof_profile_key &key = profile.key;
    const bool is_fixed = camera && camera->fixed_lens && camera->lens[0];
    LensEntries lens;
    lens.profile_name = is_fixed ? camera->lens : key.lens;
    lens.name = lensfun_name(lens.profile_name, camera ? camera->maker : key.camera_maker);
    lens.mount = camera && camera->fixed_lens ? camera->mount : lensfun_mount(lens.name, camera ? camera->mount : "");
    const bool is_camera =
        camera && camera->crop_factor > 0.0 && std::fabs(camera->crop_factor / key.crop_factor - 1.0) < kSameCropFactor;
    lens.crop_factor = number_text(std::round(1e3 * (is_camera ? camera->crop_factor : key.crop_factor)) / 1e3);
    return lens;
}

void add_entry(LensEntries &lens, const lensprof_profile &profile, uint32_t index, const Curve &k) {
    const lensprof_profile_key &key = profile.key;
    const bool is_far = key.distance_m == LENSPROF_UNKNOWN || std::isinf(key.distance_m);
    const auto put = [&](std::map<Setting, Curve> &entries, double distance) {
        return entries.insert({{key.focal_mm, key.aperture, distance}, k}).second;
    };
    const bool is_new = is_far ? put(lens.far, kLensfunInfinityM) : put(lens.measured, key.distance_m);
    demand_of_profile(is_new, index,
                      "lens " + in_quotes(key.lens) + ": same setting as an earlier profile; leave one out");
    if (is_far || key.distance_m >= kNearM) put(lens.far, kNearM), put(lens.far, kLensfunInfinityM);
}

std::map<Setting, Curve> all_entries(const LensEntries &lens) {
    std::map<Setting, Curve> all = lens.measured;
    all.insert(lens.far.begin(), lens.far.end());  // those that were measured there stay
    return all;
}

std::string entry_text(const Setting &setting, const Curve &k) {
    const auto [focal, aperture, distance] = setting;
    return "<vignetting model=\"pa\" focal=\"" + number_text(focal) + "\" aperture=\"" + number_text(aperture)
           + "\" distance=\"" + number_text(distance) + "\" k1=\"" + decimals(k[0], 4) + "\" k2=\"" + decimals(k[1], 4)
           + "\" k3=\"" + decimals(k[2], 4) + "\"/>";
}

std::string escaped(const std::string &text) {
    std::string xml;
    for (char c : text) xml += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return xml;
}

std::string calibration_text(const LensEntries &lens) {
    std::string text = "        <calibration>\n";
    for (const auto &[setting, k] : all_entries(lens)) text += "            " + entry_text(setting, k) + "\n";
    return text + "        </calibration>\n";
}

std::string lens_text(const LensEntries &lens) {
    const auto line = [](const char *name, const std::string &text) {
        return std::string("        <") + name + ">" + escaped(text) + "</" + name + ">\n";
    };
    const bool is_4_3 = lens.mount.find("4/3") != std::string::npos;
    return "    <lens>\n" + line("maker", lens.name.maker) + line("model", lens.name.model) + line("mount", lens.mount)
           + line("cropfactor", lens.crop_factor) + (is_4_3 ? line("aspect-ratio", "4:3") : "") + calibration_text(lens)
           + "    </lens>\n";
}

std::vector<LensEntries> lenses_of(const lensprof_profile *const *profiles, uint32_t count,
                                   const lensprof_export_options *o) {
    std::vector<LensEntries> lenses;
    for (uint32_t i = 0; i < count; i++) {
        demand_of_profile(profiles[i] != nullptr, i, "is NULL; pass a profile");
        const lensprof_profile &profile = *profiles[i];
        check_exported(profile, i, "Lensfun");
        LensEntries lens = begin_lens(profile, o ? o->camera : nullptr);
        auto found = std::find_if(lenses.begin(), lenses.end(), [&](const LensEntries &other) {
            return other.profile_name == lens.profile_name && other.crop_factor == lens.crop_factor;
        });
        if (found == lenses.end()) found = lenses.insert(lenses.end(), lens);
        const Curve k = written_curve(profile, frame_of(o));
        add_entry(*found, profile, i, k);
        if (o && o->cost_ev) o->cost_ev[i] = cost_of(profile, k, frame_of(o));
    }
    return lenses;
}

// ---- Into the text of a database ----

struct Edit {
    size_t begin, length;
    std::string text;
};

class Database {
public:
    explicit Database(std::string_view text) : text_(text), xml_(text, {"lensdatabase"}) {
        check_lensfun_version(xml_);
    }

    void add(LensEntries lens) {
        const pugi::xml_node found = find(lens);
        const pugi::xml_node calibration = found.child("calibration");
        if (found) rescale(crop_factor_of(found), lens);
        if (!found)
            edits_.push_back({line_start(closing("lensdatabase", begin(xml_.root()))), 0, lens_text(lens)});
        else if (!calibration.first_child())
            edits_.push_back({line_start(closing("lens", begin(found))), 0, calibration_text(lens)});
        else
            for (const auto &[setting, k] : all_entries(lens)) add_entry(calibration, setting, entry_text(setting, k));
    }

    std::string text() const {
        std::string all;
        size_t at = 0;
        std::vector<Edit> edits = edits_;
        std::stable_sort(edits.begin(), edits.end(), [](const Edit &a, const Edit &b) { return a.begin < b.begin; });
        for (const Edit &edit : edits) {
            all.append(text_.substr(at, edit.begin - at)).append(edit.text);
            at = edit.begin + edit.length;
        }
        return all.append(text_.substr(at));
    }

private:
    static size_t begin(const pugi::xml_node &node) { return static_cast<size_t>(node.offset_debug()) - 1; }

    // Of the end tag of an element, inside which there is no element of its name; not of one in a comment.
    size_t closing(const std::string &name, size_t from) const {
        for (size_t at = from; (at = text_.find('<', at)) != text_.npos; at++) {
            if (text_.substr(at, 4) == "<!--") at = text_.find("-->", at);
            if (text_.substr(at, name.size() + 2) == "</" + name) return at;
        }
        throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED, "<" + name + "> has no end tag to write before; add it"};
    }

    size_t end(const pugi::xml_node &entry) const {
        const size_t tag = text_.find('>', begin(entry));  // its values are numbers
        return text_[tag - 1] == '/' ? tag + 1 : text_.find('>', closing("vignetting", tag)) + 1;
    }

    size_t line_start(size_t at) const {
        while (at > 0 && is_blank(text_[at - 1])) at--;
        return at;
    }
    std::string indent(size_t at) const {
        return "\n" + std::string(text_.substr(line_start(at), at - line_start(at)));
    }

    static double crop_factor_of(const pugi::xml_node &lens) {
        double crop = 0.0;
        return read_number(lensfun_text(lens, "cropfactor"), crop) ? crop : 0.0;
    }

    // To radii in half diagonals of the sensor that the entry has.
    static void rescale(double crop_factor, LensEntries &lens) {
        double own = 0.0;
        if (!read_number(lens.crop_factor, own)) return;
        for (auto *entries : {&lens.measured, &lens.far})
            for (auto &[setting, k] : *entries)
                for (int n = 0; n < 3; n++) k[n] *= std::pow(own / crop_factor, 2 * (n + 1));
    }

    // The same lens, for sensors of the same size within the rounding of crop factors.
    pugi::xml_node find(const LensEntries &lens) const {
        const std::string name = lens.name.maker + " " + lens.name.model;
        for (pugi::xml_node node : xml_.root().children("lens")) {
            const std::string model = lensfun_text(node, "model"), full = lensfun_lens_name(node);
            bool is_same = false;
            for (const std::string &ours : {name, lens.name.model, lens.profile_name})
                for (const std::string &theirs : {model, full})
                    is_same = is_same || comparable_name(ours) == comparable_name(theirs);
            double wanted = 0.0;
            const bool has_crop = read_number(lens.crop_factor, wanted)
                                  && std::fabs(crop_factor_of(node) / wanted - 1.0) < kSameCropFactor;
            bool has_mount = false;
            for (pugi::xml_node mount : node.children("mount"))
                has_mount |= one_line(mount.child_value()) == lens.mount;
            if (is_same && has_mount && has_crop && !node.child("center")) return node;
        }
        return {};
    }

    static std::optional<Setting> setting_of(const pugi::xml_node &entry) {
        double value[3];
        const char *const names[3] = {"focal", "aperture", "distance"};
        for (int n = 0; n < 3; n++)
            if (!read_number(one_line(entry.attribute(names[n]).value()), value[n])) return std::nullopt;
        return Setting{value[0], value[1], value[2]};
    }

    void add_entry(const pugi::xml_node &calibration, const Setting &setting, const std::string &entry) {
        pugi::xml_node last;
        for (pugi::xml_node node : calibration.children("vignetting")) {
            const std::optional<Setting> other = setting_of(node);
            if (other == setting) {
                edits_.push_back({begin(node), end(node) - begin(node), entry});
                return;
            }
            if (!last && other && *other > setting) {
                edits_.push_back({begin(node), 0, entry + indent(begin(node))});
                return;
            }
            if (other && *other < setting) last = node;
        }
        if (last) {
            edits_.push_back({end(last), 0, indent(begin(last)) + entry});
            return;
        }
        const size_t close = closing("calibration", begin(calibration));
        edits_.push_back({line_start(close), 0, "            " + entry + "\n"});
    }

    std::string_view text_;
    XmlText xml_;
    std::vector<Edit> edits_;
};

std::string database_text(const lensprof_profile *const *profiles, uint32_t count, const lensprof_export_options *o) {
    const std::vector<LensEntries> lenses = lenses_of(profiles, count, o);
    if (o && o->into) {
        Database database(view_of(o->into, o->into_size));
        for (const LensEntries &lens : lenses) database.add(lens);
        return database.text();
    }
    std::string text =
        std::string("<!--") + kLensfunRemark + lensprof_version() + " -->\n<lensdatabase version=\"1\">\n";
    for (const LensEntries &lens : lenses) text += lens_text(lens);
    return text + "</lensdatabase>\n";
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_lensfun_write(const lensprof_profile *const *profiles, uint32_t profile_count,
                                 const lensprof_export_options *options, void *data, size_t capacity, size_t *count,
                                 lensprof_error *error) {
    if ((!profiles && profile_count) || (!data && capacity)) {
        set_error(error, "lensprof_export: profiles or data is NULL; pass a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error,
                             [&] { return database_text(profiles, profile_count, options); });
}
