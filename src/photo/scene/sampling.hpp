// Pairs and tracks of the pictures of a scene.
#pragma once

#include <vector>

#include "photo/base/events.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {

// Grey values outside this range are black or saturated.
struct GreyRange {
    double black = 2.0 / 255.0, white = 250.0 / 255.0;
    bool every_pixel = false;  // share of a patch that must be within; else its mean
};

// An image as the library samples it, in pixels of its file; its pixels belong to `picture`.
lensprof_sample_image sample_image(const Scene &scene, uint32_t image, SamplePicture &picture, const GreyRange &range);

// Sets the progress function of the options. Places are in pixels of the falloff's frame. `links` receives the links of
// the pictures; may be NULL. Pictures with matches give pairs at the matches, not through their cameras.
std::vector<lensprof_pair> sample_pairs(const Scene &scene, std::vector<SamplePicture> &pictures,
                                        lensprof_sample_options options, const GreyRange &range, Events &progress,
                                        std::vector<lensprof_link> *links);
std::vector<lensprof_observation> sample_tracks(const Scene &scene, std::vector<SamplePicture> &pictures,
                                                lensprof_sample_options options, Events &progress,
                                                std::vector<lensprof_link> *links);

// The content of a point file of tracks: per point its unsaturated observations, as consecutive pairs. Black
// observations are kept, unlike in the pairs of a fit: a fit of tracks, which joins such pairs again, uses them as
// bounds.
std::vector<lensprof_pair> pairs_of_tracks(const std::vector<lensprof_observation> &observations);

}  // namespace lensprof
