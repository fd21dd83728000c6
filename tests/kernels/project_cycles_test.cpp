// Cycles of project: tets off the ray's path that its signs join in a circle, and the walk that begins anew there.
#include "bench/truth/tally.h"
#include "core/device/given_quads.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/device_rays.h"
#include "tests/support/hard_rays.h"
#include "tests/support/project_on_grids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// More than a walk makes before it asks whether it goes in circles, and no more than any device can do.
constexpr std::uint32_t many_steps = 20'000;

/// Of a ray's path from the boundary.
std::uint32_t tets_on_path(const Grid& grid, const right::Ray& ray)
{
    std::uint32_t count = 0;
    const std::uint32_t entry = right::entry_anywhere(grid.view, ray, 0, 0);
    for (std::uint32_t half_face = entry == NO_ENTRY ? NO_HALF_FACE : grid.packed.entry_half_faces[entry];
         half_face != NO_HALF_FACE; ++count)
        half_face = right::opposite_half_face(grid.view, half_face >> 2,
                                              right::exit_face(grid.view, half_face >> 2, half_face & 3u, ray));
    return count;
}

/// How far a point is from the nearest of the planes of a tet's faces, negative where it is outside.
double clearance(const TetMesh& mesh, std::uint32_t tet, Float3 point)
{
    double least = HUGE_VAL;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const auto at = [&](std::uint32_t i) {
            return to_double(mesh.vertices[mesh.tets[tet].vertices[i < 3 ? right::corner(face, i) : face]]);
        };
        const auto normal = normalized(cross(at(1) - at(0), at(2) - at(0)));
        const double apex = dot(normal, at(3) - at(0)), height = dot(normal, to_double(point) - at(0));
        least = std::min(least, apex < 0 ? -height : height);
    }
    return least;
}

/// How many steps after it leaves a tet that it crosses a ray enters it again; 0 if it never does.
std::uint32_t cycle_length(const Grid& grid, const right::Ray& ray, std::uint32_t tet)
{
    std::uint32_t half_face = right::opposite_half_face(grid.view, tet, right::start_face(grid.view, tet, ray));
    for (std::uint32_t steps = 1; half_face != NO_HALF_FACE; ++steps) {
        if (half_face >> 2 == tet) return steps;
        half_face = right::opposite_half_face(grid.view, half_face >> 2,
                                              right::exit_face(grid.view, half_face >> 2, half_face & 3u, ray));
    }
    return 0;
}

/// Whether a walk that leaves a tet goes in circles and meets no triangle there.
bool is_lost_without_beginning_anew(const Grid& grid, const right::Ray& ray, std::uint32_t tet)
{
    const std::uint32_t length = cycle_length(grid, ray, tet);
    std::uint32_t at = tet, face = right::start_face(grid.view, tet, ray);
    for (std::uint32_t steps = 0; steps < length; ++steps) {
        if (right::face_triangle(grid.view, at, face) != FREE_FACE) return false;
        const std::uint32_t half_face = right::opposite_half_face(grid.view, at, face);
        at = half_face >> 2;
        face = right::exit_face(grid.view, at, half_face & 3u, ray);
    }
    return length > 0;
}

/// A ray in a tet, as the mesh numbers it, from which it goes in circles.
struct CyclicStart {
    Line line;
    std::uint32_t tet;
};

/// Of that many rays and all tets that they cross.
std::vector<CyclicStart> cyclic_starts(const Grid& grid, std::uint64_t rays)
{
    const HardRays hard(grid.scene);
    std::vector<CyclicStart> starts;
    for (std::uint64_t number = 0; number < rays; ++number) {
        const auto given = hard.ray(number);
        const auto ray = right::make_ray(right::to_vec3(given.origin), right::to_vec3(given.direction));
        for (std::uint32_t tet = 0; tet < grid.packed.tet_count; ++tet) {
            const std::uint32_t packed = grid.packed.packed_of_mesh[tet];
            if (right::start_face(grid.view, packed, ray) == NO_EXIT) continue;
            if (is_lost_without_beginning_anew(grid, ray, packed))
                starts.push_back({{given.origin, given.direction}, tet});
        }
    }
    return starts;
}

