#include "core/rays/camera_set.h"

#include "core/base/exact.h"
#include "core/base/hash.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace tetrace {

namespace {

constexpr int glimpse_size = 32;                                      ///< along a side
constexpr double tan_half_view = 0.57735026918962576;                 // 30 degrees
constexpr double frame_start = 2, frame_end = 0.25, frame_step = 0.9; ///< radii, and the factor of a step

/// The slope of a pixel's ray against the axis of view.
double slope_of(int pixel)
{
    return tan_half_view * ((2 * pixel + 1.0) / glimpse_size - 1);
}
/// The first pixel whose ray has at least this slope.
int first_pixel(double slope)
{
    return static_cast<int>(
        std::clamp(std::ceil((slope / tan_half_view + 1) * glimpse_size / 2 - 0.5), 0.0, double{glimpse_size}));
}

/// The mean of the surface's points.
Double3 surface_centroid(const TriangleMesh& mesh, const BoundingSphere& sphere)
{
    Double3 sum;
    double area = 0;
    for (const auto& t : mesh.triangles) {
        const Double3 a = to_double(mesh.vertices[t[0]]) - sphere.centre,
                      b = to_double(mesh.vertices[t[1]]) - sphere.centre,
                      c = to_double(mesh.vertices[t[2]]) - sphere.centre;
        const double weight = length(cross(b - a, c - a));
        sum = sum + (a + b + c) * (weight / 3);
        area += weight;
    }
    return area > 0 ? sphere.centre + sum * (1 / area) : sphere.centre;
}

/// What a camera sees of a mesh in a small image.
class Glimpse {
public:
    Glimpse(const TriangleMesh& mesh, const Camera& camera)
    {
        const Double3 origin = to_double(camera.origin);
        std::vector<Double3> seen; // right, up, forward
        seen.reserve(mesh.vertices.size());
        for (const Float3 vertex : mesh.vertices) {
            const Double3 to = to_double(vertex) - origin;
            seen.push_back({dot(to, camera.right), dot(to, camera.up), dot(to, camera.forward)});
        }
        for (const auto& t : mesh.triangles)
            cover(seen[t[0]], seen[t[1]], seen[t[2]]);
    }

    [[nodiscard]] double hits() const
    {
        return static_cast<double>(std::ranges::count(is_hit_, true)) / (glimpse_size * glimpse_size);
    }

private:
    /// A ray through the origin is a sum of the corners with weights that have the signs of these triple products.
    void cover(Double3 a, Double3 b, Double3 c)
    {
        const Double3 weight_a = cross(b, c), weight_b = cross(c, a), weight_c = cross(a, b);
        const double volume = dot(a, weight_a);
        const bool in_front = a.z > 0 && b.z > 0 && c.z > 0;
        if (volume == 0 || (a.z <= 0 && b.z <= 0 && c.z <= 0)) return;
        int low_x = 0, high_x = glimpse_size, low_y = 0, high_y = glimpse_size;
        if (in_front) {
            const auto [min_x, max_x] = std::minmax({a.x / a.z, b.x / b.z, c.x / c.z});
            const auto [min_y, max_y] = std::minmax({a.y / a.z, b.y / b.z, c.y / c.z});
            low_x = first_pixel(min_x), high_x = std::min(glimpse_size, first_pixel(max_x) + 1);
            low_y = first_pixel(min_y), high_y = std::min(glimpse_size, first_pixel(max_y) + 1);
        }
        for (int y = low_y; y < high_y; ++y)
            for (int x = low_x; x < high_x; ++x) {
                const Double3 ray = {slope_of(x), slope_of(y), 1};
                if (dot(ray, weight_a) * volume >= 0 && dot(ray, weight_b) * volume >= 0 &&
                    dot(ray, weight_c) * volume >= 0)
                    is_hit_[static_cast<std::size_t>(y * glimpse_size + x)] = true;
            }
    }

    std::array<bool, std::size_t{glimpse_size} * glimpse_size> is_hit_{};
};

/// The share of a camera's rays that enter a box.
double box_share(const std::array<Double3, 2>& box, const Camera& camera)
{
    const Double3 origin = to_double(camera.origin);
    int entering = 0;
    for (int y = 0; y < glimpse_size; ++y)
        for (int x = 0; x < glimpse_size; ++x) {
            const Double3 ray = camera.forward + camera.right * slope_of(x) + camera.up * slope_of(y);
            double enter = 0, leave = 1e30;
            const auto clip = [&](double low, double high, double from, double along) {
                const double one = (low - from) / along, other = (high - from) / along;
                if (along == 0) {
                    if (from < low || from > high) leave = -1;
                    return;
                }
                enter = std::max(enter, std::min(one, other));
                leave = std::min(leave, std::max(one, other));
            };
            clip(box[0].x, box[1].x, origin.x, ray.x);
            clip(box[0].y, box[1].y, origin.y, ray.y);
            clip(box[0].z, box[1].z, origin.z, ray.z);
            entering += enter <= leave ? 1 : 0;
        }
    return static_cast<double>(entering) / (glimpse_size * glimpse_size);
}

} // namespace

