// A Hugin project and its pictures, as input of the fit.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/base/library.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {

struct Scene {
    std::string path;  // of the .pto, or of the input used instead
    Pto pto;           // NULL if the project does not come from a file
    std::vector<lensprof_pto_image> images;
    std::vector<std::string> names;         // as written in the project
    std::vector<std::string> files;         // path of each picture
    std::vector<PictureMetadata> metadata;  // of each; empty: not read yet
    uint32_t reference = 0;                 // image whose exposure is fixed

    // Response and falloff per image, for a file of exposures, which has no Pto.
    std::vector<std::shared_ptr<const lensprof_profile>> models;

    // For pictures without a project: matches of links that the cameras do not explain, or of all links (`by_matches`);
    // pictures that are not part of it, with reasons; and the time of finding overlaps.
    std::vector<lensprof_match> matches;
    std::vector<uint32_t> match_points;                              // of a reconstruction: the scene point per match,
    std::map<std::pair<uint32_t, uint32_t>, double> view_distances;  // and how far apart views are, relative to the
                                                                     // usual distance
    bool by_matches = false, is_reconstruction = false;
    std::vector<std::string> sources;   // files of the reconstruction, which outputs must not replace
    std::vector<lensprof_pair> pairs;   // pairs that came with the project instead of pictures,
    std::vector<uint32_t> pair_points;  // and the scene point per pair
    std::vector<std::pair<std::string, std::string>> left_out;
    size_t unlinked = 0;  // pictures given that overlap no other
    double register_s = 0.0;
};

// Reads a project. The reference is the first image whose Eev is not free, else image 0.
Scene read_hugin_project(const std::string &path);

// The frame of an image's falloff, in pixels of its file: the picture or, for one of several crops, the crop
// (lensprof_pto_image.of_crop).
struct FalloffFrame {
    double left, top;
    uint32_t width, height;
};
FalloffFrame falloff_frame_of(const lensprof_pto_image &image);

// Whether an image is a crop of its file; Failure (usage) with the name of what does not support that.
bool has_crops(const Scene &scene);
void refuse_crops(const Scene &scene, const std::string &option);

// Adds the next image of the Pto; the caller adds its name and file.
void add_image(Scene &scene);

// The text of a project to be written to `path`: names are relative to the folder of that file.
std::string project_text_at(Scene &scene, const std::string &path);

// The image that a user gives by number or file name.
uint32_t image_of_word(const Scene &scene, const std::string &word);

// Finds images of a project by file identity, regardless of the name.
class ImagesByFile {
public:
    explicit ImagesByFile(const Scene &scene);

    std::optional<uint32_t> find(const std::string &file) const;

    // Failure (usage) for a file that is not an image of the project; the text advises to omit `option`. The first
    // image, if there are several in crops of the file.
    uint32_t at(const std::string &file, const std::string &option) const;

private:
    const Scene *scene_;
    std::map<std::string, uint32_t> images_;  // by file_identity
};

// A picture reduced for sampling, with the mask of the project; no mask if nothing is excluded.
struct SamplePicture {
    Picture picture;
    std::vector<uint8_t> mask;
};

// Maximum memory for the reduced pictures of a project with their masks.
constexpr uint64_t scene_max_bytes = uint64_t(8) << 30;

// Checks the headers before the first picture is loaded. Failure (unreadable) if a picture is missing, unreadable or of
// another size than the project states, or if all pictures, reduced to `max_side`, need more memory than
// project_max_bytes or than the machine has.
void check_pictures(const Scene &scene, uint32_t max_side);

// Reads a picture, reduced to a longer side of at least `max_side` pixels. Failure with the file name for a size that
// contradicts the project, an unreadable file, and float samples that are not finite.
SamplePicture read_sample_picture(const Scene &scene, uint32_t image, uint32_t max_side);

// The same for all pictures, several in parallel.
std::vector<SamplePicture> read_pictures(const Scene &scene, uint32_t max_side, Events &progress);

// Failure (unreadable) with the first sample that is not finite, in rows of a picture starting at first_row.
void check_finite(const lensprof_image &rows, uint32_t first_row, uint32_t reduction, const std::string &file);

// 3, or 1 if all pictures are grey.
uint32_t channel_count(const std::vector<SamplePicture> &pictures);

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

// The pairs of a point file, which holds pixels of the pictures; they must refer to images of the project.
std::vector<lensprof_pair> read_points(const std::string &path, const Scene &scene);
std::string points_text(std::vector<lensprof_pair> pairs, const Scene &scene);

// The images of the fit: sizes, links, free parameters, and exposures relative to the reference.
std::vector<lensprof_fit_image> fit_images(const Scene &scene);

// Exposures and white balances relative to those of one image.
std::vector<lensprof_exposure> relative_exposures(std::vector<lensprof_exposure> exposures, uint32_t reference);

// Geometric mean of exposures and white balances (Goldman & Chen 2005, equation 15) of the images not left out.
lensprof_exposure mean_exposure(const std::vector<lensprof_exposure> &exposures);

// The exposures of the project, relative to its reference.
std::vector<lensprof_exposure> scene_exposures(const Scene &scene);

}  // namespace lensprof
