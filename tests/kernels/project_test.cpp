// What is built to break a walk by projected signs: grids, rays through their vertices, edges and faces, cameras on
// them, thin and stretched tets.
#include "bench/truth/settle.h"
#include "core/device/backend.h"
#include "core/mesh/locate.h"
#include "core/rays/ray_offset.h"
#include "tests/support/device_rays.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace {

using tetrace::Float3;
using tetrace::test::different_rays;
using tetrace::test::traced;

std::array<std::uint64_t, 3> decided{}; // signs by level: float products, what they lost, the order of the vertices
#define COUNT_SIGN(level) (++decided[level])
std::array<std::uint64_t, 3> sought{}; // see COUNT_SEARCH in kernels/walks/entry_on_path.h
#define COUNT_SEARCH(where) (++sought[where])

#define KERNEL_STRUCTURE_HEADER "kernels/walks/structure_cdt.h"
#define KERNEL_ARRAYS_HEADER "kernels/layouts/cdt_arrays.h"
#define KERNEL_LAYOUT_HEADER "kernels/layouts/tet96.h"
#define KERNEL_METHOD_HEADER "kernels/methods/project.h"
namespace right {
#include "kernels/kernel_cpp.h"
}
#undef SIDE_AT_TIE
#define SIDE_AT_TIE(p, q, p_is_first, product) false // "not positive", in whichever direction the edge is asked for
namespace mutant {
#include "kernels/kernel_cpp.h"
}

struct Grid {
    const char* name;
    tetrace::Scene scene;
    tetrace::PackedScene packed = tetrace::pack(scene, tetrace::Layout::tet96, tetrace::TetOrder::hilbert);
    right::SceneView view = right::view_of(packed);
    mutant::SceneView mutant_view = mutant::view_of(packed);
    tetrace::Settler settler{scene.mesh};

    Grid(const char* title, tetrace::Scene made) : name(title), scene(std::move(made)) {}
    Grid(const Grid&) = delete;
};

const std::vector<std::unique_ptr<Grid>>& grids()
{
    static const auto made = [] {
        std::vector<std::unique_ptr<Grid>> list;
        for (auto& [name, scene] : tetrace::test::make_hard_scenes())
            list.push_back(std::make_unique<Grid>(name, std::move(scene)));
        return list;
    }();
    return made;
}

struct Line {
    Float3 origin, direction;
};

Float3 along(Float3 a, Float3 b, float t)
{
    return tetrace::snap_to_grid(Float3{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)});
}

/// A vertex, the middle of an edge, or a point of a face of some tet.
Float3 special_point(const Grid& grid, tetrace::test::Random& random)
{
    const auto& mesh = grid.scene.tets;
    const auto& tet = mesh.tets[random.below(static_cast<std::uint32_t>(mesh.tets.size()))];
    const Float3 a = mesh.vertices[tet.vertices[0]], b = mesh.vertices[tet.vertices[1]],
                 c = mesh.vertices[tet.vertices[2]];
    switch (random.below(3)) {
    case 0: return a;
    case 1: return along(a, b, 0.5f);
    default: return along(along(a, b, 0.5f), c, 0.5f);
    }
}

Float3 without_small(Float3 direction)
{
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(direction[axis]) < 0x1p-20f) direction[axis] = 0;
    return direction;
}

/// Through two special points, or one and along an axis or a diagonal; never the zero vector.
Line line_through(const Grid& grid, Float3 point, tetrace::test::Random& random)
{
    for (;;) {
        Float3 direction;
        if (random.below(2) == 0) {
            for (int axis = 0; axis < 3; ++axis)
                direction[axis] = static_cast<float>(random.below(3)) - 1.0f;
        } else {
            const Float3 other = special_point(grid, random);
            direction = without_small({other.x - point.x, other.y - point.y, other.z - point.z});
        }
        if (direction.x != 0 || direction.y != 0 || direction.z != 0) return {point, direction};
    }
}

/// Moved back along its direction until it starts outside the domain: by powers of two, which mostly keeps it exact.
Line from_outside(const Grid& grid, Line line)
{
    for (float back = 1; grid.scene.domain.contains(line.origin); back *= 2)
        line.origin = tetrace::snap_to_grid(Float3{line.origin.x - back * line.direction.x,
                                                   line.origin.y - back * line.direction.y,
                                                   line.origin.z - back * line.direction.z});
    return line;
}

