// Which pictures `lensprof apply` corrects, with which model and exposure, and which it leaves out.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/correct/apply_options.hpp"
#include "photo/correct/correction.hpp"
#include "photo/correct/overlaps.hpp"
#include "photo/correct/picture_model.hpp"
#include "photo/correct/scene_model.hpp"

namespace lensprof {

// The project and, without --profile, its model.
struct ApplySource {
    std::unique_ptr<Scene> scene;
    std::unique_ptr<ImagesByFile> images;
    std::vector<lensprof_exposure> exposures;
    bool has_model = false;
    std::unique_ptr<PictureModels> models;
};

struct LeftOut {
    std::string file, reason;
    bool corrected_already = false;
    lensprof_status status = LENSPROF_ERROR_NOT_FOUND;
};

struct ApplyWork {
    std::vector<Correction> jobs;
    std::vector<LeftOut> left_out;
    std::vector<LeftOut> unjoined;      // missing from the result of the project
    std::vector<PlacedCorrection> lit;  // of --merge: all images that contribute
    lensprof_exposure mean{};           // the target of --set exposure=mean
};

ApplySource open_source(const ApplyOptions &o);

ApplyWork plan_work(const ApplyOptions &o, const ApplySource &source, Streams &streams);

}  // namespace lensprof