bool is_usable(const Backend& backend, std::size_t device)
{
    return backend.devices()[device].usable && backend.name() != "embree";
}

/// What rays from a cyclic start meet: its own, and others from the same tet towards neighbouring pixels.
std::vector<Hit> hits_from(Session& session, const Grid& grid, const PackedScene& packed,
                           const std::vector<CyclicStart>& starts)
{
    std::vector<Hit> all;
    for (const CyclicStart& start : starts) {
        TraceJob job;
        job.view = {start.line.origin, start.line.direction, {0x1p-9f, 0, 0x1p-11f}, {0, 0x1p-9f, 0x1p-11f}};
        job.width = 8;
        job.height = 2;
        job.max_steps = many_steps;
        start_in(job, packed, grid.scene, start.tet);
        const auto hits = traced(session, job);
        all.insert(all.end(), hits.begin(), hits.end());
    }
    return all;
}

/// The same rays, given, each by a face of its tet, among others.
RaySet given_among_others(const Grid& grid, const std::vector<CyclicStart>& starts)
{
    const auto count = (3 * starts.size() + TILE_WIDTH - 1) / TILE_WIDTH * TILE_WIDTH;
    RaySet set = hard_ray_set(grid.scene, 0, count);
    for (std::size_t i = 0; i < starts.size(); ++i) {
        GivenRay& ray = set.rays[3 * i];
        ray.origin = starts[i].line.origin;
        ray.direction = starts[i].line.direction;
        ray.end = NO_END;
        ray.half_face = make_half_face(starts[i].tet, static_cast<std::uint32_t>(i % 4));
    }
    return set;
}

std::vector<Hit> hits_of_given(Session& session, const PackedScene& packed, const RaySet& set)
{
    session.set_rays(given_quads(set, packed));
    return traced(session, given_job(set.rays.size(), many_steps, false));
}

bool any_is_lost(const std::vector<Hit>& hits)
{
    return std::any_of(hits.begin(), hits.end(), [](const Hit& hit) { return hit.face_id == LOST; });
}

/// On every device that has the kernel, no ray is lost and the hits are those of the first that was asked, kept in
/// `expected`. hits_of: what is traced in a session.
void expect_same_hits(const KernelId& kernel, const Grid& grid, const PackedScene& packed,
                      const std::function<std::vector<Hit>(Session&)>& hits_of, std::vector<Hit>& expected)
{
    const bool is_openmps = kernel.schedule == Schedule::packets;
    for (Backend* backend : all_backends())
        for (std::size_t device = 0; device < backend->devices().size(); ++device) {
            if (!is_usable(*backend, device) || (is_openmps && backend->name() != "openmp")) continue;
            const auto session = backend->open(device, kernel, {&grid.scene.mesh, &packed}, {.threads = 2});
            const auto hits = hits_of(*session);
            EXPECT_FALSE(any_is_lost(hits)) << backend->name() << ' ' << name_of(kernel.layout);
            if (expected.empty()) expected = hits;
            EXPECT_EQ(different_rays(hits, expected, 3), 0u) << backend->name() << ' ' << name_of(kernel.layout);
        }
}

} // namespace

