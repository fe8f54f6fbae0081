#include "photo/folder/sheet.hpp"

#include <algorithm>
#include <filesystem>

#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/base/parallel.hpp"
#include "photo/folder/attempt.hpp"
#include "photo/pictures/contact_sheet.hpp"
#include "photo/pictures/thumbnail.hpp"

namespace lensprof {
namespace {

constexpr uint32_t per_page = 60;

std::string note_of(const CorrectedPicture &picture) {
    return picture.ev ? format("%+.2f EV, panorama ", *picture.ev) + picture.panorama : correction_note(picture.job);
}

void write_sheet(const std::string &path, const CorrectedPictures &pictures, size_t begin, size_t count,
                 Events &events) {
    const CorrectedPicture *first = &pictures.list[begin];
    ContactSheet sheet(count);
    for_each_parallel(static_cast<uint32_t>(count), "contact sheet", events, [&](uint32_t i) {
        const InputPicture &picture = *first[i].picture;
        SmallCopies copies = small_copies(pictures, begin + i, picture.metadata.orientation, sheet.side());
        sheet.put(i, {std::move(copies.before), std::move(copies.after), picture.name, note_of(first[i])});
    });
    sheet.write(path);
}

}  // namespace

SmallCopies small_copies(const CorrectedPictures &pictures, size_t index, uint16_t orientation, uint32_t side) {
    SmallCopies copies;
    failure_of([&] {
        const SmallCopies stored = small_copies_of(pictures.list[index], pictures.list.size());
        copies = {upright_copy(stored.before, orientation, side), upright_copy(stored.after, orientation, side)};
    });
    return copies;
}

std::vector<std::string> sheet_names(const FolderOptions &o, size_t pictures) {
    std::vector<std::string> names;
    for (size_t page = 0; page * per_page < pictures; page++)
        names.push_back((std::filesystem::path(o.output) / sheet_name(page)).string());
    return names;
}

void write_sheets(const FolderOptions &o, const CorrectedPictures &pictures, Ledger &ledger, Events &events) {
    const std::vector<std::string> names = sheet_names(o, pictures.list.size());
    for (size_t page = 0; page < names.size(); page++) {
        stop_if_cancelled();
        const size_t first = page * per_page, count = std::min<size_t>(per_page, pictures.list.size() - first);
        std::string text = "sheet";
        for (size_t i = first; i < first + count; i++)
            text +=
                "\n" + pictures.list[i].key + " " + pictures.list[i].picture->name + " " + note_of(pictures.list[i]);
        const std::string key = digest_of_text(text);
        if (ledger.is_current(names[page], key)) continue;
        ledger.begin(names[page], key);
        ledger.save();
        write_sheet(names[page], pictures, first, count, events);
        ledger.finish(names[page]);
        ledger.save();
    }

    for (size_t page = names.size();; page++) {  // pages of an earlier, larger set
        const std::string name = sheet_names(o, (page + 1) * per_page).back();
        if (!ledger.contains(name)) break;
        ledger.remove(name);
    }
}

}  // namespace lensprof
