#include "photo/deflicker/offsets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>

#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/xmp_packet.hpp"
#include "photo/reconstruction/field_reader.hpp"

namespace lensprof {
namespace {

constexpr char kOwn[] = "urn:lensprof:deflicker:1/", kExposure[] = "Exposure2012", kOffset[] = "ExposureOffset";
constexpr char kGroup[] = "[Exposure]", kCompensation[] = "Compensation=", kOwnGroup[] = "[Lensprof]",
               kOwnOffset[] = "ExposureOffset=";
constexpr char offset_header[] =
    "file,seconds,state,segment,ev,ev_sigma,wanted_ev,change_ev,change_red,change_blue,agreeing,clipped\n";

std::optional<double> number_in(const std::string &text) {
    char *end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    while (end && (*end == ' ' || *end == '\r')) end++;
    return end == text.c_str() || *end || !std::isfinite(number) ? std::nullopt : std::optional<double>(number);
}

// A settings file of RawTherapee: groups of KEY=VALUE lines.
class KeyFile {
public:
    explicit KeyFile(const std::string &text) {
        size_t begin = 0;
        while (begin < text.size()) {
            const size_t end = std::min(text.find('\n', begin), text.size());
            lines_.push_back(text.substr(begin, end - begin));
            if (!lines_.back().empty() && lines_.back().back() == '\r') lines_.back().pop_back();
            begin = end + 1;
        }
    }

    std::string value(const std::string &group, const std::string &key) const {
        const size_t line = find(group, key);
        return line < lines_.size() ? lines_[line].substr(key.size()) : "";
    }

    void set(const std::string &group, const std::string &key, const std::string &value) {
        size_t line = find(group, key);
        if (line < lines_.size()) {
            lines_[line] = key + value;
            return;
        }
        auto place = std::find(lines_.begin(), lines_.end(), group);
        if (place == lines_.end()) {
            if (!lines_.empty() && !lines_.back().empty()) lines_.emplace_back();
            place = lines_.insert(lines_.end(), group);
        }
        lines_.insert(place + 1, key + value);
    }

    std::string text() const { return joined(lines_, "\n") + "\n"; }

private:
    size_t find(const std::string &group, const std::string &key) const {
        bool is_inside = false;
        for (size_t n = 0; n < lines_.size(); n++) {
            if (!lines_[n].empty() && lines_[n][0] == '[') is_inside = lines_[n] == group;
            if (is_inside && lines_[n].compare(0, key.size(), key) == 0) return n;
        }
        return lines_.size();
    }