TEST(ProjectCycles, goes_in_circles_only_from_tets_within_rounding_and_then_begins_anew)
{
    const Grid grid("cluster", cluster_of(0x1p-24f));
    EXPECT_FALSE(find_defect(grid.scene.tets, grid.scene.mesh.triangles.size()));
    const HardRays rays(grid.scene);
    std::uint32_t on_cycles = 0, longest = 0, begun_anew = 0, hits = 0;
    for (std::uint64_t number = 0; number < 3000; ++number) {
        const auto given = rays.ray(number);
        const Line line{given.origin, given.direction};
        const auto ray = right::make_ray(right::to_vec3(given.origin), right::to_vec3(given.direction));
        std::uint32_t crossed = 0, cyclic = 0;
        for (std::uint32_t tet = 0; tet < grid.packed.tet_count; ++tet) {
            if (right::start_face(grid.view, tet, ray) == NO_EXIT) continue;
            ++crossed;
            const std::uint32_t length = cycle_length(grid, ray, tet);
            longest = std::max(longest, length);
            if (length == 0) continue;
            ++cyclic;
            sought = {};
            const Hit hit = traced(grid, line, tet);
            ASSERT_NE(hit.face_id, LOST) << "ray " << number;
            const bool anew = is_lost_without_beginning_anew(grid, ray, tet); // else a triangle is on the cycle
            ASSERT_EQ(sought[1], anew ? 1u : 0u) << "ray " << number;
            if (!anew) continue;
            ++begun_anew;
            ASSERT_LE(hit.steps, tets_on_path(grid, ray)) << "ray " << number;
            const std::uint32_t exact = nearest_triangle(grid.scene.mesh, line);
            hits += exact != NO_HIT;
            if (hit.face_id == exact) continue;
            const auto settled =
                grid.settler.settle({line.origin, line.direction}, {}, hit.face_id, tie_bound(line.origin));
            EXPECT_NE(settled.kind, Settlement::Kind::wrong)
                << "ray " << number << ": " << settled.reason << ", ours " << hit.face_id << ", exact " << exact;
        }
        ASSERT_EQ(crossed, tets_on_path(grid, ray) + cyclic) << "ray " << number;
        on_cycles += cyclic;
    }
    EXPECT_GT(on_cycles, 50u);
    EXPECT_GT(begun_anew, 20u);
    EXPECT_GT(hits, 0u);
    RecordProperty("tets_on_cycles", std::to_string(on_cycles));
    RecordProperty("longest_cycle", std::to_string(longest));
    RecordProperty("begun_anew", std::to_string(begun_anew));
    RecordProperty("hits", std::to_string(hits));
}

TEST(ProjectCycles, finds_a_cycle_long_before_its_cap)
{
    const Grid grid("cluster", cluster_of(0x1p-24f));
    const auto starts = cyclic_starts(grid, 1000);
    ASSERT_GT(starts.size(), 10u);
    for (const CyclicStart& start : starts) {
        const std::uint32_t tet = grid.packed.packed_of_mesh[start.tet];
        auto params = params_of(grid, tet);
        params.max_steps = 0xFFFFFFFF; // these would take minutes
        const auto ray = right::make_ray(right::to_vec3(start.line.origin), right::to_vec3(start.line.direction));
        const Hit hit = to_hit(right::trace(grid.view, params, ray));
        const Hit at_cap = traced(grid, start.line, tet);
        EXPECT_EQ(hit.face_id, at_cap.face_id);
        EXPECT_EQ(hit.tet, at_cap.tet);
        EXPECT_EQ(hit.steps, at_cap.steps);
    }
}

TEST(ProjectCycles, is_on_its_path_where_it_starts_in_a_tet_by_more_than_the_bound)
{
    const Grid grid("cluster", cluster_of(0x1p-24f));
    const HardRays rays(grid.scene);
    int starts = 0, through_cluster = 0;
    for (std::uint64_t number = 0; number < 60'000; ++number) {
        const auto given = rays.ray(number);
        if (rays.kind_of(number) != HardKind::from_inside) continue;
        const std::uint32_t tet = given.half_face >> 2;
        if (clearance(grid.scene.tets, tet, given.origin) <= tie_bound(given.origin)) continue;
        ++starts;
        const auto ray = right::make_ray(right::to_vec3(given.origin), right::to_vec3(given.direction));
        ASSERT_NE(right::start_face(grid.view, grid.packed.packed_of_mesh[tet], ray), NO_EXIT) << "ray " << number;
        ASSERT_EQ(cycle_length(grid, ray, grid.packed.packed_of_mesh[tet]), 0u) << "ray " << number;
        through_cluster += tets_on_path(grid, ray) > 20;
    }
    EXPECT_GT(starts, 200);
    EXPECT_GT(through_cluster, 100);
}

