#include "photo/scene/exposure_times.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "fit/base/quantile.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/named_pictures.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

constexpr const char *times_name = "times.txt", *images_name = "images";
constexpr double farthest_ev = 64.0;  // from an exposure time of 1; what fits take

[[noreturn]] void fail_in_line(const std::string &path, size_t line, const std::string &what) {
    throw Failure(LENSPROF_ERROR_READ, path + ": line " + std::to_string(line) + ": " + what);
}

// The name without folder and extension, by which lines and pictures are matched.
std::string base_name(const std::string &file) { return fs::path(file).stem().string(); }

using PictureNumbers = std::map<std::string, size_t>;  // by name

PictureNumbers::iterator find_picture(PictureNumbers &pictures, const std::string &name) {
    const auto found = pictures.find(name);
    return found != pictures.end() ? found : pictures.find(base_name(name));
}

class LineParser {
public:
    explicit LineParser(const std::string &path) : path_(path) {}

    std::vector<TimesLine> lines() {
        std::istringstream text(read_text(path_, max_text_bytes));
        std::vector<TimesLine> lines;
        for (std::string line; std::getline(text, line);) {
            number_++;
            std::istringstream words(line.substr(0, line.find('#')));
            std::vector<std::string> fields;
            for (std::string word; words >> word;) fields.push_back(word);
            if (fields.empty()) continue;
            const TimesLine next = line_of(fields);
            if (!lines.empty() && !(next.time_stamp > lines.back().time_stamp))
                fail(
                    format("the time stamp %.12g is not after %.12g of line %zu; correct it, or sort the lines by time",
                           next.time_stamp, lines.back().time_stamp, lines.back().number));
            lines.push_back(next);
        }
        if (lines.empty()) throw Failure(LENSPROF_ERROR_READ, path_ + ": states no picture; give an intact file");
        return lines;
    }

private:
    [[noreturn]] void fail(const std::string &what) const { fail_in_line(path_, number_, what); }

    double number(const std::string &field, const char *what) const {
        double value = NAN;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value))
            fail(std::string("the ") + what + " is " + field + ", not a finite number; correct it");
        return value;
    }

    TimesLine line_of(const std::vector<std::string> &fields) const {
        if (fields.size() < 2 || fields.size() > 3)
            fail("has " + counted(fields.size(), "word")
                 + "; give name, time stamp and exposure time, the last if it is known");
        const double time = number(fields[1], "time stamp"),
                     exposure = fields.size() == 3 ? number(fields[2], "exposure time") : NAN;
        if (exposure <= 0.0)
            fail("the exposure time is " + fields[2] + ", but must be above 0; correct it, or omit it if unknown");
        if (std::abs(std::log2(exposure)) > farthest_ev)
            fail("the exposure time is " + fields[2]
                 + ", which no camera has in any unit; correct it, or omit it if unknown");
        return {number_, fields[0], time, std::log2(exposure)};
    }

    const std::string &path_;
    size_t number_ = 0;
};

// Gives lines to the pictures that they name.
class LineMatcher {
public:
    LineMatcher(const std::string &path, const std::vector<std::string> &files, bool is_whole)
        : path_(path), files_(files), is_whole_(is_whole), ev_(files.size(), NAN), line_of_(files.size(), 0) {
        for (size_t i = 0; i < files.size(); i++) {
            const auto [other, is_new] = picture_of_.emplace(base_name(files[i]), i);
            if (!is_new)
                throw Failure(LENSPROF_ERROR_ARGUMENT,
                              files[i] + ": has the name of " + files[other->second] + " in " + path + "; rename one");
        }
    }

    std::vector<double> match(const std::vector<TimesLine> &lines) {
        for (const TimesLine &line : lines) add(line);
        check_pictures_have_lines(lines.back().number);
        return ev_;
    }

private:
    void add(const TimesLine &line) {
        const auto found = find_picture(picture_of_, line.name);
        if (found == picture_of_.end()) {
            if (is_whole_)
                fail_in_line(path_, line.number,
                             "there is no picture " + line.name + "; remove the line, or add the picture");
            return;
        }
        size_t &of_picture = line_of_[found->second];
        if (of_picture)
            fail_in_line(path_, line.number,
                         line.name + " is already in line " + std::to_string(of_picture) + "; remove one of the lines");
        of_picture = line.number;
        ev_[found->second] = line.ev;
    }

    void check_pictures_have_lines(size_t lines) const {
        const auto missing = static_cast<size_t>(std::count(line_of_.begin(), line_of_.end(), 0u));
        if (!missing) return;
        const auto first = std::find(line_of_.begin(), line_of_.end(), 0u) - line_of_.begin();
        throw Failure(LENSPROF_ERROR_READ,
                      path_ + ": has " + std::to_string(lines) + " lines, but none for "
                          + files_[static_cast<size_t>(first)]
                          + (missing > 1 ? " and " + counted(missing - 1, "other picture") : std::string())
                          + "; add a line with name and time stamp, without exposure if unknown, or move the picture");
    }

    const std::string &path_;
    const std::vector<std::string> &files_;
    bool is_whole_;
    PictureNumbers picture_of_;
    std::vector<double> ev_;
    std::vector<size_t> line_of_;  // per picture, 0: none yet
};

// Only ratios count, but a file in seconds may be a surprise in other programs.
void note_unit(const std::string &path, std::vector<double> ev, Events &events) {
    constexpr double shortest_ms = 1e-3, longest_ms = 1e4;  // usual medians
    ev.erase(std::remove_if(ev.begin(), ev.end(), [](double e) { return std::isnan(e); }), ev.end());
    if (ev.empty()) return;
    const double middle = std::exp2(upper_median(ev));
    if (middle < shortest_ms || middle > longest_ms)
        events.note(path, format("its middle exposure is %.3g, which is unusual for milliseconds; only the ratios of "
                                 "exposures are used here, but other programs may need another unit",
                                 middle));
}

}  // namespace

ExposureSweep find_sweep(const std::string &folder, Events &events) {
    const std::string images = (fs::path(folder) / images_name).string();
    const std::string of_pictures = is_folder(images) ? images : folder;
    ExposureSweep sweep;
    std::vector<std::string> left_out;
    for (const NamedPicture &picture : named_pictures({of_pictures}, "", left_out)) sweep.files.push_back(picture.file);
    for (const std::string &text : left_out) events.warn({}, text);
    for (const std::string &place : {folder, of_pictures}) {
        const std::string times = (fs::path(place) / times_name).string();
        if (sweep.times.empty() && path_exists(times)) sweep.times = times;
    }
    return sweep;
}

std::vector<TimesLine> read_times_lines(const std::string &path) { return LineParser(path).lines(); }

std::vector<TimesLine> lines_of_files(const std::vector<TimesLine> &lines, const std::vector<std::string> &files) {
    if (lines.size() < files.size()) return lines;
    PictureNumbers unnamed;
    for (size_t i = 0; i < files.size(); i++) unnamed.emplace(base_name(files[i]), i);
    std::vector<TimesLine> in_order(files.size());
    for (const TimesLine &line : lines) {
        const auto found = find_picture(unnamed, line.name);
        if (found == unnamed.end()) continue;  // of a picture that was taken away
        in_order[found->second] = line;
        unnamed.erase(found);
    }
    return unnamed.empty() ? in_order : lines;
}

std::vector<double> read_exposure_times(const std::string &path, const std::vector<std::string> &files, bool is_whole,
                                        Events &events) {
    std::vector<double> ev = LineMatcher(path, files, is_whole).match(read_times_lines(path));
    note_unit(path, ev, events);
    return ev;
}

}  // namespace lensprof
