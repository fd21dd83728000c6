#include "bench/browser/met_parts.h"

#include "bench/rows/row_tracing.h"
#include "bench/terminal/progress.h"
#include "core/base/hash.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// Cuts the view's walks off after ever more steps; a walk that is cut off reports the tet that it is in.
void add_met_parts(RowRun& row, std::size_t view, MetParts& met)
{
    std::vector<Hit> hits(ray_count(row, view));
    if (hits.empty()) return;
    TraceJob job = prepare_view(row, view);
    const std::uint32_t most = job.max_steps;
    bool any_cut = true;
    for (std::uint32_t steps = 1; any_cut && steps <= most; ++steps) {
        job.max_steps = steps;
        static_cast<void>(row.session->trace(job, hits));
        any_cut = false;
        for (const Hit& hit : hits) {
            if (hit.tet < met.tets.size()) met.tets[hit.tet] = true;
            if (hit.face_id < met.triangles.size()) met.triangles[hit.face_id] = true;
            any_cut = any_cut || (hit.face_id == LOST && hit.steps >= steps);
        }
    }
}

/// Zeros for the records, of equally many quads each, of what is not kept.
template <class IsKept>
void keep_records(std::vector<Quad>& quads, std::size_t records, const IsKept& is_kept)
{
    const std::size_t length = records == 0 ? 0 : quads.size() / records;
    if (length * records != quads.size()) return;
    for (std::size_t i = 0; i < records; ++i)
        if (!is_kept(i)) std::fill_n(quads.begin() + static_cast<std::ptrdiff_t>(i * length), length, Quad{});
}

/// The mesh's triangle of a record of PackedScene::triangles.
std::size_t triangle_of(const PackedScene& scene, std::size_t record)
{
    return scene.layout == Layout::tet64 ? scene.triangles[record * TRIANGLE_QUADS].w - NORMAL_BIAS : record;
}

PackedScene with_parts(PackedScene scene, const MetParts& met)
{
    keep_records(scene.tets, scene.tet_count, [&](std::size_t tet) { return met.tets[tet]; });
    keep_records(scene.triangles, scene.triangles.size() / TRIANGLE_QUADS, [&](std::size_t record) {
        const std::size_t triangle = triangle_of(scene, record);
        return triangle >= met.triangles.size() || met.triangles[triangle];
    });
    return scene;
}

std::uint64_t hash_of_answers(RowRun& row)
{
    std::vector<std::uint64_t> hashes;
    for (std::size_t view = 0; view < row.scene->views().size(); ++view) {
        std::vector<Hit> hits(ray_count(row, view));
        if (!hits.empty()) static_cast<void>(trace_view(row, view, hits));
        hashes.push_back(hash_of(hits));
    }
    return hash_of(hashes);
}

/// The same rays through another packed scene.
std::uint64_t hash_of_answers(const RowRun& row, const Packed& packed)
{
    RowRun other;
    static_cast<RowRecord&>(other) = row;
    other.scene = row.scene;
    other.backend = row.backend;
    other.packed = &packed;
    other.session = row.backend->open(row.key.device, row.key.kernel, {&row.scene->loaded().scene.mesh, &packed.data},
                                      {.threads = row.scene->threads()});
    return hash_of_answers(other);
}

} // namespace

MetParts met_parts(RowRun& row)
{
    MetParts met{std::vector<bool>(row.packed->data.tet_count),
                 std::vector<bool>(row.scene->loaded().scene.mesh.triangles.size())};
    const std::size_t views = row.scene->views().size();
    for (std::size_t view = 0; view < views; ++view) {
        progress_line().show(fmt::format("finding what rays meet in {}", row.scene->label()),
                             static_cast<double>(view) / static_cast<double>(views));
        add_met_parts(row, view, met);
    }
    return met;
}

PackedScene with_met_parts_only(RowRun& row)
{
    const PackedScene& whole = row.packed->data;
    if (row.key.kernel.structure != Structure::cdt || !traits_of(row.key.kernel.task).finds_hits) return whole;
    const Packed trimmed{with_parts(whole, met_parts(row)), 0, std::nullopt, {}};
    return hash_of_answers(row, trimmed) == hash_of_answers(row) ? trimmed.data : whole;
}

} // namespace tetrace
