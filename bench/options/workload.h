#pragma once

#include "bench/options/options.h"

#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// A named, versioned set of scenes, cameras and rays: results of one workload compare across versions of tetrace. A
/// name never changes its meaning; what is to change gets a new one.
struct Workload {
    /// Rays of a kind. hashes: of the given rays of each scene (RowRecord::ray_hash); none for primary rays, which
    /// follow from cameras and size.
    struct Rays {
        RayKind kind;
        std::vector<std::uint64_t> hashes = {};
    };

    std::string_view name, what;
    std::vector<std::string> scenes; ///< pinned (scenes/pinned.h), as are the cameras of camera set `frame`
    std::string views;               ///< of `frame`, as --views has it
    std::uint32_t size;              ///< width and height of images
    std::vector<Rays> rays;
};

/// All of them, the one that `bench` runs by default first.
[[nodiscard]] const std::vector<Workload>& workloads();

[[nodiscard]] std::vector<std::string> workload_names();

/// A scene of the default workload that is made from this row of the catalogue; the row itself if there is none.
[[nodiscard]] std::string default_scene(const std::string& row);

/// Makes the options ask for the workload of that name. Throws Error{usage} with the accepted names.
void apply_workload(Options& options, const std::string& name);

} // namespace tetrace
