#pragma once

#include "bench/options/options.h"

#include <string>

namespace tetrace {

/// The part of a command line that asks for the same scene and the same images, and for buffers and tiles alike, as a
/// shell takes it: "--scene cubes --resolution 6 --size 256x256". Views are left out.
[[nodiscard]] std::string scene_arguments(const SceneRequest& request, const Options& options);

} // namespace tetrace