bool is_in_range(const Line& line)
{
    return std::max({std::abs(line.origin.x), std::abs(line.origin.y), std::abs(line.origin.z)}) <= 4;
}

/// Faces of a tet that hold the ray: how many a ray enters by, and leaves by.
struct Held {
    int entered = 0, left = 0;
};
template <class Side>
Held faces_that_hold(const tetrace::TetMesh& mesh, const tetrace::Tet& tet, const Side& side)
{
    Held held;
    for (std::uint32_t face = 0; face < 4; ++face) {
        const auto v = [&](std::uint32_t i) { return mesh.vertices[tet.vertices[right::corner(face, i)]]; };
        const float ab = side(v(0), v(1)), bc = side(v(1), v(2)), ca = side(v(2), v(0));
        held.entered += ab > 0 && bc > 0 && ca > 0;
        held.left += ab < 0 && bc < 0 && ca < 0;
    }
    return held;
}

/// Tets of the grid in which a ray does not have either no face, or one to enter and one to leave by.
template <class Side>
int torn_tets(const Grid& grid, const Side& side)
{
    int torn = 0;
    for (const tetrace::Tet& tet : grid.scene.tets.tets) {
        const Held held = faces_that_hold(grid.scene.tets, tet, side);
        torn += held.entered != held.left || held.entered > 1;
    }
    return torn;
}

tetrace::Hit to_hit(const right::Hit& hit)
{
    return {hit.face_id, hit.tet, hit.t, hit.u, hit.v, hit.steps};
}

right::TraceParams params_of(const Grid& grid, std::uint32_t start_tet)
{
    right::TraceParams params{};
    params.start_tet = start_tet;
    params.max_steps = grid.packed.tet_count + 1; // more than there are tets: who gets there goes in circles
    return params;
}

tetrace::Hit traced(const Grid& grid, const Line& line, std::uint32_t start_tet)
{
    const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
    return to_hit(right::trace(grid.view, params_of(grid, start_tet), ray));
}

/// Whether the ray enters by the face.
bool holds(const Grid& grid, std::uint32_t link, const right::Ray& ray)
{
    const auto corner = [&](std::uint32_t i) {
        return right::vertex(grid.view, link >> 2, right::corner(link & 3u, i));
    };
    return right::side_at_entry(ray, corner(0), corner(1)) > 0 && right::side_at_entry(ray, corner(1), corner(2)) > 0 &&
           right::side_at_entry(ray, corner(2), corner(0)) > 0;
}

/// The nearest triangle that the exact ray meets.
std::uint32_t nearest_triangle(const tetrace::TriangleMesh& mesh, const Line& line)
{
    std::uint32_t nearest = NO_HIT;
    double t = HUGE_VAL;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        const auto crossing =
            tetrace::cross_exactly(line.origin, line.direction, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
        if (!crossing.met || crossing.t >= t) continue;
        nearest = i;
        t = crossing.t;
    }
    return nearest;
}

} // namespace

TEST(Project, the_grids_are_meshes_without_a_defect)
{
    for (const auto& grid : grids()) {
        const auto defect = find_defect(grid->scene.tets, grid->scene.mesh.triangles.size());
        EXPECT_FALSE(defect.has_value()) << grid->name << ": " << (defect ? defect->what : "");
    }
}

TEST(Project, every_tet_has_no_face_that_holds_the_ray_or_one_to_enter_and_one_to_leave_by)
{
    tetrace::test::Random random(60);
    for (const auto& grid : grids())
        for (int i = 0; i < 20; ++i) {
            const Line line = line_through(*grid, special_point(*grid, random), random);
            const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
            const auto side = [&](Float3 a, Float3 b) {
                return right::side_at_entry(ray, right::to_vec3(a), right::to_vec3(b));
            };
            ASSERT_EQ(torn_tets(*grid, side), 0) << grid->name << ", ray " << i;
        }
}

TEST(Project, without_the_rule_for_ties_tets_are_torn)
{
    tetrace::test::Random random(60); // the same rays
    for (const auto& grid : grids()) {
        int torn = 0;
        for (int i = 0; i < 20; ++i) {
            const Line line = line_through(*grid, special_point(*grid, random), random);
            const auto ray = mutant::make_ray(mutant::to_vec3(line.origin), mutant::to_vec3(line.direction));
            torn += torn_tets(*grid, [&](Float3 a, Float3 b) {
                return mutant::side_at_entry(ray, mutant::to_vec3(a), mutant::to_vec3(b));
            });
        }
        EXPECT_GT(torn, 0) << grid->name;
    }
}

