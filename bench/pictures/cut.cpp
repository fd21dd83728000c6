#include "bench/pictures/cut.h"

#include "core/base/error.h"
#include "core/mesh/tet_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace tetrace {

namespace {

constexpr double slack = 1e-9; // of a tet's height, so that no pixel on a face falls between two tets

/// The plane of a cut, in which the pixels of a view are a grid.
class CutPlane {
public:
    CutPlane(const Scene& scene, const View& view)
        : origin_(to_double(view.origin)), corner_(to_double(view.corner)), step_x_(to_double(view.step_x)),
          step_y_(to_double(view.step_y)), normal_(cross(step_x_, step_y_))
    {
        const Double3 middle = (to_double(scene.domain.low()) + to_double(scene.domain.high())) * 0.5;
        scale_ = dot(middle - origin_, normal_) / dot(corner_, normal_);
        if (!(scale_ > 0))
            throw Error(ErrorKind::usage, "--picture tally: the middle of the scene's box is not in front of the "
                                          "camera; choose other --views");
    }

    [[nodiscard]] Double3 point(double x, double y) const
    {
        return origin_ + (corner_ + step_x_ * x + step_y_ * y) * scale_;
    }
    /// Positive on one side, 0 on the plane.
    [[nodiscard]] double height(Double3 at) const { return dot(at - point(0, 0), normal_); }
    /// Of a point on the plane, in pixels.
    [[nodiscard]] std::array<double, 2> pixel(Double3 at) const
    {
        const Double3 from_corner = (at - point(0, 0)) * (1 / scale_);
        return {dot(from_corner, step_x_) / dot(step_x_, step_x_), dot(from_corner, step_y_) / dot(step_y_, step_y_)};
    }

private:
    Double3 origin_, corner_, step_x_, step_y_, normal_;
    double scale_ = 0;
};

using Points = std::array<Double3, 4>;

bool is_inside(const Points& tet, Double3 at)
{
    for (std::size_t face = 0; face < 4; ++face) {
        const auto& [i, j, k] = face_corners[face];
        const Double3 normal = cross(tet[j] - tet[i], tet[k] - tet[i]);
        const double apex = dot(tet[face] - tet[i], normal), here = dot(at - tet[i], normal);
        if (here / apex < -slack) return false;
    }
    return true;
}

/// The pixels that a tet's part of the plane may have.
struct PixelBox {
    std::array<double, 2> low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()},
        high{-low[0], -low[1]};

    void add(const std::array<double, 2>& pixel)
    {
        for (std::size_t axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], pixel[axis]);
            high[axis] = std::max(high[axis], pixel[axis]);
        }
    }
    [[nodiscard]] std::uint32_t first(std::size_t axis) const
    {
        return static_cast<std::uint32_t>(std::clamp(std::floor(low[axis]), 0.0, 1e9));
    }
    /// The one after the last of `size`.
    [[nodiscard]] std::uint32_t end(std::size_t axis, std::uint32_t size) const
    {
        return static_cast<std::uint32_t>(std::clamp(std::ceil(high[axis]) + 1, 0.0, static_cast<double>(size)));
    }
};

PixelBox box_on(const CutPlane& plane, const Points& tet)
{
    PixelBox box;
    std::array<double, 4> heights{};
    std::ranges::transform(tet, heights.begin(), [&](Double3 corner) { return plane.height(corner); });
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            if (heights[i] <= 0 && heights[j] >= 0 && heights[i] < heights[j])
                box.add(plane.pixel(tet[i] + (tet[j] - tet[i]) * (heights[i] / (heights[i] - heights[j]))));
    return box;
}

} // namespace

std::vector<std::uint32_t> tets_on_cut(const Scene& scene, const View& view, std::uint32_t width, std::uint32_t height)
{
    const CutPlane plane(scene, view);
    std::vector<std::uint32_t> found(std::size_t{width} * height, NO_TET);
    for (std::uint32_t tet = 0; tet < scene.tets.tets.size(); ++tet) {
        Points corners{};
        for (std::size_t i = 0; i < 4; ++i)
            corners[i] = to_double(scene.tets.vertices[scene.tets.tets[tet].vertices[i]]);
        const PixelBox box = box_on(plane, corners);
        for (std::uint32_t y = box.first(1); y < box.end(1, height); ++y)
            for (std::uint32_t x = box.first(0); x < box.end(0, width); ++x) {
                std::uint32_t& pixel = found[std::size_t{y} * width + x];
                if (pixel == NO_TET && is_inside(corners, plane.point(x, y))) pixel = tet;
            }
    }
    return found;
}

std::vector<Hit> tally_at_pixels(std::span<const std::uint32_t> tets, std::span<const std::uint64_t> sums,
                                 std::span<const double> volumes)
{
    const double volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
    const double length = std::accumulate(sums.begin(), sums.end(), 0.0);
    std::vector<Hit> pixels(tets.size(), Hit{NO_HIT, NO_TET, 0, 0, 0, 0});
    for (std::size_t i = 0; i < tets.size(); ++i) {
        if (tets[i] == NO_TET || length == 0) continue;
        const double percent = 100 * (static_cast<double>(sums[tets[i]]) / volumes[tets[i]]) / (length / volume);
        pixels[i].tet = tets[i];
        pixels[i].steps = static_cast<std::uint32_t>(std::lround(std::min(percent, 1e9)));
    }
    return pixels;
}

} // namespace tetrace
