#include "cli/calibrate/levelled_clip.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "cli/calibrate/clip_files.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/clip/transforms_file.hpp"

namespace lensprof {
namespace {

constexpr char images_name[] = "images";  // folder of the frames of a transforms.json, as nerfstudio keeps them

// The exposure that levelled frames have, per segment: the mean of its group, or the exposure of the group's first
// frame that is measured or of a given one. The white balance of that frame is only for its own segment.
std::vector<lensprof_exposure> wanted_exposures(const std::string &to, const ClipTracks &clip) {
    const size_t named = to == "mean" || to == "first" || to.empty() ? 0 : frame_number(to);
    if (named > clip.frames.size())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--to " + to + ": " + clip.path + " has "
                                                   + counted(clip.frames.size(), "frame") + "; name one of them");
    if (named > 0 && clip.frames[named - 1].state != ClipState::measured)
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            "--to " + to + ": this frame is " + clip_state_name(clip.frames[named - 1].state) + "; name another one");
    std::vector<lensprof_exposure> wanted;
    std::map<uint32_t, const ClipFrame *> of_group;
    if (named > 0) of_group[clip.frames[named - 1].group] = &clip.frames[named - 1];
    for (const ClipFrame &frame : clip.frames) {
        if (frame.state != ClipState::measured || frame.segment < wanted.size()) continue;
        if (to == "first") of_group.emplace(frame.group, &frame);
        lensprof_exposure exposure;
        lensprof_exposure_init(&exposure);
        const auto found = of_group.find(frame.group);
        if (found != of_group.end()) {
            if (found->second->segment == frame.segment) exposure = found->second->exposure;
            exposure.ev = found->second->exposure.ev;
        }
        wanted.resize(frame.segment + 1, exposure);
    }
    return wanted;
}

// Whether some frames cannot be compared with others.
bool has_groups(const ClipTracks &clip) {
    return std::any_of(clip.frames.begin(), clip.frames.end(),
                       [&](const ClipFrame &frame) { return frame.state == ClipState::measured && frame.group > 0; });
}

// Decodes the clip again and writes its frames at the wanted exposure of their segment without falloff. Frames that are
// not measured are left out of a folder, and unchanged in a video. Returns their numbers, from 0.
std::vector<uint32_t> write_levelled_frames(const ClipFit &fit, const ClipTracks &clip,
                                            const std::vector<lensprof_exposure> &wanted, const FrameSource &frames,
                                            ClipOutput &output, Events &events) {
    const auto profile = fit.profile();
    const auto source = frames.again();
    const size_t count = clip.frames.size();
    std::vector<uint32_t> unmeasured;
    size_t done = 0;
    for (VideoFrame frame; done < count && source->next(frame);) {
        const ClipFrame &measured = clip.frames[done];
        if (frame.number != measured.number) continue;
        stop_if_cancelled();
        const size_t index = done++;
        const bool is_measured = measured.state == ClipState::measured;
        if (!is_measured) unmeasured.push_back(static_cast<uint32_t>(index));
        if (!is_measured && !output.is_video()) continue;
        source->read(frame.picture);
        if (is_measured) {
            output.write_levelled(index, count, *profile, measured.exposure, wanted[measured.segment], frame);
        } else {
            output.write_unchanged(index, count, frame);
        }
        events.update_items("frames", static_cast<uint32_t>(done), static_cast<uint32_t>(count));
    }
    output.finish();
    events.clear();
    return unmeasured;
}

// The poses of the input for the levelled frames.
void write_transforms(const ClipCommand &o, const TransformsFile &transforms, const ClipTracks &clip,
                      const std::vector<lensprof_exposure> &wanted, const ClipOutput &output) {
    std::vector<LevelledPose> poses;
    for (size_t i = 0; i < clip.frames.size(); i++) {
        const ClipFrame &frame = clip.frames[i];
        if (frame.state == ClipState::measured)
            poses.push_back(
                {std::string(images_name) + "/" + output.name_of(i), frame.exposure.ev - wanted[frame.segment].ev});
        else
            poses.emplace_back();
    }
    const std::string path = transforms_path(o.levelled), text = levelled_transforms(transforms, o.levelled, poses);
    write_file(path, text.data(), text.size());
}

}  // namespace

std::unique_ptr<ClipOutput> open_levelled(const ClipCommand &o, const std::vector<std::string> &inputs,
                                          Events &events) {
    if (o.levelled.empty()) {
        if (!o.to.empty() || !o.codec.name.empty())
            throw Failure(LENSPROF_ERROR_ARGUMENT, std::string(o.to.empty() ? "--codec" : "--to")
                                                       + ": is for levelled frames; give --frames, too");
        return nullptr;
    }
    if (!o.to.empty() && o.to != "mean" && o.to != "first" && frame_number(o.to) == 0)
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--to " + o.to + ": is neither mean, first nor the number of a frame");
    if (has_transforms(o.input) && has_transforms(o.levelled) && !o.overwrite)
        throw Failure(LENSPROF_ERROR_ARGUMENT, o.levelled + ": has a " + transforms_name
                                                   + "; give another name, or replace it with --overwrite");
    const std::string place = has_transforms(o.input) && !is_video_output(o.levelled)
                                  ? (std::filesystem::path(o.levelled) / images_name).string()
                                  : o.levelled;
    if (is_in_new_folder(o.levelled, o.output)) make_folder(o.output);
    auto levelled = std::make_unique<ClipOutput>(o.input, place, inputs, o.codec, o.overwrite, events);
    if (levelled->is_video() && o.frames_per_s > 0.0)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      o.levelled + ": a video has all frames of its source; omit --fps, or give the name of a folder");
    return levelled;
}

void check_wanted(const ClipCommand &o, const ClipTracks &clip) { wanted_exposures(o.to, clip); }

void write_levelled(const ClipCommand &o, const ClipFit &fit, const ClipTracks &clip, const FrameSource &source,
                    ClipOutput &output, Events &events) {
    const auto wanted = wanted_exposures(o.to, clip);
    const auto unmeasured = write_levelled_frames(fit, clip, wanted, source, output, events);
    if (const TransformsFile *transforms = source.transforms()) write_transforms(o, *transforms, clip, wanted, output);
    if (has_groups(clip) && frame_number(o.to) > 0)
        events.note(o.levelled, "scenes without the frame " + o.to + " have their mean exposure");
    if (unmeasured.empty()) return;
    std::vector<std::string> names;
    for (size_t i = 0; i < clip.frames.size(); i++) names.push_back(output.name_of(i));
    events.note(o.levelled, std::string(output.is_video() ? "not levelled" : "left out")
                                + ", because the exposure is not measured: " + listed(unmeasured, names));
}

}  // namespace lensprof
