#pragma once

#include "bench/reproduce/scene_run.h"

#include <vector>

namespace tetrace {

/// Whether `reproduce` is asked for the table or figure.
[[nodiscard]] bool wants(const Options& options, PaperTarget target);
/// Whether any of those asked for is of the scenes that --scene names.
[[nodiscard]] bool wants_scenes(const Options& options);

/// The builds that the requested tables need: the scenes as the options say, those of the paper also as near to its
/// counts as known, and the same with tets for rays. A scene without those that
/// are wanted has ours.
[[nodiscard]] std::vector<SceneBuild> scene_builds(const Options& options);

} // namespace tetrace
