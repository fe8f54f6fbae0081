#include "cli/correct/clip_output.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "cli/program/numbers.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

constexpr char frame_prefix[] = "frame_", frame_records[] = ".lensprof-frames.json";

void read_codec(const std::string &word, ClipCodec &codec) {
    const size_t colon = std::min(word.find(':'), word.size());
    codec.name = word.substr(0, colon), codec.quality = -1;
    if (codec.name != "png" && codec.name != "jpeg" && !is_video_codec(codec.name))
        throw std::invalid_argument(word + ": use png, jpeg, h264, h265, vp9 or ffv1");
    if (colon == word.size()) return;
    if (codec.name == "png" || codec.name == "ffv1")
        throw std::invalid_argument(word + ": " + codec.name + " is lossless and has no quality; omit it");
    const bool is_jpeg = codec.name == "jpeg";
    const int low = is_jpeg ? 1 : 0, high = is_jpeg ? 100 : worst_quality(codec.name);
    try {
        codec.quality =
            static_cast<int>(count_of(word.substr(colon + 1), static_cast<uint32_t>(low), static_cast<uint32_t>(high)));
    } catch (const std::invalid_argument &) {
        throw std::invalid_argument(
            word + ": " + codec.name
            + format(" has qualities of %d to %d, where %s is better; give one, or omit the colon", low, high,
                     is_jpeg ? "higher" : "lower"));
    }
}

bool is_picture_codec(const ClipCodec &codec) { return codec.name == "png" || codec.name == "jpeg"; }

// Rounded to 8 bits.
Picture with_8_bits(const Picture &deep) {
    Picture picture;
    picture.width = picture.frame_width = deep.width, picture.height = picture.frame_height = deep.height;
    picture.layout = deep.layout, picture.row_bytes = deep.row_bytes / 2;
    picture.pixels.resize(deep.pixels.size() / 2);
    for (size_t n = 0; n < picture.pixels.size(); n++)
        picture.pixels[n] =
            static_cast<uint8_t>(std::lround(255.0 * sample_value(LENSPROF_SAMPLE_U16, deep.pixels.data(), n)));
    return picture;
}

}  // namespace

void declare_codec(Command &command, ClipCodec &codec) {
    command.expert().word(
        "--codec", "CODEC[:QUALITY]", [&codec](const std::string &word) { read_codec(word, codec); },
        "coding of the levelled frames of a clip. Of a folder: png (default) or jpeg:1..100 (95). Of a video: h264:0..51 "
        "(16; lower is better), h265 (16), vp9:0..63 (20) or ffv1 (lossless); default h264, h265 for more than 8 bits, "
        "vp9 of .webm");
}

size_t frame_number(const std::string &word) {
    const bool is_prefixed = word.rfind(frame_prefix, 0) == 0;
    const std::string digits =
        is_prefixed ? std::filesystem::path(word.substr(sizeof frame_prefix - 1)).stem().string() : word;
    size_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc() && end == digits.data() + digits.size() ? number : 0;
}

bool is_video_output(const std::string &path) { return !is_folder(path) && is_video_name(path); }

ClipOutput::ClipOutput(const std::string &source, const std::string &path, const std::vector<std::string> &inputs,
                       const ClipCodec &codec, bool overwrite, Events &events)
    : events_(events),
      source_(source),
      path_(path),
      suffix_(codec.name == "jpeg" ? ".jpg" : ".png"),
      quality_(codec.quality) {
    const bool is_video = is_video_output(path);
    if (is_same_file(source, path))
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": is the input; give the output another name");
    if (!codec.name.empty() && is_video == is_picture_codec(codec))
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            "--codec " + codec.name
                + (is_video ? ": is for a folder, but " + path + " is the name of a video; use h264, h265, vp9 or ffv1"
                            : ": is for a video, but " + path
                                  + " is the name of a folder; use png or jpeg, or "
                                    "give a name with .mp4 or .mkv"));
    if (!is_video) {
        check_output_folder(path);
        check_frames(inputs, overwrite);
        return;
    }
    if (is_folder(source))
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": a video is written of a video, but " + source
                                                   + " is a folder; give the name of a folder");
    check_not_reserved(path, "output", inputs);
    if (path_exists(path) && !overwrite)
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": exists; give another name, or replace it with --overwrite");
    writer_ = std::make_unique<VideoWriter>(source, path, codec, events);
    suffix_.clear();
}

