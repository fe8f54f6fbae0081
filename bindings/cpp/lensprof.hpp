// lensprof.hpp - the C interface for C++17: blobs, plans for tiles of pixels and the profile database, with RAII.
//
//     lensprof::Store store("lenses.db");
//     lensprof::Key key;
//     key.lens = "Acme 50mm f/1.8", key.focal_mm = 50, key.aperture = 2.8;
//     const lensprof::Found found = store.lookup(key);
//     const lensprof::Plan<uint8_t> plan(found.profile, LENSPROF_LAYOUT_RGB, 640, 480);
//     plan.apply(pixels, {0, 0, 640, 480}); // a std::vector<uint8_t>, or a span
//
// Includes the headers of C, and needs nothing but them and the library. Errors are lensprof::Error. No global state.
// Threads: a plan may be used by several threads on different tiles, a store by one thread at a time.
#pragma once

#include <lensprof/lensprof.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#if __cplusplus >= 202002L
#include <span>
#endif

namespace lensprof {

#if __cplusplus >= 202002L
template <class T>
using Span = std::span<T>;
#else
// Elements that follow each other in memory of somebody else, as std::span of C++20.
template <class T>
class Span {
public:
    Span(T *data, std::size_t size) : data_(data), size_(size) {}
    template <class Container,
              class = std::enable_if_t<std::is_convertible_v<decltype(std::declval<Container &>().data()), T *>>>
    Span(Container &&container) : Span(container.data(), container.size()) {}
    T *data() const { return data_; }
    std::size_t size() const { return size_; }

private:
    T *data_;
    std::size_t size_;
};
#endif

// The library refused a call or failed; what() names the item and the next step.
class Error : public std::runtime_error {
public:
    Error(lensprof_status status, const std::string &text)
        : std::runtime_error(text + " (" + lensprof_status_name(status) + ")"), status_(status) {}
    lensprof_status status() const noexcept { return status_; }

private:
    lensprof_status status_;
};

inline void check(lensprof_status status, const std::string &text) {
    if (status != LENSPROF_OK) throw Error(status, text);
}

// Throws the error of a call that read a blob.
inline void check_blob(lensprof_status status, Span<const uint8_t> blob, const std::string &text) {
    const std::string item = "profile blob of " + std::to_string(blob.size()) + " bytes: ";
    if (status == LENSPROF_ERROR_LAYOUT) throw Error(status, item + "written by a newer lensprof; update this library");
    if (status == LENSPROF_ERROR_CORRUPT || (status != LENSPROF_OK && blob.size() == 0))
        throw Error(LENSPROF_ERROR_CORRUPT, item + "not a blob, or damaged; export it again");
    check(status, text);
}

// Camera, lens and setting; numbers that are LENSPROF_UNKNOWN and empty texts are unknown.
struct Key {
    std::string camera_maker, camera_model, lens;
    double crop_factor = LENSPROF_UNKNOWN, focal_mm = LENSPROF_UNKNOWN;
    double aperture = LENSPROF_UNKNOWN, distance_m = LENSPROF_UNKNOWN;  // f-number; may be infinite
    lensprof_processing processing = LENSPROF_PROCESSING_JPEG;

    lensprof_profile_key raw() const {
        lensprof_profile_key key;
        lensprof_profile_key_init(&key);
        put(camera_maker, key.camera_maker);
        put(camera_model, key.camera_model);
        put(lens, key.lens);
        key.crop_factor = crop_factor, key.focal_mm = focal_mm;
        key.aperture = aperture, key.distance_m = distance_m;
        key.processing = static_cast<uint32_t>(processing);
        return key;
    }

private:
    template <std::size_t N>
    static void put(const std::string &from, char (&to)[N]) {
        if (from.size() >= N || from.find('\0') != std::string::npos)
            throw Error(LENSPROF_ERROR_ARGUMENT,
                        '"' + from + "\": has a zero, or more than " + std::to_string(N - 1) + " bytes; shorten it");
        from.copy(to, from.size());
    }
};

// Response and falloff of one camera, lens and setting: 50 kB on the heap. The members of C are reached with ->.
class Profile {
public:
    Profile() : raw_(std::make_unique<lensprof_profile>()) { lensprof_profile_init(raw_.get()); }
    Profile(const Profile &other) : Profile() { check(lensprof_profile_copy(raw_.get(), other.get()), "no profile"); }
    Profile(Profile &&) noexcept = default;
    Profile &operator=(Profile other) noexcept {
        raw_.swap(other.raw_);
        return *this;
    }
    ~Profile() = default;

    static Profile unpack(Span<const uint8_t> blob) {
        Profile profile;
        check_blob(lensprof_profile_unpack(blob.data(), blob.size(), profile.get()), blob, "cannot be unpacked");
        return profile;
    }

    // As a blob, without covariance.
    std::vector<uint8_t> pack() const {
        const char *const invalid = "this profile: has values out of range; make it again";
        std::size_t bytes = 0;
        check(lensprof_profile_pack(get(), 0, nullptr, 0, &bytes), invalid);
        std::vector<uint8_t> blob(bytes);
        check(lensprof_profile_pack(get(), 0, blob.data(), blob.size(), nullptr), invalid);
        return blob;
    }

    // Relative illuminance of green in the corner, or of all channels.
    double corner_falloff() const { return lensprof_profile_corner_falloff(get(), 1, nullptr); }

