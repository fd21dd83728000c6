#pragma once

#include "bench/options/options.h"

#include <string>
#include <vector>

namespace tetrace {

/// A scene with images of one size. If a run measures several sizes, each is a scene of its own in rows and results:
/// "bunny/size:512", "bunny/size:640x480".
struct SizedScene {
    std::string label; ///< scene_label(), and the size if there are several
    ImageSize size;
};

/// The sizes of a scene in a run, in the order of --size; scene: its scene_label().
[[nodiscard]] std::vector<SizedScene> sized_scenes(const std::string& scene, const Options& options);

/// The labels of all scenes of a run, scene after scene. Throws Error{usage} if two would have the same.
[[nodiscard]] std::vector<std::string> scene_labels(const Options& options);

/// The options of a run whose images all have this size.
[[nodiscard]] Options at_size(Options options, ImageSize size);

/// The size in a label, "/size:512"; empty if it has none.
[[nodiscard]] std::string size_in(const std::string& label);

} // namespace tetrace
