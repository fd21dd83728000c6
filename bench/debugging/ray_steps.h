#pragma once

#include "bench/rows/row_run.h"
#include "core/device/backend.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tetrace {

/// The self-test's program (Backend::probe): an operation of kernels/probe.h a quad, and its results.
using RunOperations = std::function<std::vector<std::uint32_t>(std::span<const Quad> operations)>;

/// An edge that a ray passes, from a to b.
struct PassedEdge {
    Float3 a, b;
};

/// The side of the ray at each edge, u . ((a - o) x (b - o)), with every sum and product computed by a device, one
/// operation of its self-test's program each: what the device's arithmetic makes of it, whatever a kernel does.
/// Positive, negative or 0 as in docs/spec/README.md. Throws what `run` throws.
[[nodiscard]] std::vector<float> side_products(const Float3& origin, const Float3& direction,
                                               const std::vector<PassedEdge>& edges, const RunOperations& run);

/// A step of a ray: a tet that it leaves. Tets, vertices and faces are those of the scene's mesh, whatever the layout.
struct RayStep {
    std::optional<std::uint32_t> tet;  ///< empty if the device returns none of the scene
    std::optional<std::uint32_t> face; ///< opposite the tet's vertex of that number; empty if it is not known
    std::string beyond;                ///< "tet 12", "triangle 3", "outside"; else why no face is known
    std::array<float, 3> products{}; ///< side products at the face's edges, as side_products() has them; 0 without one

    friend bool operator==(const RayStep&, const RayStep&) = default;
};

/// A ray on a device. Its hit and its steps come from the kernel that the row times, and from whole images: a compiler
/// defect may depend on the pixel's neighbours.
struct RayOnDevice {
    const RowRun* row = nullptr;
    Hit hit{};                  ///< of the pixel in the whole image; its tet is the scene's
    Hit alone{};                ///< of the pixel traced as an image of its own
    std::vector<RayStep> steps; ///< none for BVHs, whose kernels do not report the nodes they visit
    bool is_cut = false;        ///< there are more steps
    Visits visits;              ///< of openmp in a BVH, counted by count_visits()
};

/// The maximum number of steps that are followed.
inline constexpr std::uint32_t max_shown_steps = 1000;

/// Follows the row's ray of a pixel: traces the image, or all given rays of the view, repeatedly, each time with a cap
/// that is one step higher, until the ray's walk ends; each step is the tet in which the walk was cut off. Then
/// computes the side products with the device's own arithmetic. For a BVH, only the hit. row: open, of one of our
/// kernels. Throws what the session and ray_of() throw.
[[nodiscard]] RayOnDevice follow_ray(RowRun& row, std::size_t view, const ImagePixel& pixel);

/// The first step (from 0) at which two devices differ in tet or face, or that only one has; empty if all are the same.
[[nodiscard]] std::optional<std::size_t> first_difference(const RayOnDevice& a, const RayOnDevice& b);

/// A ray as the kernels have it.
struct PixelRay {
    Float3 origin, direction;
    std::optional<GivenRay> given = {}; ///< of a given ray: its start and end
};
/// The given rays of a view, for keys of task rays.
[[nodiscard]] const RaySet& rays_of(SceneWork& scene, const RowKey& key, std::size_t view);
/// The place of a pixel's ray among those that a row of this key traces of a view. Throws as ray_of() does.
[[nodiscard]] std::size_t number_of_ray(SceneWork& scene, const RowKey& key, std::size_t view, const ImagePixel& pixel);
/// The primary ray of a pixel.
[[nodiscard]] PixelRay ray_of(const View& view, const ImagePixel& pixel);
/// The ray that a row of this key traces for a pixel of a view (an index in SceneWork::views()). Throws Error{usage} if
/// no ray of its kind was made for the pixel.
[[nodiscard]] PixelRay ray_of(SceneWork& scene, const RowKey& key, std::size_t view, const ImagePixel& pixel);

} // namespace tetrace
