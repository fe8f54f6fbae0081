// What the opaque handles hold.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "photo/api/boundary.hpp"
#include "photo/base/memory_file.hpp"
#include "photo/calibration/calibration.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/scene/scene.hpp"

struct lensprof_picture {
    std::optional<lensprof::MemoryFile> bytes;  // of a picture in memory
    std::string path;                           // or that of `bytes`
    lensprof::Picture header;                   // at full size, without pixels
    lensprof::PictureMetadata metadata;
};

struct lensprof_scene {
    lensprof::Scene scene;
};

struct lensprof_calibration {
    lensprof::CallerEvents events;                  // of the call that runs
    std::optional<lensprof::Calibration> of_scene;  // empty: an opened result
    lensprof::Scene result;                         // the scene with its exposures and models
    std::vector<lensprof_exposure> exposures;       // of its images, relative to the reference

    bool corrects() const { return !of_scene || of_scene->fit.best.corrects(); }
};
