// A Hugin project and its pictures, as the fit wants them.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/pictures/metadata.hpp"
#include "cli/pictures/picture.hpp"
#include "cli/program/library.hpp"
#include "cli/program/progress.hpp"

namespace lensprof {

struct Project {
    std::string path;  // of the .pto, or what was named in its place
    Pto pto;           // NULL where the project is not of a file
    std::vector<lensprof_pto_image> images;
    std::vector<std::string> names;  // as written in the project
    std::vector<std::string> files;  // path of each picture
    uint32_t reference = 0;          // image that the fit holds

    // Response and falloff of each image, where the project is of a file of exposures, which has no Pto.
    std::vector<std::shared_ptr<const lensprof_profile>> models;

    // Of pictures that were in no project: where they show the same, of links that the cameras do not fit or of all
    // (`by_matches`); those that are not part of it, and why; and how long finding it took.
    std::vector<lensprof_match> matches;
    std::vector<uint32_t> match_points;  // of a reconstruction: the scene point of each match,
    std::map<std::pair<uint32_t, uint32_t>, double> view_distances;  // and how far apart views are, where 1 is usual
    bool by_matches = false, is_reconstruction = false;
    std::vector<std::string> sources;   // files of the reconstruction, which outputs must not replace
    std::vector<lensprof_pair> pairs;   // that came with the project, in the place of pictures,
    std::vector<uint32_t> pair_points;  // and the scene point of each
    std::vector<std::pair<std::string, std::string>> left_out;
    double register_s = 0.0;
};

// Reads a project. The reference is the first image whose Eev is not asked for, else image 0.
Project read_project(const std::string &path);

// Takes the next image of the Pto; its name and file are the caller's to add.
void add_image(Project &project);

// The text of a project that is to be written to `path`: names are relative to that file's folder.
std::string project_text_at(Project &project, const std::string &path);

// The image that a user means by a number or a file name of the project.
uint32_t image_of_word(const Project &project, const std::string &word);

// The images of a project by what their files are, whatever their names.
class ImagesByFile {
public:
    explicit ImagesByFile(const Project &project);

    std::optional<uint32_t> find(const std::string &file) const;

    // Failure (usage) for a file that is none of them, which says to leave `option` out.
    uint32_t at(const std::string &file, const std::string &option) const;

private:
    const Project *project_;
    std::map<std::string, uint32_t> images_;  // by file_identity
};

// A picture reduced for sampling, with the mask of the project; no mask where nothing is excluded.
struct SamplePicture {
    Picture picture;
    std::vector<uint8_t> mask;
};

// Most bytes of memory for the pictures of a project, reduced for sampling, with their masks.
constexpr uint64_t project_max_bytes = uint64_t(8) << 30;

// Failure (unreadable) where a picture of the project is missing, cannot be read, is of another size than the project
// says, or where all of them, reduced to `max_side`, need more memory than project_max_bytes or than this machine has:
// by their headers, before the first is loaded.
void check_pictures(const Project &project, uint32_t max_side);

// Reads a picture, reduced to a longer side of at least `max_side` pixels. A size that contradicts the project, a file
// that cannot be read and float samples that are not finite are a Failure that names the file.
SamplePicture read_sample_picture(const Project &project, uint32_t image, uint32_t max_side);

// The same of all pictures, several at once.
std::vector<SamplePicture> read_pictures(const Project &project, uint32_t max_side, Progress &progress);

// Failure (unreadable) that names the first sample that is not a finite number, in rows of a picture from first_row
// on.
void check_finite(const lensprof_image &rows, uint32_t first_row, uint32_t reduction, const std::string &file);

// 3, or 1 when every picture is grey.
uint32_t channel_count(const std::vector<SamplePicture> &pictures);

// Grey values outside these are black or saturated.
struct GreyRange {
    double black = 2.0 / 255.0, white = 250.0 / 255.0;
    bool every_pixel = false;  // of a patch has to be within; else its mean
};

// An image as the library samples it; its pixels are those of `picture`.
lensprof_sample_image sample_image(const Project &project, uint32_t image, SamplePicture &picture,
                                   const GreyRange &range);

// The progress function of the options is set here.
// `links` receives those of the pictures; or NULL. Pictures with matches give pairs there, and not by their cameras.
std::vector<lensprof_pair> sample_pairs(const Project &project, std::vector<SamplePicture> &pictures,
                                        lensprof_sample_options options, const GreyRange &range, Progress &progress,
                                        std::vector<lensprof_link> *links);
std::vector<lensprof_observation> sample_tracks(const Project &project, std::vector<SamplePicture> &pictures,
                                                lensprof_sample_options options, Progress &progress,
                                                std::vector<lensprof_link> *links);

// What a point file holds of tracks: of every point its unsaturated observations, as pairs that follow each other.
// Black ones are kept, unlike in the pairs of a fit: a fit by tracks, which joins such pairs again, takes them as
// bounds.
std::vector<lensprof_pair> pairs_of_tracks(const std::vector<lensprof_observation> &observations);

// The pairs of a point file, which must be of images of the project.
std::vector<lensprof_pair> read_points(const std::string &path, const Project &project);
std::string points_text(const std::vector<lensprof_pair> &pairs, const Project &project);

// The images of the fit: sizes, links, unknowns, and exposures relative to the reference.
std::vector<lensprof_fit_image> fit_images(const Project &project);

// Exposures and white balances relative to those of one image.
std::vector<lensprof_exposure> relative_exposures(std::vector<lensprof_exposure> exposures, uint32_t reference);

// Geometric mean of exposures and white balances (Goldman & Chen 2005, equation 15) of images that were not left out.
lensprof_exposure mean_exposure(const std::vector<lensprof_exposure> &exposures);

// The project's own, relative to its reference.
std::vector<lensprof_exposure> project_exposures(const Project &project);

}  // namespace lensprof
