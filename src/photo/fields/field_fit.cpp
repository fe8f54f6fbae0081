#include "photo/fields/field_fit.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "photo/base/format.hpp"
#include "photo/base/lap.hpp"
#include "photo/base/parallel.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/fit.hpp"
#include "photo/cards/count_samples.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/orientation.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/rotated_profile.hpp"

namespace lensprof {
namespace {

// What the first picture that can be read fixes for all.
struct FieldKind {
    std::string name;
    uint32_t width = 0, height = 0, channels = 0, sample = 0;
    uint16_t orientation = 1;
    bool is_lossy = false;
};

FieldKind kind_of_field(const std::string &name, const Picture &picture) {
    return {
        name,           picture.frame_width,        picture.frame_height,   lensprof_layout_channels(picture.layout),
        picture.sample, picture.traits.orientation, picture.traits.is_lossy};
}

const char *sample_name(uint32_t sample) {
    return sample == LENSPROF_SAMPLE_U8 ? "8 bit" : sample == LENSPROF_SAMPLE_U16 ? "16 bit" : "float";
}

void require_kind(const FieldKind &first, const FieldKind &other) {
    if (other.width != first.width || other.height != first.height)
        throw Failure(
            LENSPROF_ERROR_READ,
            format("%s: is %u x %u px, not %u x %u as %s; give pictures of one camera and binning", other.name.c_str(),
                   other.width, other.height, first.width, first.height, first.name.c_str()));
    if (other.channels != first.channels)
        throw Failure(LENSPROF_ERROR_ARGUMENT, other.name + (other.channels == 1 ? ": is grey, " : ": is in colour, ")
                                                   + first.name + " is not; give pictures of one kind");
    if (other.sample != first.sample)
        throw Failure(LENSPROF_ERROR_ARGUMENT, other.name + ": has " + sample_name(other.sample) + " samples, "
                                                   + first.name + " has " + sample_name(first.sample)
                                                   + " ones; give pictures of one kind");
}

bool is_black_stated(const FieldOptions &o) { return o.dark || !o.levels.black.empty(); }

// The levels as stated, 0..1 for integer samples; float counts stay counts. White is 0 if the end of the range is to be
// found.
lensprof_levels stated_levels(const FieldOptions &o, const Picture &first, const std::string &name, Events &events) {
    const bool are_kept = are_counts(first)
                          || (first.sample == LENSPROF_SAMPLE_F32 && o.levels.white && !o.levels.white->is_share
                              && o.levels.white->number > 1.0);
    const double bright = are_kept ? bright_sample(first) : 1.0;
    const LevelScale scale =
        are_kept ? LevelScale{1.0, false, std::max(bright, o.levels.white ? o.levels.white->number : 0.0)}
                 : LevelScale::of(first);
    lensprof_levels levels{};
    if (o.dark) {
        const DarkScale reached = are_kept ? DarkScale{bright, false, scale.has_counts()} : DarkScale{};
        const DarkLevel dark = dark_level_for(*o.dark, reached, first, name, events);
        std::copy(dark.black.begin(), dark.black.end(), levels.black);
    }
    levels = levels_of(o.levels, first, name, levels, scale);
    if (lensprof_layout_channels(first.layout) == 1) levels.black[0] = levels.black[1];
    return levels;
}

using Fields = std::unique_ptr<lensprof_fields, void (*)(lensprof_fields *)>;

// Adds pictures to the object of the library, which the first one makes.
class FieldReader {
public:
    FieldReader(const FieldOptions &o, FieldFit &found, Events &events) : o_(o), found_(found), events_(events) {}

    void add(const FieldPage &page, const Picture &picture) {
        const FieldKind kind = kind_of_field(page.name, picture);
        if (!fields_) {
            levels_ = stated_levels(o_, picture, page.name, events_);
            begin(kind), found_.first = page;
        }
        require_kind(first_, kind);
        const lensprof_image view = picture.view();
        lensprof_error error{};
        check(lensprof_fields_add(fields_.get(), &view, nullptr, 0, &error), page.name, &error);
        found_.names.push_back(page.name);
    }