TEST(ProjectCycles, begins_anew_with_the_same_bits_on_every_layout_and_device)
{
    const Grid grid("cluster", cluster_of(0x1p-24f));
    const auto starts = cyclic_starts(grid, 1000);
    ASSERT_GT(starts.size(), 10u);
    std::vector<Hit> expected;
    for (const Layout layout :
         {Layout::tet96, Layout::tet80, Layout::half32, Layout::tet64, Layout::tet20, Layout::tet16}) {
        const auto packed = pack(grid.scene, layout, TetOrder::chains);
        const auto hits_of = [&](Session& session) { return hits_from(session, grid, packed, starts); };
        expect_same_hits({.method = Method::project, .layout = layout}, grid, packed, hits_of, expected);
    }
}

TEST(ProjectCycles, begins_given_rays_anew_with_the_same_bits_on_every_layout_and_device)
{
    const Grid grid("cluster", cluster_of(0x1p-24f));
    const auto starts = cyclic_starts(grid, 1000);
    const RaySet set = given_among_others(grid, starts);
    std::vector<Hit> expected;
    for (const Layout layout : {Layout::tet96, Layout::tet80, Layout::half32, Layout::tet64}) {
        const auto packed = pack(grid.scene, layout, TetOrder::chains);
        const auto hits_of = [&](Session& session) { return hits_of_given(session, packed, set); };
        KernelId kernel{.method = Method::project, .layout = layout, .task = Task::rays};
        expect_same_hits(kernel, grid, packed, hits_of, expected);
        if (layout != Layout::half32) continue; // the only one with packets
        kernel.schedule = Schedule::packets;
        expect_same_hits(kernel, grid, packed, hits_of, expected);
    }
}

TEST(ProjectCycles, leave_nothing_in_the_sums_of_a_tally)
{
    const Grid grid("cluster", cluster_of(0x1p-24f));
    const RaySet set = given_among_others(grid, cyclic_starts(grid, 3000));
    const CrossedScene tets(grid.scene, Method::project, Layout::half32, Task::tally);
    const auto quads = segment_quads(set, tets.packed());
    openmp::NoteFunction* const note = openmp::find_note_function(tets.kernel());
    const auto expected = tally_of_walks(
        set.rays.size(), tets.packed().tet_count,
        [&](std::size_t ray) {
            openmp::Crossings noted;
            note(tets.packed(), false, quads[ray], quads[set.rays.size() + ray], many_steps, noted);
            return CrossedTets{std::move(noted.tets), std::move(noted.places)};
        },
        2);
    for (Backend* backend : all_backends())
        for (std::size_t device = 0; device < backend->devices().size(); ++device) {
            if (!is_usable(*backend, device)) continue;
            for (const Schedule schedule : {Schedule::tiles, Schedule::packets}) {
                KernelId kernel = tets.kernel();
                kernel.schedule = schedule;
                if (!backend->has_kernel(kernel)) continue;
                const auto session = backend->open(device, kernel, {&grid.scene.mesh, &tets.packed()}, {.threads = 2});
                session->set_rays(quads);
                std::vector<Hit> answers(set.rays.size());
                static_cast<void>(session->trace(given_job(set.rays.size(), many_steps, false), answers));
                EXPECT_FALSE(any_is_lost(answers)) << backend->name() << ' ' << name_of(schedule);
                EXPECT_EQ(session->tally(), expected) << backend->name() << ' ' << name_of(schedule);
            }
        }
}