// Of the frames that the folder has already: those of an interrupted run of this clip are its own.
void ClipOutput::check_frames(const std::vector<std::string> &inputs, bool overwrite) {
    std::set<std::string> read;
    for (const std::string &input : inputs) read.insert(file_identity(input));
    ledger_ = std::make_unique<Ledger>(path_, overwrite, frame_records);
    const Json notes = {{"source", ascii_path(canonical_path(source_))}};
    const bool is_of_this_clip = ledger_->notes == notes;
    ledger_->notes = notes;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error)) {
        const std::string file = entry->path().string(), name = entry->path().filename().string();
        const size_t number = frame_number(name);
        if (number == 0 || (name != name_of(number - 1) && !ledger_->contains(file))) continue;
        older_.insert(file);
    }
    for (const std::string &file : older_) {
        if (read.count(file_identity(file)))
            throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is a frame of the input; give the output another name");
        if (!overwrite && (!is_of_this_clip || ledger_->is_foreign(file)))
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          file + ": exists; give the folder another name, or replace its frames with --overwrite");
    }
}

// Writes it, unless an interrupted run has written the same.
void ClipOutput::write_picture_of(size_t index, Picture &picture) {
    const std::string file = (std::filesystem::path(path_) / name_of(index)).string();
    const std::string_view pixels(reinterpret_cast<const char *>(picture.pixels.data()), picture.pixels.size());
    const std::string key =
        format("%d %u %u %s", quality_, picture.width, picture.height, digest_of_text(pixels).c_str());
    older_.erase(file);
    if (ledger_->is_current(file, key) && !ledger_->is_foreign(file)) {
        kept_++;
        return;
    }
    make_folder(path_);
    if (!is_begun_) ledger_->save();
    is_begun_ = true;
    ledger_->begin(file, key);
    picture.traits = PictureTraits();
    WriteOptions options;
    options.jpeg_quality = std::max(quality_, 0);
    const bool is_reduced = suffix_ == ".jpg" && picture.sample == LENSPROF_SAMPLE_U16;
    write_picture(file, is_reduced ? with_8_bits(picture) : picture, options);
    ledger_->finish(file);
}

std::string ClipOutput::name_of(size_t index) const { return format("%s%05zu", frame_prefix, index + 1) + suffix_; }

void ClipOutput::write_levelled(size_t index, size_t count, const lensprof_profile &model,
                                const lensprof_exposure &measured, const lensprof_exposure &wanted, VideoFrame &frame) {
    lensprof_exposure exposure = measured;  // that which is removed
    exposure.ev -= wanted.ev;
    for (size_t c = 0; c < 3; c++) exposure.white_balance[c] /= wanted.white_balance[c];
    lensprof_error error{};
    lensprof_target pixels = frame.picture.target();
    check(lensprof_correct(&model, &exposure, &pixels, &error), name_of(index), &error);
    write_unchanged(index, count, frame);
}

void ClipOutput::write_unchanged(size_t index, size_t count, VideoFrame &frame) {
    if (writer_) {
        writer_->write(frame, count);
        return;
    }
    write_picture_of(index, frame.picture);
}

void ClipOutput::finish() {
    if (writer_) loss_ = writer_->finish();
    std::error_code ignored;
    for (const std::string &file : older_) std::filesystem::remove(file, ignored);
    older_.clear();
    if (writer_) return;
    ledger_->erase();
    if (kept_ > 0) events_.note(path_, counted(kept_, "frame") + " of an interrupted run kept");
}

Json ClipOutput::json() const {
    if (!loss_) return nullptr;
    return {{"file", path_},
            {"encoder", loss_->codec},
            {"pixels", loss_->pixels},
            {"mean_difference", loss_->mean},
            {"largest_difference", loss_->largest}};
}

std::string ClipOutput::text() const {
    if (!loss_) return {};
    return format(
        "coding    %s, %s: decoded, frames differ by %.2f levels of 255 on average (%.2f in the worst frame)\n",
        loss_->codec.c_str(), loss_->pixels.c_str(), loss_->mean, loss_->largest);
}

}  // namespace lensprof