    const FieldKind &first() const { return first_; }
    const lensprof_levels &levels() const { return levels_; }  // as stated
    Fields take() { return std::move(fields_); }

private:
    void begin(const FieldKind &kind) {
        first_ = kind;
        const double full_scale = full_scale_of(kind.sample);
        lensprof_fields_options options;
        lensprof_fields_options_init(&options);
        options.channels = kind.channels, options.width = kind.width, options.height = kind.height;
        options.given_offset = is_black_stated(o_);
        if (options.given_offset) std::copy_n(levels_.black, 3, options.offset);
        options.white = levels_.white;
        if (o_.gamma || o_.profile) options.response = found_.response.data();
        options.responses = static_cast<uint32_t>(found_.response.size());
        options.progress = on_fit_progress, options.progress_user = &events_;
        lensprof_fields *made = nullptr;
        lensprof_error error{};
        check(lensprof_fields_create(&options, &made, &error), kind.name, &error);
        fields_.reset(made);
        found_.is_black_given = is_black_stated(o_);
        found_.width = kind.width, found_.height = kind.height, found_.full_scale = full_scale;
    }

    const FieldOptions &o_;
    FieldFit &found_;
    Events &events_;
    FieldKind first_;
    lensprof_levels levels_{};
    Fields fields_{nullptr, lensprof_fields_destroy};
};

// Reads in parallel, adds in order. A picture that cannot be read is left out.
void read_fields(const FieldList &list, FieldReader &reader, FieldFit &found, Events &events) {
    const auto count = static_cast<uint32_t>(list.pages.size());
    std::vector<Picture> pictures(count);
    std::vector<std::string> failures(count);
    for_each_in_order(
        count, thread_count(0),
        [&](uint32_t i) {
            try {
                ReadOptions read;
                read.page = list.pages[i].page, read.page_offset = list.pages[i].offset;
                pictures[i] = read_picture(list.pages[i].file, read);
            } catch (const Failure &failure) {
                if (failure.group() != LENSPROF_ERROR_READ) throw;
                failures[i] = failure.what();
                const std::string &file = list.pages[i].file, &name = list.pages[i].name;
                if (failures[i].compare(0, file.size(), file) == 0) failures[i].replace(0, file.size(), name);
            }
        },
        [&](uint32_t i) {
            stop_if_cancelled();
            events.update_items("reading pictures", i + 1, count);
            if (failures[i].empty())
                reader.add(list.pages[i], pictures[i]);
            else
                found.left_out.push_back(failures[i]);
            pictures[i] = Picture();
        });
    events.clear();
}

void warn_of_left_out(const std::vector<std::string> &messages, Events &events) {
    constexpr size_t most = 5;
    for (size_t i = 0; i < std::min(most, messages.size()); i++) events.warn("", messages[i] + " (left out)");
    if (messages.size() > most)
        events.warn("", format("%zu more pictures cannot be read (left out)", messages.size() - most));
}

void note_response(const FieldOptions &o, const FieldKind &first, const PictureMetadata &metadata, Events &events) {
    if (first.is_lossy)
        events.warn(first.name,
                    "is compressed with losses, which round small differences of light; use the pictures as "
                    "the camera wrote them");
    if (o.gamma || o.profile || metadata.processing_before == LENSPROF_PROCESSING_RAW) return;
    if (o.linear)
        events.note(first.name, "is linear according to " + option_name("linear") + ", and so is its profile"
                                    + advice("linear_pictures"));
    else if (first.sample == LENSPROF_SAMPLE_U8)
        events.note(first.name, "8 bit samples are taken as proportional to light; if they have a gamma, give it with "
                                    + option_name("gamma"));
}

std::shared_ptr<lensprof_profile> profile_of_fields(const FieldFit &found, const FieldKind &first, Events &events) {
    std::shared_ptr<lensprof_profile> profile = new_profile();
    lensprof_error error{};
    check(lensprof_fields_profile(found.held.get(), profile.get(), &error), "fit", &error);
    profile->key = found.key;
    const double *black = profile->levels.black;
    if (found.fit.channel[0].offset > 0.0 && black[0] == 0.0 && black[1] == 0.0 && black[2] == 0.0)
        events.warn(first.name,
                    format("the profile cannot hold the offset of %g: float samples must lie within 0 to 1; "
                           "subtract it before the correction",
                           found.fit.channel[0].offset));
    const uint16_t turn = sensor_orientation(first.width, first.height, first.orientation);
    if (!turn)
        events.note(first.name,
                    "is higher than wide, and no orientation states how it was rotated: the profile is stored "
                    "without what differs between opposite sides; give pictures that are wider than high");
    turn_profile_to_sensor(turn, *profile);
    return profile;
}

constexpr double black_noise = 0.02;  // of the light: cells without light are darker than the black level by noise

// Failure if pictures are darker than the black level that was stated.
void check_black(const FieldOptions &o, const lensprof_levels &given, const FieldFit &found) {
    for (uint32_t c = 0; c < found.fit.channels && is_black_stated(o); c++) {
        const double stated = found.full_scale * given.black[c], used = found.full_scale * found.fit.channel[c].offset;
        std::vector<double> levels;
        for (const lensprof_fields_image &image : found.images)
            if (std::isfinite(image.level[c])) levels.push_back(found.full_scale * image.level[c]);
        std::sort(levels.begin(), levels.end());
        const double light = levels.empty() ? 0.0 : levels[levels.size() / 2];
        if (stated > used + 1e-6 * found.full_scale + black_noise * light)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          found.names.front()
                              + format(": the pictures are darker than the black level of %g: parts of them lie at %g; "
                                       "correct %s",
                                       stated, used, o.dark ? o.dark->file.c_str() : option_name("black").c_str()));
    }
}

void take_result(FieldFit &found) {
    lensprof_error error{};
    lensprof_fields_result_init(&found.fit);
    check(lensprof_fields_get(found.held.get(), &found.fit, &error), "fit", &error);
    for (uint32_t i = 0; i < found.names.size(); i++) {
        lensprof_fields_image_init(&found.images.emplace_back());
        check(lensprof_fields_image_at(found.held.get(), i, &found.images.back(), &error), "fit", &error);
    }
    found.verdict = verdict_of(found.held.get());
    name_images(found.names, found.verdict);
}

}  // namespace

