#pragma once

#include "core/rays/camera.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// A camera set of the user's own.
struct OwnCameras {
    std::string name;
    std::vector<Aim> views;
    std::string file = {}; ///< as it was named

    /// Of all numbers of all views, in their order; not of the name.
    [[nodiscard]] std::uint64_t hash() const;
    [[nodiscard]] std::vector<Camera> cameras(const BoundingSphere& sphere) const;
};

/// Reads a file as docs/cameras.md and docs/cameras.schema.json state it. Throws Error{missing} for a missing file;
/// Error{invalid_input} naming file and entry ("views[2].up: ...") for one that is not as stated.
[[nodiscard]] OwnCameras read_cameras(const std::filesystem::path& path);

} // namespace tetrace
