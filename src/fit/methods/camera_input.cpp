#include "fit/methods/camera_input.hpp"

#include <algorithm>
#include <map>

#include "fit/base/joined_sets.hpp"

namespace lensprof {
namespace {

// Groups of images connected by data of one camera; each group is identified by its smallest index.
std::vector<uint32_t> camera_groups(const CamerasData &data, const std::vector<uint32_t> &camera_of) {
    JoinedSets groups(data.images.size());
    const auto join = [&](uint32_t i, uint32_t j) {
        if (camera_of[i] == camera_of[j]) groups.join(i, j);
    };
    for (const lensprof_pair &pair : data.pairs) join(pair.image[0], pair.image[1]);
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> first;  // for each point and camera, its first image
    for (const lensprof_observation &o : data.observations)
        join(first.try_emplace({o.point, camera_of[o.image]}, o.image).first->second, o.image);
    return groups.all();
}

// Selects the images of each camera that are fitted.
void part_images(const CamerasData &data, const std::vector<uint32_t> &camera_of, std::vector<CameraInput> &inputs) {
    const std::vector<uint32_t> groups = camera_groups(data, camera_of);
    std::vector<uint32_t> size(data.images.size()), largest(inputs.size(), kNoPlace);
    for (const uint32_t group : groups) size[group]++;
    for (uint32_t i = 0; i < groups.size(); i++) {
        uint32_t &best = largest[camera_of[i]];
        if (best == kNoPlace || size[groups[i]] > size[best]) best = groups[i];
    }
    for (CameraInput &input : inputs) input.place.assign(groups.size(), kNoPlace);
    for (uint32_t i = 0; i < groups.size(); i++) {
        CameraInput &input = inputs[camera_of[i]];
        input.number = data.images[i].camera;
        if (groups[i] != largest[camera_of[i]]) continue;
        input.place[i] = static_cast<uint32_t>(input.numbers.size());
        input.numbers.push_back(i);
        input.images.push_back(data.images[i]);
    }
}

// If images share unknowns with an image that is not included, they share them with the first included image of these.
void link_images(const std::vector<lensprof_fit_image> &all, CameraInput &input) {
    for (uint32_t lensprof_fit_image::*owner_field :
         {&lensprof_fit_image::ev_of, &lensprof_fit_image::red_of, &lensprof_fit_image::blue_of}) {
        std::map<uint32_t, uint32_t> first;  // by the image that owns the unknown
        for (uint32_t n = 0; n < input.images.size(); n++) {
            const uint32_t owner = all[input.numbers[n]].*owner_field;
            const uint32_t local_owner = input.place[owner] != kNoPlace ? input.place[owner] : n;
            input.images[n].*owner_field = first.try_emplace(owner, local_owner).first->second;
        }
    }
}

// Selects pairs or links within the images of a camera, with local indices.
template <class Item, class Add>
void part(const std::vector<uint32_t> &camera_of, std::vector<CameraInput> &inputs, Item item, Add add) {
    CameraInput &input = inputs[camera_of[item.image[0]]];
    for (uint32_t &image : item.image) {
        image = input.place[image];
        if (image == kNoPlace) return;
    }
    add(input, item);
}

void part_observations(const CamerasData &data, const std::vector<uint32_t> &camera_of,
                       std::vector<CameraInput> &inputs) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> seen;  // for each camera and point: observations
    const auto is_taken = [&](const lensprof_observation &o) {
        return inputs[camera_of[o.image]].place[o.image] != kNoPlace;
    };
    for (const lensprof_observation &o : data.observations)
        if (is_taken(o)) seen[{camera_of[o.image], o.point}]++;
    for (lensprof_observation o : data.observations) {
        CameraInput &input = inputs[camera_of[o.image]];
        if (!is_taken(o) || seen[{camera_of[o.image], o.point}] < 2) continue;
        o.image = input.place[o.image];
        input.observations.push_back(o);
    }
}

}  // namespace

std::vector<uint32_t> camera_numbers(const std::vector<lensprof_fit_image> &images) {
    std::map<uint32_t, uint32_t> numbers;
    std::vector<uint32_t> camera_of;
    for (const lensprof_fit_image &image : images)
        camera_of.push_back(numbers.try_emplace(image.camera, static_cast<uint32_t>(numbers.size())).first->second);
    return camera_of;
}

std::vector<CameraInput> part_cameras(const CamerasData &data, const std::vector<uint32_t> &camera_of) {
    std::vector<CameraInput> inputs(*std::max_element(camera_of.begin(), camera_of.end()) + 1);
    part_images(data, camera_of, inputs);
    const auto add_pair = [](CameraInput &to, const lensprof_pair &pair) { to.pairs.push_back(pair); };
    const auto add_link = [](CameraInput &to, const lensprof_link &link) { to.links.push_back(link); };
    for (const lensprof_pair &pair : data.pairs) part(camera_of, inputs, pair, add_pair);
    for (uint32_t n = 0; n < data.options.link_count; n++) part(camera_of, inputs, data.options.links[n], add_link);
    part_observations(data, camera_of, inputs);
    for (CameraInput &input : inputs) {
        link_images(data.images, input);
        input.options = data.options;
        input.options.unlinked_images = 0;  // judged for all cameras together
        input.options.links = input.links.data();
        input.options.link_count = static_cast<uint32_t>(input.links.size());
        const uint32_t setting = data.images[data.options.reference].setting;
        const auto same_setting =
            std::find_if(input.images.begin(), input.images.end(),
                         [&](const lensprof_fit_image &image) { return image.setting == setting; });
        const uint32_t reference = input.place[data.options.reference];
        input.options.reference = reference != kNoPlace ? reference
                                  : same_setting != input.images.end()
                                      ? static_cast<uint32_t>(same_setting - input.images.begin())
                                      : 0;
        // Its falloff and response belong to the reference's setting.
        if (same_setting == input.images.end()) input.options.profile = nullptr;
    }
    return inputs;
}

}  // namespace lensprof