    lensprof_profile *get() { return raw_.get(); }
    const lensprof_profile *get() const { return raw_.get(); }
    lensprof_profile *operator->() { return get(); }
    const lensprof_profile *operator->() const { return get(); }

private:
    std::unique_ptr<lensprof_profile> raw_;
};

// A part of a frame, px.
struct Tile {
    uint32_t x, y, width, height;
};

// Corrects falloff in the pixels of frames of one size, in samples of uint8_t, uint16_t or float. Immutable.
template <class Sample>
class Plan {
public:
    Plan(const Profile &profile, lensprof_layout layout, uint32_t width, uint32_t height) {
        lensprof_apply_options options = begin(layout, width, height);
        check(lensprof_apply_options_set_profile(&options, profile.get()), "this profile: cannot be applied");
        lensprof_error error = {};
        const lensprof_status status = prepare(options, error);
        check(status, error.text);
    }

    // Of a blob, which is read in place.
    Plan(Span<const uint8_t> blob, lensprof_layout layout, uint32_t width, uint32_t height) {
        lensprof_apply_options options = begin(layout, width, height);
        options.blob = blob.data(), options.blob_bytes = blob.size();
        lensprof_error error = {};
        const lensprof_status status = prepare(options, error);
        check_blob(status, blob, error.text);
    }

    // Corrects a tile in place. Its rows follow each other without gaps.
    void apply(Span<Sample> pixels, const Tile &tile) const {
        const std::size_t row = std::size_t{tile.width} * lensprof_layout_samples(layout_);
        const lensprof_target target = {
            pixels.data(), static_cast<std::ptrdiff_t>(row * sizeof(Sample)), tile.width, tile.height, kType, layout_};
        const bool fits = row > 0 && pixels.size() % row == 0 && pixels.size() / row == tile.height;
        check(fits ? lensprof_apply(plan_, nullptr, &target, tile.x, tile.y) : LENSPROF_ERROR_SIZE,
              std::to_string(pixels.size()) + " samples for " + std::to_string(tile.width) + " x "
                  + std::to_string(tile.height) + " px at (" + std::to_string(tile.x) + ", " + std::to_string(tile.y)
                  + "): the tile must fit the frame and the pixels");
    }

private:
    static_assert(std::is_same_v<Sample, uint8_t> || std::is_same_v<Sample, uint16_t> || std::is_same_v<Sample, float>,
                  "samples are uint8_t, uint16_t or float");
    static constexpr uint32_t kType = std::is_same_v<Sample, float>      ? LENSPROF_SAMPLE_F32
                                      : std::is_same_v<Sample, uint16_t> ? LENSPROF_SAMPLE_U16
                                                                         : LENSPROF_SAMPLE_U8;

    lensprof_apply_options begin(lensprof_layout layout, uint32_t width, uint32_t height) {
        lensprof_apply_options options;
        lensprof_apply_options_init(&options);
        options.frame_width = width, options.frame_height = height;
        options.source_sample = options.target_sample = kType;
        options.source_layout = layout_ = static_cast<uint32_t>(layout);
        return options;
    }

    lensprof_status prepare(const lensprof_apply_options &options, lensprof_error &error) {
        memory_.resize(lensprof_plan_bytes(&options) / sizeof(uint64_t) + 1);
        return lensprof_plan_init(memory_.data(), memory_.size() * sizeof(uint64_t), &options, &plan_, &error);
    }

    std::vector<uint64_t> memory_;  // holds what plan_ points to, also after a move; copies would point to another's
    const lensprof_plan *plan_ = nullptr;
    uint32_t layout_ = 0;

public:
    Plan(const Plan &) = delete;
    Plan &operator=(const Plan &) = delete;
    Plan(Plan &&) noexcept = default;
    Plan &operator=(Plan &&) noexcept = default;
    ~Plan() = default;
};

// The answer of a lookup: `how` has its members of C, such as exact, rows, sigma and reason.
struct Found {
    Profile profile;
    lensprof_lookup how;
};

// An open profile database; closed at the end of its life.
class Store {
public:
    // The path in UTF-8, or as the system has it.
    explicit Store(const std::string &path, lensprof_store_mode mode = LENSPROF_STORE_READ) {
        lensprof_store *store = nullptr;
        lensprof_error error = {};
        const lensprof_status status = lensprof_store_open(path.c_str(), static_cast<uint32_t>(mode), &store, &error);
        check(status, error.text);
        store_.reset(store);
    }

    // The profile for a setting: a stored one, or composed of the lens's falloffs at other settings and the camera's
    // response. LENSPROF_ERROR_NOT_FOUND, with the reason, if nothing is near enough.
    Found lookup(const Key &key) const {
        Found found;
        lensprof_error error = {};
        const lensprof_profile_key raw = key.raw();
        lensprof_lookup_init(&found.how);
        const lensprof_status status =
            lensprof_store_lookup(get(), &raw, nullptr, found.profile.get(), &found.how, &error);
        check(status, error.text);
        return found;
    }

    // For the other functions of store.h.
    lensprof_store *get() const { return store_.get(); }

private:
    struct Close {
        void operator()(lensprof_store *store) const { lensprof_store_close(store); }
    };
    std::unique_ptr<lensprof_store, Close> store_;
};

}  // namespace lensprof