    std::vector<std::string> lines_;
};

// The offset of the user below the one of an earlier run.
double own_value(const std::string &stated, const std::string &added) {
    return number_in(stated).value_or(0.0) - number_in(added).value_or(0.0);
}

std::string ev_text(double ev) { return format("%+.4f", ev + 0.0); }

}  // namespace

std::string offset_file(const std::string &frame, OffsetFormat format, const std::string &folder) {
    std::filesystem::path path(frame);
    if (format == OffsetFormat::xmp)
        path.replace_extension(".xmp");
    else
        path += ".pp3";
    return folder.empty() ? path.string() : (std::filesystem::path(folder) / path.filename()).string();
}

std::string xmp_with_offset(const std::string &existing, double offset_ev, const std::string &file) {
    Xmp xmp(existing);
    if (!existing.empty() && xmp.packet().empty())
        throw Failure(LENSPROF_ERROR_READ, file + ": is not an XMP file; move it away");
    const char *crs = xmp_names::camera_raw;
    const double user = own_value(xmp.text(crs, kExposure), xmp.text(kOwn, kOffset));
    xmp.remove_if([](const std::string &space, const std::string &) { return space == kOwn; });
    if (xmp.has(crs, kExposure))
        xmp.replace(crs, kExposure, ev_text(user + offset_ev));
    else
        xmp.add(crs, "crs", {{kExposure, ev_text(user + offset_ev)}, {"HasSettings", "True"}});
    xmp.add(kOwn, "lensprof", {{kOffset, ev_text(offset_ev)}});
    return xmp.packet();
}

std::string pp3_with_offset(const std::string &existing, double offset_ev, const std::string &file) {
    KeyFile settings(existing);
    if (existing.find('\0') != std::string::npos || (!existing.empty() && existing.find('[') == std::string::npos))
        throw Failure(LENSPROF_ERROR_READ, file + ": is not a settings file of RawTherapee; move it away");
    const double user = own_value(settings.value(kGroup, kCompensation), settings.value(kOwnGroup, kOwnOffset));
    settings.set(kGroup, kCompensation, format("%.4f", user + offset_ev));
    settings.set(kOwnGroup, kOwnOffset, format("%.4f", offset_ev));
    return settings.text();
}

std::vector<std::string> write_offsets(const std::vector<LevelledFrame> &frames, OffsetFormat format,
                                       const std::string &folder) {
    OutputFiles outputs;
    std::vector<std::string> names;
    std::map<std::string, std::string> frame_of;
    for (const LevelledFrame &frame : frames) {
        const std::string name = offset_file(frame.file, format, folder);
        if (const auto [other, is_new] = frame_of.emplace(name, frame.file); !is_new)
            throw Failure(LENSPROF_ERROR_ARGUMENT, other->second + " and " + frame.file + ": would share the settings "
                                                       + name + "; give frames of one kind");
        // A frame that is not levelled keeps its own settings, without an offset of an earlier run.
        if (frame.measured.state != LENSPROF_FRAME_LEVELLED && !path_exists(name)) continue;
        const std::string existing = path_exists(name) ? read_text(name, max_text_bytes) : "";
        outputs.add(name, format == OffsetFormat::xmp ? xmp_with_offset(existing, frame.change_ev(), name)
                                                      : pp3_with_offset(existing, frame.change_ev(), name));
        names.push_back(name);
    }
    outputs.commit();
    return names;
}

const char *state_name(uint32_t state) {
    switch (state) {
    case LENSPROF_FRAME_LEVELLED: return "levelled";
    case LENSPROF_FRAME_DARK: return "dark";
    case LENSPROF_FRAME_WHITE: return "white";
    default: return "disagrees";
    }
}

bool is_offset_table(const std::string &path) {
    return is_regular_file(path) && read_head(path, sizeof offset_header - 1) == offset_header;
}

std::string offset_table(const std::vector<LevelledFrame> &frames) {
    std::string text = offset_header;
    for (const LevelledFrame &frame : frames) {
        const lensprof_deflicker_frame &m = frame.measured;
        std::string name = std::filesystem::path(frame.file).filename().string();
        if (name.find_first_of(",\"\n") != std::string::npos) {
            std::string quoted = "\"";
            for (const char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
            name = quoted + "\"";
        }
        text += name
                + format(",%.3f,%s,%u,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.3f,%.4f\n", m.seconds, state_name(m.state),
                         m.segment, m.exposure.ev, m.ev_sigma, frame.wanted.ev, frame.change_ev(),
                         frame.wanted.white_balance[0] / m.exposure.white_balance[0],
                         frame.wanted.white_balance[2] / m.exposure.white_balance[2], m.agreeing, m.white_share);
    }
    return text;
}

std::vector<double> read_curve(const std::string &path, const FrameSequence &sequence) {
    std::map<std::string, double> by_name;
    std::vector<double> in_order;
    FieldReader reader(path, ',', max_text_bytes);
    for (bool is_first = true; reader.next_line_of_values(); is_first = false) {
        const std::string first = reader.text();
        if (!reader.has_more()) {
            const auto number = number_in(first);
            if (!number && !is_first) reader.fail("is neither an EV nor a name and an EV");
            if (number) in_order.push_back(*number);
            continue;
        }
        const auto number = number_in(reader.text());
        if (!number && !is_first) reader.fail("states no EV after the name");
        if (number && !by_name.emplace(first, *number).second) reader.fail("names a frame a second time");
    }
    const auto fail = [&](const std::string &text) { throw Failure(LENSPROF_ERROR_READ, path + ": " + text); };
    if (!by_name.empty() && !in_order.empty()) fail("has lines with and without names; give one kind");
    if (by_name.empty() && in_order.size() != sequence.frames.size())
        fail(format("has %zu values, but there are %zu frames; give one per frame", in_order.size(),
                    sequence.frames.size()));
    if (by_name.empty()) return in_order;
    std::vector<double> curve;
    for (const Frame &frame : sequence.frames) {
        const std::string name = std::filesystem::path(frame.file).filename().string();
        auto found = by_name.find(name);
        for (const char *suffix : {"", ".png", ".jpg"})  // frames of a clip, as pictures or not
            if (found == by_name.end()) found = by_name.find(std::filesystem::path(name).stem().string() + suffix);
        if (found == by_name.end()) fail("has no line for " + name + "; give one for every frame");
        curve.push_back(found->second);
    }
    return curve;
}

}  // namespace lensprof
