#include "core/rays/camera_set.h"

#include "core/base/exact.h"
#include "core/base/hash.h"
#include "core/rays/framing.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tetrace {
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
