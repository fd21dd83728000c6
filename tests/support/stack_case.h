#pragma once

#include "tests/support/bvh_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/given_scene.h"

#include <cstddef>
#include <vector>

namespace tetrace::test {

/// Rays that fill the stack of a layout's kernels, given to a device, with what openmp answers.
struct StackCase {
    explicit StackCase(Layout layout)
        : kernel{.structure = Structure::bvh, .method = Method::single, .layout = layout, .task = Task::rays},
          full(layout), quads(given_quads_offset(full.rays, full.mesh)),
          job(given_job(full.rays.rays.size(), 0, false)),
          right(answers(*openmp_backend().open(0, kernel, {&full.mesh, &full.packed}, {.threads = 2})))
    {
    }
    /// Of a session with the case's kernel and tree.
    [[nodiscard]] std::size_t wrong_rays(Session& session) const { return different_rays(answers(session), right, 3); }

    KernelId kernel;
    FullStacks full;
    std::vector<Quad> quads;
    TraceJob job;
    std::vector<Hit> right;

private:
    [[nodiscard]] std::vector<Hit> answers(Session& session) const
    {
        session.set_rays(quads);
        return traced(session, job);
    }
};

} // namespace tetrace::test
