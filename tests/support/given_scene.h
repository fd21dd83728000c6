#pragma once

#include "backends/openmp/backend.h"
#include "core/device/given_quads.h"
#include "core/mesh/locate.h"
#include "core/rays/camera_set.h"
#include "core/rays/ray_set.h"
#include "scenes/procedural.h"

#include <cstdint>
#include <vector>

namespace tetrace::test {

/// A view of the cubes with the reference's hits: what rays are made from.
struct GivenScene {
    Scene scene;
    PackedScene packed;
    std::vector<std::uint32_t> mesh_of_packed;
    TraceJob job;
    std::uint32_t start_tet = NO_TET; ///< numbered as in the scene
    std::vector<Hit> hits;

    /// inside: the camera is in the middle of the ball, else 2 radii away.
    explicit GivenScene(std::uint32_t size = 64, bool inside = false, std::uint32_t resolution = 9,
                        TetOrder order = TetOrder::chains)
        : scene(make_cubes(resolution)), packed(pack(scene, Layout::tet80, order)),
          mesh_of_packed(inverse_of(packed.packed_of_mesh))
    {
        Camera camera = make_cameras(CameraSet::smoke, scene.mesh).front();
        if (inside) camera.origin = {0.03125F, 0.015625F, -0.0078125F};
        job.view = make_view(camera, size, size);
        const Start start = find_start(scene, job.view.origin);
        job.view.origin = start.origin;
        start_tet = start.tet;
        job.start_tet = start.tet == NO_TET ? NO_TET : packed.packed_of_mesh[start.tet];
        job.width = job.height = size;
        job.max_steps = 10'000;
        trace();
    }

    [[nodiscard]] RaySource source(std::uint32_t view_number = 0) const
    {
        return {scene, view_number, job.view, job.width, job.height, start_tet, hits, mesh_of_packed};
    }

    /// What openmp answers to given rays, one by one.
    [[nodiscard]] std::vector<Hit> answers(const RaySet& set, Method method = Method::maria) const
    {
        std::vector<Hit> answers(set.rays.size());
        const auto session =
            openmp_backend().open(0, {.method = method, .task = Task::rays}, {&scene.mesh, &packed}, {.threads = 2});
        session->set_rays(given_quads(set, packed));
        (void)session->trace(given_job(set.rays.size(), packed.tet_count + 1, set.any_hit), answers);
        return answers;
    }

private:
    void trace()
    {
        hits.resize(std::size_t{job.width} * job.height);
        const auto session = openmp_backend().open(0, {}, {&scene.mesh, &packed}, {.threads = 2});
        (void)session->trace(job, hits);
    }
};

} // namespace tetrace::test