FieldFit fit_fields_of(const std::vector<std::string> &names, const FieldOptions &o, Events &events) {
    auto clock = std::chrono::steady_clock::now();
    const FieldList list = field_list(names, o.dark ? o.dark->files : std::vector<std::string>(), o.channel, events);
    FieldFit found;
    found.files = list.files, found.left_out = list.left_out;
    found.response = given_response(o.store, o.gamma, o.profile);
    const PictureMetadata &metadata = list.metadata;
    warn_of_truncation(metadata, o.store, list.pages.front().file, events);
    lensprof_profile_key key = metadata.key;
    if (o.linear && metadata.corrected_by.empty()) key.processing = LENSPROF_PROCESSING_RAW;
    found.key = override_key(key, metadata.size, o.store, list.pages.front().file);
    FieldReader reader(o, found, events);
    read_fields(list, reader, found, events);
    if (found.names.empty()) throw Failure(LENSPROF_ERROR_READ, found.left_out.front());
    warn_of_left_out(found.left_out, events);
    note_response(o, reader.first(), metadata, events);
    found.load_s = lap(clock);
    Fields fields = reader.take();
    lensprof_error error{};
    const lensprof_status status = lensprof_fields_fit(fields.get(), &error);
    events.clear();
    found.held = std::move(fields);
    check(status, found.names.front() + (found.names.size() > 1 ? " and the others" : ""), &error);
    take_result(found);
    check_black(o, reader.levels(), found);
    found.profile = profile_of_fields(found, reader.first(), events);
    found.solve_s = lap(clock);
    return found;
}

void store_fields(const StoreOptions &o, FieldFit &fit) {
    fit.profile_id = store_profile(o, *fit.profile, {"fields", fit.names.front(), fit.fit.usable != 0});
}

Picture shading_picture(const FieldFit &fit) {
    Picture picture;
    picture.width = picture.frame_width = fit.width, picture.height = picture.frame_height = fit.height;
    picture.sample = LENSPROF_SAMPLE_F32;
    picture.layout = fit.fit.channels == 3 ? LENSPROF_LAYOUT_RGB : LENSPROF_LAYOUT_GREY;
    const size_t channels = fit.fit.channels;
    picture.row_bytes = picture.width * channels * sizeof(float);
    picture.pixels.resize(picture.row_bytes * picture.height);
    auto *sample = reinterpret_cast<float *>(picture.pixels.data());
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++)
            for (uint32_t c = 0; c < channels; c++)
                *sample++ =
                    static_cast<float>(lensprof_gain_grid_eval(&fit.fit.shading, fit.width, fit.height, x, y, c));
    return picture;
}

}  // namespace lensprof