std::vector<Aim> framing_views(const TriangleMesh& mesh)
{
    const BoundingSphere sphere = bounding_sphere(mesh);
    const std::array<Double3, 2> box = bounding_box(mesh);
    const Double3 target = (surface_centroid(mesh, sphere) - sphere.centre) * (1 / sphere.radius);
    std::vector<Aim> views;
    for (const Double3 direction : four_directions) {
        Aim best;
        double most = -1;
        for (double radii = frame_start; radii > frame_end; radii *= frame_step) {
            const Aim aim{target + direction * radii, target};
            const Camera camera = aimed_camera(aim, sphere);
            const double hits = Glimpse(mesh, camera).hits();
            const bool is_framed = hits >= framed_hits && box_share(box, camera) >= framed_box;
            if (is_framed || hits > most) best = aim, most = hits;
            if (is_framed) break;
        }
        views.push_back(best);
    }
    return views;
}

namespace {

constexpr std::size_t lattice_views = 1282;

// A point that turns around the y axis by a constant angle, without the machine's sine or cosine.
class Turning {
public:
    Turning(double cosine, double sine) : cosine_(cosine), sine_(sine) {}
    [[nodiscard]] Double3 at(double y) const
    {
        const double r = std::sqrt(std::max(0.0, 1 - y * y));
        return {r * x_, y, r * z_};
    }
    void advance()
    {
        const double x = x_ * cosine_ - z_ * sine_;
        const double z = x_ * sine_ + z_ * cosine_;
        const double norm = std::sqrt(x * x + z * z);
        x_ = x / norm;
        z_ = z / norm;
    }

private:
    double cosine_, sine_;
    double x_ = 1, z_ = 0;
};

Camera look_at(const BoundingSphere& sphere, Double3 direction, double radii)
{
    Camera camera;
    camera.origin = snap_to_grid(to_float(sphere.centre + direction * (radii * sphere.radius)));
    camera.forward = normalized(sphere.centre - to_double(camera.origin));
    const bool steep = std::abs(camera.forward.y) > 0.99;
    camera.right = normalized(cross(camera.forward, steep ? Double3{0, 0, 1} : Double3{0, 1, 0}));
    camera.up = cross(camera.right, camera.forward);
    return camera;
}

std::vector<Camera> smoke(const BoundingSphere& sphere)
{
    std::vector<Camera> cameras;
    for (const Double3 direction : four_directions)
        cameras.push_back(look_at(sphere, direction, 2.0));
    return cameras;
}

std::vector<Camera> frame(const TriangleMesh& mesh, const BoundingSphere& sphere, std::span<const Aim> own)
{
    const std::vector<Aim> fitted = own.empty() ? framing_views(mesh) : std::vector<Aim>();
    std::vector<Camera> cameras;
    for (const Aim& aim : own.empty() ? std::span<const Aim>(fitted) : own)
        cameras.push_back(aimed_camera(aim, sphere));
    return cameras;
}

std::vector<Camera> orbit(const BoundingSphere& sphere)
{
    Turning turning(-0x1.798869e0de833p-1, 0x1.59d9dd253cc13p-1); // the golden angle
    std::vector<Camera> cameras;
    for (std::size_t i = 0; i < lattice_views; ++i, turning.advance()) {
        const double y = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(lattice_views);
        cameras.push_back(look_at(sphere, turning.at(y), 2.0));
    }
    return cameras;
}

std::vector<Camera> flight(const BoundingSphere& sphere)
{
    constexpr double sweeps = 7;                                 // near to far to near
    Turning turning(0x1.fd8ad1927d417p-1, 0x1.90da982df13d1p-4); // 20 turns in 1,282 views
    std::vector<Camera> cameras;
    for (std::size_t i = 0; i < lattice_views; ++i, turning.advance()) {
        const double along = static_cast<double>(i) / static_cast<double>(lattice_views - 1);
        const double phase = sweeps * along - std::floor(sweeps * along);
        const double swing = std::abs(2 * phase - 1);
        cameras.push_back(look_at(sphere, turning.at(0.95 - 1.9 * along), 1.2 + 1.7 * swing));
    }
    return cameras;
}

} // namespace

std::vector<Camera> make_cameras(CameraSet set, const TriangleMesh& mesh, std::span<const Aim> own)
{
    const BoundingSphere sphere = bounding_sphere(mesh);
    switch (set) {
    case CameraSet::frame: return frame(mesh, sphere, own);
    case CameraSet::smoke: return smoke(sphere);
    case CameraSet::orbit: return orbit(sphere);
    case CameraSet::flight: return flight(sphere);
    }
    return {};
}

std::uint64_t hash_of_cameras(std::span<const Camera> cameras)
{
    std::vector<double> numbers;
    for (const Camera& camera : cameras)
        for (const Double3& v : {to_double(camera.origin), camera.forward, camera.right, camera.up})
            for (const double number : {v.x, v.y, v.z})
                numbers.push_back(number + 0.0); // -0 is 0
    return hash_of(numbers);
}

std::size_t view_count(CameraSet set)
{
    return set == CameraSet::frame || set == CameraSet::smoke ? std::size(four_directions) : lattice_views;
}

} // namespace tetrace
