#include "photo/pictures/note_place.hpp"

#include <algorithm>
#include <cstring>

#include "photo/pictures/tiff_directory.hpp"

namespace lensprof {

namespace {

constexpr size_t note_entry_bytes = 12;
constexpr uint16_t apple_headroom = 0x0021, apple_gain = 0x0030;

// The directory at `start` of a note.
struct NoteDirectory {
    TiffByteOrder order;
    std::vector<size_t> outside;  // entries in the note whose values are not in the entry
    size_t end = 0;               // 0: it is not a directory
};

NoteDirectory read_note_directory(const std::vector<uint8_t> &note, size_t start, TiffByteOrder order) {
    constexpr uint32_t max_entries = 512;
    NoteDirectory directory{order, {}, 0};
    if (note.size() < start + 2) return directory;
    const uint32_t count = order.get(&note[start], 2);
    if (count == 0 || count > max_entries || note.size() < start + 2 + note_entry_bytes * count) return directory;
    for (uint32_t i = 0; i < count; ++i) {
        const size_t entry = start + 2 + note_entry_bytes * i;
        const uint32_t size = tiff_type_bytes(static_cast<uint16_t>(order.get(&note[entry + 2], 2)));
        if (size == 0) return directory;
        if (uint64_t(size) * order.get(&note[entry + 4], 4) > 4) directory.outside.push_back(entry);
    }
    directory.end = start + 2 + note_entry_bytes * count;
    return directory;
}

// Whether the values of an entry are in the note after its directory, if offsets count from `base` bytes before it.
bool leads_into(const std::vector<uint8_t> &note, const NoteDirectory &directory, size_t entry, uint64_t base) {
    const uint64_t offset = directory.order.get(&note[entry + 8], 4);
    return offset >= base + directory.end && offset < base + note.size();
}

// Whether offsets count from `base` bytes before the note rather than from its start: more of them lead into the note,
// or, for a base that is smaller than the note, the first values then follow the directory more closely.
bool counts_from(uint64_t base, const std::vector<uint8_t> &note, const NoteDirectory &directory) {
    uint64_t based = 0, own = 0, first = UINT64_MAX;
    for (const size_t entry : directory.outside) {
        based += leads_into(note, directory, entry, base);
        own += leads_into(note, directory, entry, 0);
        first = std::min<uint64_t>(first, directory.order.get(&note[entry + 8], 4));
    }
    if (based != own || based == 0) return based > own;
    return first >= base + directory.end;
}

}  // namespace

std::vector<uint8_t> moved_note(std::vector<uint8_t> note, uint64_t from, uint64_t to) {
    for (const size_t start : {0, 6, 8, 10, 12})
        for (const bool big : {false, true}) {
            const NoteDirectory directory = read_note_directory(note, start, TiffByteOrder{big});
            if (directory.end == 0) continue;
            if (from == 0 || !counts_from(from, note, directory)) return note;
            for (const size_t entry : directory.outside)
                if (leads_into(note, directory, entry, from)) {
                    const uint64_t offset = directory.order.get(&note[entry + 8], 4) - from + to;
                    directory.order.put(&note[entry + 8], 4, static_cast<uint32_t>(offset));
                }
            return note;
        }
    return note;
}

// "Apple iOS", a version, "MM" and a directory, whose offsets are those in the note. Moves the other entries together;
// their values stay in place.
bool remove_gain_map_entries(std::vector<uint8_t> &note) {
    constexpr char mark[] = "Apple iOS";
    constexpr size_t start = 14;
    if (note.size() < start + 2 || std::memcmp(note.data(), mark, sizeof mark) != 0 || note[12] != 'M') return false;
    const TiffByteOrder order{true};
    const size_t count = order.get(&note[start], 2);
    if ((note.size() - start - 2) / note_entry_bytes < count) return false;
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        const size_t entry = start + 2 + note_entry_bytes * i;
        const uint32_t tag = order.get(&note[entry], 2);
        if (tag == apple_headroom || tag == apple_gain) continue;
        std::memmove(&note[start + 2 + note_entry_bytes * kept++], &note[entry], note_entry_bytes);
    }
    const auto end_of = [&](size_t entries) {
        return note.begin() + static_cast<std::ptrdiff_t>(start + 2 + note_entry_bytes * entries);
    };
    std::fill(end_of(kept), end_of(count), uint8_t(0));
    order.put(&note[start], 2, static_cast<uint32_t>(kept));
    return kept < count;
}

}  // namespace lensprof