TEST(Project, each_level_of_a_sign_decides_some)
{
    tetrace::test::Random random(61);
    decided = {};
    for (const auto& grid : grids())
        for (int i = 0; i < 1500; ++i) {
            const Line line = from_outside(*grid, line_through(*grid, special_point(*grid, random), random));
            (void)traced(*grid, line, NO_TET);
        }
    for (const std::uint64_t count : decided)
        EXPECT_GT(count, 0u);
    RecordProperty("by_products", std::to_string(decided[0]));
    RecordProperty("by_what_they_lost", std::to_string(decided[1]));
    RecordProperty("by_order", std::to_string(decided[2]));
}

TEST(Project, loses_no_ray_from_outside_and_no_ray_from_a_vertex_an_edge_or_a_face)
{
    tetrace::test::Random random(62);
    for (const auto& grid : grids()) {
        int elsewhere = 0;
        for (int i = 0; i < 1500; ++i) {
            const Line inside = line_through(*grid, special_point(*grid, random), random);
            const Line outside = from_outside(*grid, inside);
            ASSERT_NE(traced(*grid, outside, NO_TET).face_id, LOST) << grid->name << ", ray " << i;
            const std::uint32_t tet = grid->packed.packed_of_mesh[locate(grid->scene.tets, inside.origin)];
            const auto ray = right::make_ray(right::to_vec3(inside.origin), right::to_vec3(inside.direction));
            elsewhere += right::start_face(grid->view, tet, ray) == NO_EXIT;
            ASSERT_NE(traced(*grid, inside, tet).face_id, LOST) << grid->name << ", ray " << i;
        }
        EXPECT_GT(elsewhere, 150) << grid->name << ": starts whose tet the ray does not cross";
    }
}

TEST(Project, loses_no_ray_that_is_given_and_never_hits_the_face_that_it_starts_on)
{
    std::uint64_t elsewhere = 0, from_beginning = 0, beyond = 0;
    for (const auto& grid : grids()) {
        const auto set = tetrace::test::hard_ray_set(grid->scene, 0, 9 * 800);
        const auto quads = given_quads(set, grid->packed);
        sought = {};
        for (std::size_t i = 0; i < set.rays.size(); ++i) {
            const auto hit =
                right::trace_given(grid->view, params_of(*grid, NO_TET), quads[i], quads[set.rays.size() + i]);
            ASSERT_NE(hit.face_id, LOST) << grid->name << ", ray " << i;
            if (set.rays[i].triangle != FREE_FACE) {
                ASSERT_NE(hit.face_id, set.rays[i].triangle) << grid->name << ", ray " << i;
            }
            if (quads[i].w == NO_LINK) continue;
            const auto ray = right::given_ray(quads[i], quads[set.rays.size() + i]);
            elsewhere += !holds(*grid, quads[i].w, ray);
        }
        from_beginning += sought[1];
        beyond += sought[2];
        EXPECT_GT(sought[1], 100u) << grid->name;
    }
    EXPECT_GT(elsewhere, from_beginning + beyond) << "starts whose face does not hold the rounded ray";
    EXPECT_GT(beyond, 0u);
    RecordProperty("starts_elsewhere", std::to_string(elsewhere));
    RecordProperty("starts_from_the_beginning", std::to_string(from_beginning));
    RecordProperty("starts_beyond", std::to_string(beyond));
}

