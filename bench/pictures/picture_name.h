#pragma once

#include "bench/options/options.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tetrace {

/// What a picture shows; differs for each picture of a run.
struct PictureKey {
    std::string scene;
    std::uint32_t view = 0;
    Picture picture = Picture::normals;
};

/// The file of a picture: `out` itself where it is the run's only one, else with "-scene-view-kind" in front of its
/// ending; "scene-view-kind" with the given ending in the folder `out`, or in the current one without `out`.
[[nodiscard]] std::filesystem::path picture_path(const std::optional<std::filesystem::path>& out, const PictureKey& key,
                                                 const std::string& ending, bool only_picture);

/// The ending of all pictures of a run: that of the file `out`; else .png, or .ppm where nothing can write PNG.
[[nodiscard]] std::string picture_ending(const std::optional<std::filesystem::path>& out, bool can_write_png);

/// Throws Error{usage} if `out` is neither a folder nor has an accepted ending.
void check_picture_ending(const std::optional<std::filesystem::path>& out);

} // namespace tetrace
