#pragma once

#include "backends/openmp/backend.h"
#include "core/base/exact.h"
#include "core/mesh/locate.h"
#include "core/rays/camera_set.h"
#include "scenes/procedural.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace tetrace::test {

/// Runs a case's body on each usable device of a backend; visibly skipped where there is none.
class UsableDevices : public ::testing::Test {
protected:
    explicit UsableDevices(Backend& tested) : backend(tested) {}
    void SetUp() override
    {
        for (std::size_t i = 0; i < backend.devices().size(); ++i)
            if (backend.devices()[i].usable) usable.push_back(i);
        if (usable.empty()) GTEST_SKIP() << backend.devices().front().reason;
    }

    Backend& backend;
    std::vector<std::size_t> usable;
};

/// A packed scene and jobs on it, for tests that trace on devices.
class DeviceRays {
public:
    DeviceRays(const Scene& scene, Layout layout)
        : scene_(scene), packed_(pack(scene, layout, TetOrder::chains)), sphere_(bounding_sphere(scene.mesh))
    {
    }
    [[nodiscard]] const PackedScene& packed() const { return packed_; }
    [[nodiscard]] SceneData data() const { return {nullptr, &packed_}; }
    [[nodiscard]] Layout layout() const { return packed_.layout; }

    /// From 2 radii away, outside the domain.
    [[nodiscard]] TraceJob from_outside(std::uint32_t width, std::uint32_t height, std::size_t view = 1) const
    {
        return job(make_cameras(CameraSet::smoke, scene_.mesh).at(view), width, height);
    }
    /// From near the middle of the scene: rays start in the tet that holds the camera.
    [[nodiscard]] TraceJob from_inside(std::uint32_t width, std::uint32_t height) const
    {
        Camera camera = make_cameras(CameraSet::smoke, scene_.mesh).front();
        camera.origin = {static_cast<float>(sphere_.centre.x + 0.0078125), static_cast<float>(sphere_.centre.y),
                         static_cast<float>(sphere_.centre.z - 0.0078125)};
        return job(camera, width, height);
    }

private:
    [[nodiscard]] TraceJob job(const Camera& camera, std::uint32_t width, std::uint32_t height) const
    {
        TraceJob job;
        job.view = make_view(camera, width, height);
        job.width = width;
        job.height = height;
        const Start start = find_start(scene_, job.view.origin);
        job.view.origin = start.origin;
        start_in(job, packed_, scene_, start.tet);
        job.max_steps = 10'000;
        return job;
    }

    Scene scene_;
    PackedScene packed_;
    BoundingSphere sphere_;
};

/// Images that are, and are not, multiples of a tile; cameras outside and inside.
[[nodiscard]] inline std::vector<TraceJob> jobs_of_all_kinds(const DeviceRays& rays)
{
    return {rays.from_outside(64, 64), rays.from_outside(61, 35),   rays.from_outside(7, 3),
            rays.from_inside(40, 24),  rays.from_outside(1, 1),     rays.from_inside(33, 50),
            rays.from_outside(200, 1), rays.from_outside(5, 90, 3), rays.from_outside(64, 64, 2)};
}

/// On the lines of a regular grid: rays pass its vertices and edges, and more than one in ten meets a tie.
[[nodiscard]] inline TraceJob along_lines(std::uint32_t width, std::uint32_t height, Float3 origin)
{
    TraceJob job;
    job.view = {origin, {-1, -1, -2}, {0.125f, 0, 0}, {0, 0.125f, 0}};
    job.width = width;
    job.height = height;
    job.max_steps = 10'000;
    return job;
}

/// Rays that enter the same grid of 8 cubes a side between its lines, and meet ties at edges inside it.
[[nodiscard]] inline TraceJob between_lines(std::uint32_t width, std::uint32_t height)
{
    return along_lines(width, height, {0.03125f, 0.0625f, 3});
}

/// The hits of one launch, job after job.
[[nodiscard]] inline std::vector<Hit> traced(Session& session, std::span<const TraceJob> jobs)
{
    std::size_t rays = 0;
    for (const TraceJob& job : jobs)
        rays += job.rays();
    std::vector<Hit> hits(rays);
    (void)session.trace(jobs, hits);
    return hits;
}
[[nodiscard]] inline std::vector<Hit> traced(Session& session, const TraceJob& job)
{
    return traced(session, std::span(&job, 1));
}

/// What the job gives in exact mode on the host.
[[nodiscard]] inline std::vector<Hit> openmp_hits(const DeviceRays& rays, const TraceJob& job)
{
    const auto session = openmp_backend().open(0, {.layout = rays.layout()}, rays.data(), {.threads = 2});
    return traced(*session, job);
}

/// Rays that are decided differently, or whose t, u or v differ by more than that many units in the last place.
[[nodiscard]] inline std::size_t different_rays(const std::vector<Hit>& a, const std::vector<Hit>& b,
                                                std::uint64_t allowed_ulps)
{
    if (a.size() != b.size()) return std::max(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool decided = a[i].face_id == b[i].face_id && a[i].tet == b[i].tet && a[i].steps == b[i].steps;
        const std::uint64_t ulps =
            std::max({ulps_between(a[i].t, b[i].t), ulps_between(a[i].u, b[i].u), ulps_between(a[i].v, b[i].v)});
        if (!decided || ulps > allowed_ulps) ++count;
    }
    return count;
}

/// Rays of math mode fast that cannot be explained by rounding: another face, or a t that is further than 1e-4 of
/// itself away (walks of some ten steps in a scene of size 1, with contraction and approximate division).
[[nodiscard]] inline std::size_t distant_rays(const std::vector<Hit>& a, const std::vector<Hit>& b)
{
    if (a.size() != b.size()) return std::max(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].face_id != b[i].face_id || !(std::fabs(a[i].t - b[i].t) <= 1e-4F * std::fabs(b[i].t))) ++count;
    return count;
}

} // namespace tetrace::test