namespace {

/// Of a ray's path from the boundary.
std::uint32_t tets_on_path(const Grid& grid, const right::Ray& ray)
{
    std::uint32_t count = 0;
    const std::uint32_t entry = right::entry_anywhere(grid.view, ray, 0, 0);
    for (std::uint32_t link = entry == NO_ENTRY ? NO_LINK : grid.packed.entry_links[entry]; link != NO_LINK; ++count)
        link = right::face_link(grid.view, link >> 2, right::exit_face(grid.view, link >> 2, link & 3u, ray));
    return count;
}

/// How far a point is from the nearest of the planes of a tet's faces, negative where it is outside.
double clearance(const tetrace::TetMesh& mesh, std::uint32_t tet, Float3 point)
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

/// How many steps after it leaves a tet that it crosses a ray enters it again; 0 where it never does.
std::uint32_t cycle_length(const Grid& grid, const right::Ray& ray, std::uint32_t tet)
{
    std::uint32_t link = right::face_link(grid.view, tet, right::start_face(grid.view, tet, ray));
    for (std::uint32_t steps = 1; link != NO_LINK; ++steps) {
        if (link >> 2 == tet) return steps;
        link = right::face_link(grid.view, link >> 2, right::exit_face(grid.view, link >> 2, link & 3u, ray));
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
        const std::uint32_t link = right::face_link(grid.view, at, face);
        at = link >> 2;
        face = right::exit_face(grid.view, at, link & 3u, ray);
    }
    return length > 0;
}

/// A ray in a tet, as the mesh numbers it, from which it goes in circles.
struct CyclicStart {
    Line line;
    std::uint32_t tet;
};

/// Of so many rays and all tets that they cross.
std::vector<CyclicStart> cyclic_starts(const Grid& grid, std::uint64_t rays)
{
    const tetrace::test::HardRays hard(grid.scene);
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

bool is_usable(const tetrace::Backend& backend, std::size_t device)
{
    return backend.devices()[device].usable && backend.name() != "embree";
}

/// What rays from a cyclic start meet: its own, and others from the same tet towards pixels beside it.
std::vector<tetrace::Hit> hits_from(tetrace::Session& session, const Grid& grid, const tetrace::PackedScene& packed,
                                    const std::vector<CyclicStart>& starts)
{
    std::vector<tetrace::Hit> all;
    for (const CyclicStart& start : starts) {
        tetrace::TraceJob job;
        job.view = {start.line.origin, start.line.direction, {0x1p-9f, 0, 0x1p-11f}, {0, 0x1p-9f, 0x1p-11f}};
        job.width = 8;
        job.height = 2;
        job.max_steps = packed.tet_count + 1;
        start_in(job, packed, grid.scene, start.tet);
        const auto hits = traced(session, job);
        all.insert(all.end(), hits.begin(), hits.end());
    }
    return all;
}

/// The same rays, given, each by a face of its tet, among others.
tetrace::RaySet given_among_others(const Grid& grid, const std::vector<CyclicStart>& starts)
{
    const auto count = (3 * starts.size() + TILE_WIDTH - 1) / TILE_WIDTH * TILE_WIDTH;
    tetrace::RaySet set = tetrace::test::hard_ray_set(grid.scene, 0, count);
    for (std::size_t i = 0; i < starts.size(); ++i) {
        tetrace::GivenRay& ray = set.rays[3 * i];
        ray.origin = starts[i].line.origin;
        ray.direction = starts[i].line.direction;
        ray.end = NO_END;
        ray.link = tetrace::make_link(starts[i].tet, static_cast<std::uint32_t>(i % 4));
    }
    return set;
}

std::vector<tetrace::Hit> hits_of_given(tetrace::Session& session, const tetrace::PackedScene& packed,
                                        const tetrace::RaySet& set)
{
    session.set_rays(given_quads(set, packed));
    return traced(session, tetrace::given_job(set.rays.size(), packed.tet_count + 1, false));
}

bool any_is_lost(const std::vector<tetrace::Hit>& hits)
{
    return std::any_of(hits.begin(), hits.end(), [](const tetrace::Hit& hit) { return hit.face_id == LOST; });
}

} // namespace

TEST(Project, goes_in_circles_only_from_tets_within_rounding_and_then_begins_anew)
{
    const Grid grid("cluster", tetrace::test::cluster_of(0x1p-24f));
    EXPECT_FALSE(find_defect(grid.scene.tets, grid.scene.mesh.triangles.size()));
    const tetrace::test::HardRays rays(grid.scene);
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
            const tetrace::Hit hit = traced(grid, line, tet);
            ASSERT_NE(hit.face_id, LOST) << "ray " << number;
            const bool anew = is_lost_without_beginning_anew(grid, ray, tet); // else a triangle lies on the cycle
            ASSERT_EQ(sought[1], anew ? 1u : 0u) << "ray " << number;
            if (!anew) continue;
            ++begun_anew;
            ASSERT_LE(hit.steps, tets_on_path(grid, ray)) << "ray " << number;
            const std::uint32_t exact = nearest_triangle(grid.scene.mesh, line);
            hits += exact != NO_HIT;
            if (hit.face_id == exact) continue;
            const auto settled =
                grid.settler.settle({line.origin, line.direction}, hit.face_id, exact, tetrace::tie_bound(line.origin));
            EXPECT_NE(settled.kind, tetrace::Settlement::Kind::wrong)
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

TEST(Project, begins_anew_with_the_same_bits_on_every_layout_and_device)
{
    const Grid grid("cluster", tetrace::test::cluster_of(0x1p-24f));
    const auto starts = cyclic_starts(grid, 1000);
    ASSERT_GT(starts.size(), 10u);
    using tetrace::Layout;
    std::vector<tetrace::Hit> expected;
    for (const Layout layout : {Layout::tet96, Layout::tet80, Layout::half32, Layout::tet20, Layout::tet16}) {
        const auto packed = tetrace::pack(grid.scene, layout, tetrace::TetOrder::hilbert);
        const tetrace::KernelId kernel{.method = tetrace::Method::project, .layout = layout};
        for (tetrace::Backend* backend : tetrace::all_backends())
            for (std::size_t device = 0; device < backend->devices().size(); ++device) {
                if (!is_usable(*backend, device)) continue;
                const auto session = backend->open(device, kernel, {&grid.scene.mesh, &packed}, {.threads = 2});
                const auto hits = hits_from(*session, grid, packed, starts);
                EXPECT_FALSE(any_is_lost(hits)) << backend->name() << ' ' << name_of(layout);
                if (expected.empty()) expected = hits;
                EXPECT_EQ(different_rays(hits, expected, 3), 0u) << backend->name() << ' ' << name_of(layout);
            }
    }
}

TEST(Project, begins_given_rays_anew_with_the_same_bits_on_every_layout_and_device)
{
    const Grid grid("cluster", tetrace::test::cluster_of(0x1p-24f));
    const auto starts = cyclic_starts(grid, 1000);
    const tetrace::RaySet set = given_among_others(grid, starts);
    using tetrace::Layout;
    std::vector<tetrace::Hit> expected;
    for (const Layout layout : {Layout::tet96, Layout::tet80, Layout::half32}) {
        const auto packed = tetrace::pack(grid.scene, layout, tetrace::TetOrder::hilbert);
        for (const tetrace::Schedule schedule : {tetrace::Schedule{}, tetrace::Schedule::packets}) {
            const tetrace::KernelId kernel{.method = tetrace::Method::project,
                                           .layout = layout,
                                           .schedule = schedule,
                                           .task = tetrace::Task::rays};
            for (tetrace::Backend* backend : tetrace::all_backends())
                for (std::size_t device = 0; device < backend->devices().size(); ++device) {
                    const bool has_packets = backend->name() == "openmp" && layout == Layout::half32;
                    if (schedule == tetrace::Schedule::packets && !has_packets) continue;
                    if (!is_usable(*backend, device)) continue;
                    const auto session = backend->open(device, kernel, {&grid.scene.mesh, &packed}, {.threads = 2});
                    const auto hits = hits_of_given(*session, packed, set);
                    EXPECT_FALSE(any_is_lost(hits)) << backend->name() << ' ' << name_of(layout);
                    if (expected.empty()) expected = hits;
                    EXPECT_EQ(different_rays(hits, expected, 3), 0u) << backend->name() << ' ' << name_of(layout);
                }
        }
    }
}

TEST(Project, stays_lost_at_a_small_cap_where_it_is_on_no_cycle)
{
    tetrace::test::Random random(66);
    const Grid& grid = *grids().front();
    int lost = 0;
    for (int i = 0; i < 500; ++i) {
        const Line line = line_through(grid, special_point(grid, random), random);
        const std::uint32_t tet = grid.packed.packed_of_mesh[locate(grid.scene.tets, line.origin)];
        const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
        if (right::start_face(grid.view, tet, ray) == NO_EXIT) continue;
        const std::uint32_t steps = traced(grid, line, tet).steps;
        for (std::uint32_t cap = 1; cap < steps; ++cap) {
            auto params = params_of(grid, tet);
            params.max_steps = cap;
            const tetrace::Hit hit = to_hit(right::trace(grid.view, params, ray));
            ASSERT_EQ(hit.face_id, LOST) << "ray " << i << ", cap " << cap;
            ASSERT_EQ(hit.steps, cap);
            ++lost;
        }
    }
    EXPECT_GT(lost, 500);
}

TEST(Project, is_on_its_path_where_it_starts_in_a_tet_by_more_than_the_bound)
{
    const Grid grid("cluster", tetrace::test::cluster_of(0x1p-24f));
    const tetrace::test::HardRays rays(grid.scene);
    int starts = 0, through_cluster = 0;
    for (std::uint64_t number = 0; number < 60'000; ++number) {
        const auto given = rays.ray(number);
        if (rays.kind_of(number) != tetrace::test::HardKind::from_inside) continue;
        const std::uint32_t tet = given.link >> 2;
        if (clearance(grid.scene.tets, tet, given.origin) <= tetrace::tie_bound(given.origin)) continue;
        ++starts;
        const auto ray = right::make_ray(right::to_vec3(given.origin), right::to_vec3(given.direction));
        ASSERT_NE(right::start_face(grid.view, grid.packed.packed_of_mesh[tet], ray), NO_EXIT) << "ray " << number;
        ASSERT_EQ(cycle_length(grid, ray, grid.packed.packed_of_mesh[tet]), 0u) << "ray " << number;
        through_cluster += tets_on_path(grid, ray) > 20;
    }
    EXPECT_GT(starts, 200);
    EXPECT_GT(through_cluster, 100);
}

TEST(Project, is_right_by_exact_arithmetic_or_within_rounding_of_an_edge)
{
    tetrace::test::Random random(63);
    for (const auto& grid : grids()) {
        int hits = 0, ties = 0;
        for (int i = 0; i < 200; ++i) {
            const Line line = from_outside(*grid, line_through(*grid, special_point(*grid, random), random));
            if (!is_in_range(line)) continue;
            const std::uint32_t ours = traced(*grid, line, NO_TET).face_id;
            const std::uint32_t exact = nearest_triangle(grid->scene.mesh, line);
            hits += exact != NO_HIT;
            if (ours == exact) continue;
            const auto settled =
                grid->settler.settle({line.origin, line.direction}, ours, exact, tetrace::tie_bound(line.origin));
            ties += settled.kind == tetrace::Settlement::Kind::tie;
            EXPECT_NE(settled.kind, tetrace::Settlement::Kind::wrong)
                << grid->name << ", ray " << i << ": " << settled.reason << ", ours " << ours << ", exact " << exact;
        }
        EXPECT_GT(hits, 25) << grid->name;
    }
}

TEST(Project, enters_by_a_face_anywhere_or_misses_where_the_square_has_none)
{
    // Along lines of the domain's own squares and edges, where the look-up's square and the signs may differ.
    tetrace::test::Random random(64);
    sought = {};
    for (const auto& grid : grids()) {
        const auto& lines = grid->scene.domain.lines;
        const auto at = [&](std::size_t axis) {
            return lines[axis][random.below(static_cast<std::uint32_t>(lines[axis].size()))];
        };
        for (int i = 0; i < 300; ++i) {
            const Float3 from{2 * at(0), 2 * at(1), 3}, to{at(0), at(1), at(2)};
            const Line line{from, without_small({to.x - from.x, to.y - from.y, to.z - from.z})};
            const tetrace::Hit hit = traced(*grid, line, NO_TET);
            ASSERT_NE(hit.face_id, LOST) << grid->name << ", ray " << i;
        }
    }
    EXPECT_GT(sought[0], 0u) << "rays whose square has no face that holds them";
}

TEST(Project, has_the_same_bits_on_openmp_and_cuda_host_where_rays_pass_vertices_and_edges)
{
    const tetrace::Scene& scene = grids().front()->scene;
    const tetrace::KernelId kernel{.method = tetrace::Method::project};
    const auto packed = tetrace::pack(scene, kernel.layout, tetrace::TetOrder::hilbert);
    tetrace::TraceJob job;
    job.view = {{0.25f, 0, 3}, {-1, -1, -2}, {0.125f, 0, 0}, {0, 0.125f, 0}};
    job.width = job.height = 17;
    job.start_tet = NO_TET;
    job.max_steps = packed.tet_count + 1;
    std::vector<std::vector<tetrace::Hit>> answers;
    for (tetrace::Backend* backend : tetrace::all_backends())
        if (backend->name() == "openmp" || backend->name() == "cuda-host")
            answers.push_back(traced(*backend->open(0, kernel, {&scene.mesh, &packed}, {.threads = 2}), job));
    ASSERT_EQ(answers.size(), 2u);
    EXPECT_EQ(different_rays(answers[0], answers[1], 0), 0u);
    EXPECT_GT(std::count_if(answers[0].begin(), answers[0].end(),
                            [](const tetrace::Hit& hit) { return hit.face_id != NO_HIT && hit.face_id != LOST; }),
              20);
}
