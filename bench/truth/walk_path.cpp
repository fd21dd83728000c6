#include "bench/truth/walk_path.h"

#include <algorithm>

namespace tetrace {
namespace {

// The direction that the kernels make for the pixel, bit for bit: the same sums in the same order, in float.
float direction_component(float corner, float step_x, float step_y, std::uint32_t x, std::uint32_t y)
{
    return corner + step_x * static_cast<float>(x) + step_y * static_cast<float>(y);
}

} // namespace

TraceJob single_pixel(TraceJob job, std::uint32_t x, std::uint32_t y)
{
    for (int axis = 0; axis < 3; ++axis)
        job.view.corner[axis] =
            direction_component(job.view.corner[axis], job.view.step_x[axis], job.view.step_y[axis], x, y);
    job.width = job.height = 1;
    return job;
}

std::vector<std::uint32_t> walk_path(const Hit& last, std::uint32_t max_steps,
                                     const std::function<Hit(std::uint32_t cap)>& trace, std::uint32_t most)
{
    std::vector<std::uint32_t> path;
    const std::uint32_t steps = std::min(last.steps, max_steps); // a faulty device may report any number
    for (std::uint32_t cap = 1; cap < steps && path.size() < most; ++cap)
        path.push_back(trace(cap).tet);
    if (last.tet != NO_TET && path.size() < most) path.push_back(last.tet);
    return path;
}

std::vector<std::uint32_t> walk_path(Session& session, const TraceJob& job, std::uint32_t x, std::uint32_t y,
                                     std::uint32_t most)
{
    TraceJob pixel = single_pixel(job, x, y);
    const auto trace = [&](std::uint32_t cap) {
        Hit hit{};
        pixel.max_steps = cap;
        static_cast<void>(session.trace(pixel, {&hit, 1}));
        return hit;
    };
    return walk_path(trace(job.max_steps), job.max_steps, trace, most);
}

std::vector<std::uint32_t> walk_path(const PackedScene& packed, const KernelId& kernel, const TraceJob& job,
                                     std::uint32_t x, std::uint32_t y)
{
    const auto session = reference_backend().open(0, kernel, {nullptr, &packed}, {.threads = 1});
    return walk_path(*session, job, x, y, job.max_steps);
}

} // namespace tetrace
