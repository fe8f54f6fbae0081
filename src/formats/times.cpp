// TUM's times.txt: name, time stamp and exposure time of every frame.
#include <cmath>
#include <cstring>

#include <lensprof/formats.h>

#include "formats/text/text.hpp"

namespace lensprof {
namespace {

double read_field(std::string_view word, const char *item, size_t line) {
    double value;
    if (!read_number(word, value))
        fail_at_line(line, std::string(item) + " is " + in_quotes(word) + ", not a finite number; correct it");
    return value;
}

lensprof_frame_time read_frame(std::string_view line, size_t number) {
    lensprof_frame_time frame{};
    const std::string_view id = next_word(line), time = next_word(line), exposure = next_word(line);
    if (time.empty()) fail_at_line(number, "a frame without a time; give name, time and exposure of each frame");
    if (!next_word(line).empty()) fail_at_line(number, "more than name, time and exposure; give another file");
    if (id.size() >= sizeof frame.id)
        fail_at_line(number, "the name " + in_quotes(id) + " is longer than 63 bytes; shorten it");
    for (char c : id)
        if ((c >= 0 && c < ' ') || c == 127) fail_at_line(number, "a name with control characters; remove them");
    std::memcpy(frame.id, id.data(), id.size());
    frame.time_s = read_field(time, "the time", number);
    frame.exposure_ms = exposure.empty() ? 0.0 : read_field(exposure, "the exposure", number);
    if (frame.exposure_ms < 0.0) fail_at_line(number, "an exposure below 0; correct it");
    if (frame.exposure_ms == 0.0) frame.exposure_ms = LENSPROF_UNKNOWN;
    return frame;
}

// Calls use(index, frame) for every frame; returns their number.
template <typename Use>
uint32_t walk(std::string_view text, Use use) {
    uint32_t count = 0;
    LineReader lines(text);
    while (lines.next()) {
        std::string_view rest = lines.line;
        const std::string_view first = next_word(rest);
        if (first.empty() || first[0] == '#') continue;
        const lensprof_frame_time frame = read_frame(lines.line, lines.number);
        if (count == UINT32_MAX) throw FormatFailure{LENSPROF_ERROR_SIZE, "over 4 billion frames; split the file"};
        use(count++, frame);
    }
    return count;
}

void check_frame(const lensprof_frame_time &frame, uint32_t index) {
    const auto demand = [&](bool holds, const char *message, lensprof_status status) {
        if (!holds) throw failure_at(LENSPROF_ITEM_FRAME, index, message, status);
    };
    const size_t length = strnlen(frame.id, sizeof frame.id);
    demand(length > 0 && length < sizeof frame.id, "its name is empty or not terminated; set id",
           LENSPROF_ERROR_ARGUMENT);
    for (size_t i = 0; i < length; i++)
        demand((frame.id[i] < 0 || frame.id[i] > ' ') && frame.id[i] != 127 && (i || frame.id[i] != '#'),
               "its name has blanks or control characters, or begins with #; change id", LENSPROF_ERROR_ARGUMENT);
    demand(std::isfinite(frame.time_s), "its time is not finite; correct it", LENSPROF_ERROR_NOT_FINITE);
    demand(frame.exposure_ms == LENSPROF_UNKNOWN || (frame.exposure_ms > 0.0 && std::isfinite(frame.exposure_ms)),
           "its exposure is not above 0; correct it, or set it to unknown", LENSPROF_ERROR_EXPOSURE);
}

std::string times_text(const lensprof_frame_time *frames, uint32_t count) {
    std::string text;
    for (uint32_t i = 0; i < count; i++) {
        check_frame(frames[i], i);
        text += frames[i].id;
        text += ' ';
        text += number_text(frames[i].time_s);
        if (frames[i].exposure_ms != LENSPROF_UNKNOWN) text += " " + number_text(frames[i].exposure_ms);
        text += '\n';
    }
    return text;
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lensprof_times_read(const void *data, size_t size, lensprof_frame_time *frames, uint32_t capacity,
                                    uint32_t *count, lensprof_error *error) {
    if ((!data && size) || (!frames && capacity) || !count) {
        set_error(error, "lensprof_times_read: data, frames or count is NULL; pass buffers");
        return LENSPROF_ERROR_ARGUMENT;
    }
    const std::string_view all = view_of(data, size);
    return at_boundary(error, [&] {
        *count = walk(all, [](uint32_t, const lensprof_frame_time &) {});
        if (!capacity) return;
        if (*count > capacity)
            throw FormatFailure{LENSPROF_ERROR_CAPACITY, std::to_string(*count) + " frames do not fit the buffer of "
                                                             + std::to_string(capacity) + "; pass a larger one"};
        walk(all, [&](uint32_t index, const lensprof_frame_time &frame) { frames[index] = frame; });
    });
}

lensprof_status lensprof_times_write(const lensprof_frame_time *frames, uint32_t frame_count, void *data,
                                     size_t capacity, size_t *count, lensprof_error *error) {
    if ((!frames && frame_count) || (!data && capacity)) {
        set_error(error, "lensprof_times_write: frames or data is NULL; pass buffers");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] { return times_text(frames, frame_count); });
}
