#include "photo/fields/field_list.hpp"

#include <lensprof/fields.h>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/cards/dark_frames.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/picture_stack.hpp"

namespace lensprof {
namespace {

void check_channel(const std::string &file, const PictureStack &stack, uint32_t channel) {
    if (stack.channel_count > 1 && channel == 0)
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            format("%s: has %u channels, and every channel has a shading of its own; choose one with %s=1 to %u",
                   file.c_str(), stack.channel_count, option_name("field_channel").c_str(), stack.channel_count));
    if (channel > stack.channel_count)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      format("%s: has %u channel%s, not %u; check %s", file.c_str(), stack.channel_count,
                             stack.channel_count == 1 ? "" : "s", channel, option_name("field_channel").c_str()));
}

// Unknown if it cannot be read: reading the pages reports it.
PictureMetadata metadata_of(const std::string &file) {
    try {
        return read_metadata(file);
    } catch (const Failure &failure) {
        if (!is_of_input(failure)) throw;
        return unknown_metadata();
    }
}

// Copies that lie next to the pictures have no shading any more.
void check_not_corrected(const std::string &file, const PictureMetadata &metadata) {
    if (metadata.mark && metadata.mark->falloff == CorrectionMark::Falloff::removed)
        throw Failure(LENSPROF_ERROR_READ, file + ": is a corrected copy; give the original");
}

void add_pages(const std::string &file, uint32_t channel, FieldList &list, Events &events) {
    const PictureStack stack = picture_stack(file);
    check_channel(file, stack, channel);
    if (!stack.others.empty())
        events.note(file,
                    "has images of another size than its first, which are left out: " + joined(stack.others, "; "));
    for (size_t i = 0; i < stack.pages.size(); i++) {
        if (channel && stack.channels[i] != channel - 1) continue;
        const std::string name = stack.pages.size() > 1 ? format("%s, page %zu", file.c_str(), i + 1) : file;
        list.pages.push_back({file, stack.pages[i], stack.offsets[i], name});
    }
    if (list.pages.size() > LENSPROF_FIELDS_IMAGES)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      file
                          + format(": with its pictures there are more than %d; give fewer, such as every tenth",
                                   LENSPROF_FIELDS_IMAGES));
    list.files++;
    if (stack.is_damaged)
        list.left_out.push_back(file
                                + format(": the pages after page %zu cannot be found: the file is truncated or "
                                         "damaged; copy it again",
                                         stack.pages.size()));
}

}  // namespace

FieldList field_list(const std::vector<std::string> &names, const std::vector<std::string> &dark_files,
                     uint32_t channel, Events &events) {
    FieldList list;
    std::vector<UnlistedFolder> unlisted;
    std::vector<NamedPicture> pictures = named_pictures(names, "", list.left_out, &unlisted);
    leave_out_dark_frames(dark_files, pictures, events);
    for (const NamedPicture &picture : pictures) {
        note_instead(picture, events);
        try {
            const PictureMetadata metadata = metadata_of(picture.file);
            check_not_corrected(picture.file, metadata);
            const bool is_first = list.pages.empty();
            add_pages(picture.file, channel, list, events);
            if (is_first) list.metadata = metadata;
        } catch (const Failure &failure) {
            if (failure.group() != LENSPROF_ERROR_READ) throw;
            list.left_out.push_back(failure.what());
        }
    }
    for (const UnlistedFolder &folder : unlisted) list.left_out.push_back(folder.reason);
    if (list.pages.empty())
        throw Failure(LENSPROF_ERROR_READ,
                      list.left_out.empty() ? names.front() + ": no pictures; give some" : list.left_out.front());
    return list;
}

}  // namespace lensprof
