#pragma once

#include "bench/rows/row_run.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A step of a ray: a tet that it leaves. Tets, vertices and faces are those of the scene's mesh, whatever the layout.
struct RayStep {
    std::optional<std::uint32_t> tet;  ///< empty where the device names none of the scene
    std::optional<std::uint32_t> face; ///< opposite the tet's vertex of that number; empty where it cannot be told
    std::string beyond;                ///< "tet 12", "triangle 3", "outside"; else why there is no face
    std::array<float, 3> products{}; ///< side products at the face's edges, as side_products() has them; 0 without one

    friend bool operator==(const RayStep&, const RayStep&) = default;
};

/// A ray on a device. Its hit and its steps come from the kernel that the row times, and from whole images: a pixel's
/// neighbours may decide what a compiler's defect does.
struct RayOnDevice {
    const RowRun* row = nullptr;
    Hit hit{};                  ///< of the pixel in the whole image; its tet is the scene's
    Hit alone{};                ///< of the pixel traced as an image of its own
    std::vector<RayStep> steps; ///< none of BVHs, whose kernels do not tell the nodes that they visit
    bool is_cut = false;        ///< there are more steps
    Visits visits;              ///< of openmp in a BVH, counted by count_visits()
};

/// The most steps that are followed.
inline constexpr std::uint32_t max_shown_steps = 1000;

/// Follows the row's ray of a pixel: traces the image, or all given rays of the view, again and again, each time with a
/// cap of one step more, until the ray's walk ends; each step is the tet in which the walk was cut off. Then computes
/// the side products with the device's own arithmetic. Of a BVH, the answer alone. row: open, of one of our kernels.
/// Throws what the session and ray_of() throw.
[[nodiscard]] RayOnDevice follow_ray(RowRun& row, std::size_t view, const ImagePixel& pixel);

/// The first step (from 0) at which two devices differ in tet or face, or one has no step any more; empty where they
/// take the same steps.
[[nodiscard]] std::optional<std::size_t> first_difference(const RayOnDevice& a, const RayOnDevice& b);

/// A ray as the kernels have it.
struct PixelRay {
    Float3 origin, direction;
    std::optional<GivenRay> given = {}; ///< of a ray that is given: where it starts and ends
};
/// The primary ray of a pixel.
[[nodiscard]] PixelRay ray_of(const View& view, const ImagePixel& pixel);
/// The ray that a row of this key traces for a pixel of a view (an index in SceneWork::views()). Throws Error{usage}
/// where no ray of its kind was made for the pixel.
[[nodiscard]] PixelRay ray_of(SceneWork& scene, const RowKey& key, std::size_t view, const ImagePixel& pixel);

} // namespace tetrace
