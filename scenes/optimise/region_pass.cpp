#include "scenes/optimise/region_pass.h"

#include "core/base/stopwatch.h"
#include "scenes/optimise/vertex_move.h"

#include <utility>

namespace tetrace {
namespace {

constexpr std::uint32_t tries_between_looks = 1024; // at clock and limits

} // namespace

RegionPass::RegionPass(MeshArrays arrays, const Orders& orders)
    : orders_(orders), mesh_(std::move(arrays)), edges_(mesh_), collapse_(mesh_), insertion_(mesh_)
{
    mesh_.round = orders.mark;
    insertion_.since = orders.since;
    insertion_.min_ring_area = orders.min_ring_area;
}

bool RegionPass::is_new_tet(std::uint32_t tet) const
{
    return mesh_.is_reached(tet) && mesh_.tet_changed(tet) >= orders_.since;
}

// A face is looked at from the first of its tets that is new.
bool RegionPass::is_new_face(std::uint32_t tet, std::uint32_t face) const
{
    if (!is_new_tet(tet)) return false;
    const std::uint32_t half_face = mesh_.tet(tet).neighbours[face];
    return half_face == NO_HALF_FACE || half_face_tet(half_face) > tet || !is_new_tet(half_face_tet(half_face));
}

bool RegionPass::is_new_vertex(std::uint32_t vertex) const
{
    return mesh_.is_free(vertex) && mesh_.vertex_changed(vertex) >= orders_.since;
}

// try_one(index) returns the gain as an area.
template <class Try>
void RegionPass::sweep(Operation operation, std::uint32_t count, const Try& try_one)
{
    const Stopwatch watch;
    OperationTally& tally = tallies_[operation];
    for (std::uint32_t i = 0; i < count && !ended_; ++i) {
        if (i % tries_between_looks == 0)
            ended_ = !orders_.go_on((sweeps_ + static_cast<double>(i) / count) / (inserts() ? 7 : 6));
        const double gain = ended_ ? 0 : try_one(i);
        if (gain <= 0) continue;
        ++tally.done;
        tally.gain += gain;
    }
    tally.seconds += watch.seconds();
    ++sweeps_;
}

void RegionPass::flip(std::uint32_t since)
{
    orders_.since = edges_.since = since;
    sweep(remove_edges, mesh_.tet_slots() * 6,
          [&](std::uint32_t i) { return is_new_tet(i / 6) ? edges_.try_edge(i / 6, i % 6, orders_.least) : 0.0; });
    sweep(remove_faces, mesh_.tet_slots() * 4, [&](std::uint32_t i) {
        return is_new_face(i / 4, i % 4) ? try_face(mesh_, i / 4, i % 4, orders_.least) : 0.0;
    });
}

MeshArrays RegionPass::run()
{
    const std::uint32_t since = orders_.since;
    flip(since);
    flip(orders_.mark); // what the first did not change would stay again
    orders_.since = since;
    sweep(collapse_edges, mesh_.vertex_slots(),
          [&](std::uint32_t v) { return is_new_vertex(v) ? collapse_.try_vertex(v, orders_.least) : 0.0; });
    sweep(move_vertices, mesh_.vertex_slots(),
          [&](std::uint32_t v) { return is_new_vertex(v) ? try_move(mesh_, v, orders_.least, star_) : 0.0; });
    if (inserts())
        sweep(insert_vertices, mesh_.tet_slots() * 6, [&](std::uint32_t i) {
            return is_new_tet(i / 6) ? insertion_.try_edge(i / 6, i % 6, orders_.least) : 0.0;
        });
    return mesh_.take_arrays();
}

} // namespace tetrace
