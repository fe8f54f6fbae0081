#include "photo/deflicker/frames.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "photo/base/file_kind.hpp"
#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/known_exposures.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

constexpr double kExposureStep = 0.1;  // EV, smallest difference of settings that is one

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::vector<NamedPicture> frame_files(const std::vector<std::string> &names, const std::string &output,
                                      Events &events) {
    std::vector<std::string> kinds;
    std::vector<NamedPicture> pictures = named_pictures(names, output, kinds);
    extract_outputs(pictures, events);
    for (const std::string &kind : kinds) events.note("", kind);
    std::set<std::string> folders, seen;
    for (const NamedPicture &picture : pictures) {
        if (!picture.in_folder) refuse_other_kind(picture.file);
        if (picture.in_folder) folders.insert(std::filesystem::path(picture.file).parent_path().string());
        if (!picture.instead_of.empty()) note_instead(picture, events);
        if (!seen.insert(file_identity(picture.file)).second)
            throw Failure(LENSPROF_ERROR_ARGUMENT, picture.file + ": given twice; give it once");
    }
    if (folders.size() > 1)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      *folders.begin() + " and " + *folders.rbegin()
                          + ": both have frames; give one folder, or its files, for one sequence");
    return pictures;
}

std::string size_text(const Frame &frame) {
    return format("%u x %u pixels%s", frame.metadata.size.width, frame.metadata.size.height,
                  frame.metadata.orientation > 1 ? format(", orientation %u", frame.metadata.orientation).c_str() : "");
}

// Leaves out frames that have another size or orientation than most.
void leave_out_odd(FrameSequence &sequence) {
    using Shape = std::tuple<uint32_t, uint32_t, uint16_t>;
    const auto shape_of = [](const Frame &frame) {
        return Shape{frame.metadata.size.width, frame.metadata.size.height, frame.metadata.orientation};
    };
    std::map<Shape, size_t> count;
    for (const Frame &frame : sequence.frames) count[shape_of(frame)]++;
    Shape usual{};
    size_t most = 0;
    for (const Frame &frame : sequence.frames)  // the first of several
        if (count[shape_of(frame)] > most) usual = shape_of(frame), most = count[usual];
    const auto first_usual = std::find_if(sequence.frames.begin(), sequence.frames.end(),
                                          [&](const Frame &frame) { return shape_of(frame) == usual; });
    const std::string usual_text = first_usual == sequence.frames.end() ? "" : size_text(*first_usual);
    std::vector<Frame> kept;
    for (Frame &frame : sequence.frames) {
        if (shape_of(frame) == usual)
            kept.push_back(std::move(frame));
        else
            sequence.left_out.push_back({frame.file, frame.file + ": has " + size_text(frame)
                                                         + ", but most frames have " + usual_text
                                                         + "; level frames of another size or orientation separately"});
    }
    sequence.frames = std::move(kept);
}

// Files that are named must be readable; of a folder, those that are not are left out.
void read_all(const std::vector<NamedPicture> &files, Events &events, FrameSequence &sequence) {
    std::vector<Frame> frames(files.size());
    std::vector<std::string> reasons(files.size());
    for_each_parallel(static_cast<uint32_t>(files.size()), "reading metadata", events, [&](uint32_t i) {
        frames[i].file = files[i].file;
        try {
            frames[i].metadata = read_metadata(files[i].file);
            if (frames[i].metadata.size.width == 0) frames[i].metadata.size = read_size(files[i].file);
        } catch (const Failure &failure) {
            if (!files[i].in_folder || !is_of_input(failure)) throw;
            reasons[i] = failure.what();
        }
    });
    for (size_t i = 0; i < files.size(); i++) {
        if (reasons[i].empty())
            sequence.frames.push_back(std::move(frames[i]));
        else
            sequence.left_out.push_back({files[i].file, reasons[i]});
    }
}

void order(FrameSequence &sequence) {
    auto &frames = sequence.frames;
    const auto by_name = [](const Frame &a, const Frame &b) { return comes_before(a.file, b.file); };
    std::stable_sort(frames.begin(), frames.end(), by_name);
    const auto has_time = [](const Frame &frame) { return frame.metadata.taken_s.has_value(); };
    if (frames.empty() || !std::all_of(frames.begin(), frames.end(), has_time)) return;
    const auto by_time = [](const Frame &a, const Frame &b) { return *a.metadata.taken_s < *b.metadata.taken_s; };
    sequence.is_by_time = !std::is_sorted(frames.begin(), frames.end(), by_time);
    std::stable_sort(frames.begin(), frames.end(), by_time);
    const double first = *frames.front().metadata.taken_s, length = *frames.back().metadata.taken_s - first;
    if (length < 0.1 * static_cast<double>(frames.size() - 1)) return;  // the times of a copy, or of a burst
    for (Frame &frame : frames) frame.seconds = *frame.metadata.taken_s - first;
}

void set_known_exposures(std::vector<Frame> &frames) {
    std::vector<PictureMetadata> metadata;
    for (const Frame &frame : frames) metadata.push_back(frame.metadata);
    const auto known = exif_exposures(metadata, std::vector<uint32_t>(frames.size(), 0));
    const auto is_known = [](const lensprof_known_exposure &e) { return e.state == LENSPROF_EXPOSURE_KNOWN; };
    if (!std::all_of(known.begin(), known.end(), is_known)) return;
    for (size_t i = 0; i < frames.size(); i++) frames[i].settings_ev = known[i].ev;
}

}  // namespace

bool FrameSequence::has_exposure_steps() const {
    double low = INFINITY, high = -INFINITY;
    for (const Frame &frame : frames) low = std::min(low, frame.settings_ev), high = std::max(high, frame.settings_ev);
    return high - low > kExposureStep;
}

bool comes_before(const std::string &a, const std::string &b) {
    size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (is_digit(a[i]) && is_digit(b[j])) {
            const auto number = [](const std::string &text, size_t &at) {
                while (at < text.size() && text[at] == '0') at++;
                const size_t begin = at;
                while (at < text.size() && is_digit(text[at])) at++;
                return text.substr(begin, at - begin);
            };
            const std::string m = number(a, i), n = number(b, j);
            if (m.size() != n.size()) return m.size() < n.size();
            if (m != n) return m < n;
            continue;
        }
        if (a[i] != b[j]) return a[i] < b[j];
        i++, j++;
    }
    return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

FrameSequence list_frames(const std::vector<std::string> &names, const std::string &output, Events &events) {
    FrameSequence sequence;
    const std::vector<NamedPicture> pictures = frame_files(names, output, events);
    std::vector<std::string> files;
    for (const NamedPicture &picture : pictures) files.push_back(picture.file);
    require_one_kind(files);
    read_all(pictures, events, sequence);
    leave_out_odd(sequence);
    if (sequence.frames.size() < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      sequence.left_out.empty()
                          ? files[0] + ": a single frame has no flicker; give at least two frames of a sequence"
                          : sequence.left_out[0].reason + "; a single frame that is left has no flicker",
                      LENSPROF_REASON_FEW_PAIRS);
    order(sequence);
    set_known_exposures(sequence.frames);
    return sequence;
}

}  // namespace lensprof
