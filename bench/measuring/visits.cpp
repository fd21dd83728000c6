#include "bench/measuring/visits.h"

#include "backends/openmp/kernels.h"
#include "bench/rows/ray_store.h"
#include "bench/rows/row_tracing.h"
#include "core/device/host.h"

#include <fmt/format.h>
#include <vector>

namespace tetrace {

namespace {

constexpr unsigned tile_height = 8;

bool is_answer_of(const Hit& counted, const Hit& hit)
{
    return counted.face_id == hit.face_id && counted.t == hit.t && counted.u == hit.u && counted.v == hit.v;
}

openmp::RunFunction* counting_function(const RowKey& key)
{
    return on_reference(key) ? openmp::find_function(openmp::counting_kernels(), key.kernel) : nullptr;
}

/// Visits in place of tet and steps; empty if nothing counts them.
std::vector<std::uint32_t> counted_output(const RowRun& row, std::size_t view, std::span<const Hit> hits,
                                          unsigned threads)
{
    openmp::RunFunction* const count = counting_function(row.key);
    if (count == nullptr) return {};
    SceneWork& scene = *row.scene;
    const PackedScene& packed = row.packed->data;
    std::vector<std::uint32_t> output(hits.size() * HIT_WORDS, POISON);
    const auto rays = row.key.kernel.task == Task::rays
                          ? std::span<const Quad>(scene.given_rays().rows(scene, row.key, &packed, view))
                          : std::span<const Quad>();
    count(packed, rays, job_of(row, view), output, threads, tile_height);
    const std::span<const Hit> counted = as_hits(output);
    for (std::size_t ray = 0; ray < hits.size(); ++ray)
        if (!is_answer_of(counted[ray], hits[ray]))
            throw Error(ErrorKind::internal,
                        fmt::format("ray {} has a different answer when its visits are counted", ray));
    return output;
}

} // namespace

Visits count_visits(const RowRun& row, std::size_t view, std::span<const Hit> hits, unsigned threads)
{
    auto output = counted_output(row, view, hits, threads);
    if (output.empty()) return {};
    Visits visits;
    for (const Hit& counted : as_hits(output)) {
        visits.nodes += counted.tet;
        visits.triangles += counted.steps;
    }
    visits.rays = hits.size();
    return visits;
}

Visits count_visits_of_ray(const RowRun& row, std::size_t view, std::span<const Hit> hits, std::size_t ray,
                           unsigned threads)
{
    auto output = counted_output(row, view, hits, threads);
    if (output.empty()) return {};
    const Hit& counted = as_hits(output)[ray];
    return {1, counted.tet, counted.steps};
}

} // namespace tetrace
