// The walk of project: no ray is lost, from outside, from inside, or given, and its answers are right.
#include "core/device/given_quads.h"
#include "core/mesh/locate.h"
#include "tests/support/device_rays.h"
#include "tests/support/hard_rays.h"
#include "tests/support/project_on_grids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Whether the ray enters by the face.
bool holds(const Grid& grid, std::uint32_t half_face, const right::Ray& ray)
{
    const auto corner = [&](std::uint32_t i) {
        return right::vertex(grid.view, half_face >> 2, right::corner(half_face & 3u, i));
    };
    return right::side_at_entry(ray, corner(0), corner(1)) > 0 && right::side_at_entry(ray, corner(1), corner(2)) > 0 &&
           right::side_at_entry(ray, corner(2), corner(0)) > 0;
}

// Whether a domain's squares are equally wide: true of all scenes but some of the tests'.
bool has_even_lines(const Grid& grid)
{
    return std::ranges::all_of(grid.scene.domain.lines, [](const std::vector<float>& lines) {
        const double width = (double{lines.back()} - lines.front()) / static_cast<double>(lines.size() - 1);
        for (std::size_t i = 0; i < lines.size(); ++i)
            if (std::abs(lines.front() + width * static_cast<double>(i) - lines[i]) > 0x1p-20) return false;
        return true;
    });
}

} // namespace

TEST(ProjectWalk, loses_no_ray_from_outside_and_no_ray_from_a_vertex_an_edge_or_a_face)
{
    Random random(62);
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

TEST(ProjectWalk, loses_no_ray_that_is_given_and_never_hits_the_face_that_it_starts_on)
{
    std::uint64_t elsewhere = 0, from_beginning = 0, beyond = 0;
    for (const auto& grid : grids()) {
        const auto set = hard_ray_set(grid->scene, 0, 9 * 800);
        const auto quads = given_quads(set, grid->packed);
        sought = {};
        for (std::size_t i = 0; i < set.rays.size(); ++i) {
            const auto hit =
                right::trace_given(grid->view, params_of(*grid, NO_TET), quads[i], quads[set.rays.size() + i]);
            ASSERT_NE(hit.face_id, LOST) << grid->name << ", ray " << i;
            if (set.rays[i].triangle != FREE_FACE) {
                ASSERT_NE(hit.face_id, set.rays[i].triangle) << grid->name << ", ray " << i;
            }
            if (quads[i].w == NO_HALF_FACE) continue;
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

TEST(ProjectWalk, stays_lost_at_a_small_cap_where_it_is_on_no_cycle)
{
    Random random(66);
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
            const Hit hit = to_hit(right::trace(grid.view, params, ray));
            ASSERT_EQ(hit.face_id, LOST) << "ray " << i << ", cap " << cap;
            ASSERT_EQ(hit.steps, cap);
            ++lost;
        }
    }
    EXPECT_GT(lost, 500);
}

TEST(ProjectWalk, is_right_by_exact_arithmetic_or_within_rounding_of_an_edge)
{
    Random random(63);
    for (const auto& grid : grids()) {
        int hits = 0, ties = 0;
        for (int i = 0; i < 200; ++i) {
            const Line line = from_outside(*grid, line_through(*grid, special_point(*grid, random), random));
            if (!is_in_range(line)) continue;
            const std::uint32_t ours = traced(*grid, line, NO_TET).face_id;
            const std::uint32_t exact = nearest_triangle(grid->scene.mesh, line);
            hits += exact != NO_HIT;
            if (ours == exact) continue;
            const auto settled = grid->settler.settle({line.origin, line.direction}, {}, ours, tie_bound(line.origin));
            ties += settled.kind == Settlement::Kind::tie;
            EXPECT_NE(settled.kind, Settlement::Kind::wrong)
                << grid->name << ", ray " << i << ": " << settled.reason << ", ours " << ours << ", exact " << exact;
        }
        EXPECT_GT(hits, 25) << grid->name;
    }
}

TEST(ProjectWalk, enters_by_a_face_anywhere_or_misses_where_the_square_has_none)
{
    // Along lines of the domain's own squares and edges: the look-up's square and the signs may differ there.
    Random random(64);
    sought = {};
    for (const auto& grid : grids()) {
        const auto& lines = grid->scene.domain.lines;
        const auto at = [&](std::size_t axis) {
            return lines[axis][random.below(static_cast<std::uint32_t>(lines[axis].size()))];
        };
        for (int i = 0; i < 300; ++i) {
            const Float3 from{2 * at(0), 2 * at(1), 3}, to{at(0), at(1), at(2)};
            const Line line{from, without_small({to.x - from.x, to.y - from.y, to.z - from.z})};
            const Hit hit = traced(*grid, line, NO_TET);
            ASSERT_NE(hit.face_id, LOST) << grid->name << ", ray " << i;
        }
    }
    EXPECT_GT(sought[0], 0u) << "rays whose square lacks a face that holds them";
}

TEST(ProjectWalk, asks_a_square_within_rounding_of_where_the_ray_meets_the_domain)
{
    Random random(66);
    int met = 0, missed = 0;
    for (const auto& grid : grids()) {
        if (!has_even_lines(*grid)) continue;
        const auto& lines = grid->scene.domain.lines;
        const std::uint32_t n = grid->packed.divisions;
        for (int i = 0; i < 2000; ++i) {
            const Float3 origin = random.point(-3, 3), to = random.point(-1.5f, 1.5f);
            if (grid->scene.domain.contains(origin)) continue;
            const Float3 u = without_small({to.x - origin.x, to.y - origin.y, to.z - origin.z});
            const auto ray = right::make_ray(right::to_vec3(origin), right::to_vec3(u));
            // By double precision: the side whose plane the ray meets last, and how far inside it that is.
            std::size_t across = 3;
            double entered_at = 0, left_at = HUGE_VAL;
            for (int axis = 0; axis < 3; ++axis) {
                const auto& of_axis = lines[static_cast<std::size_t>(axis)];
                const auto [near, far] = std::minmax({(of_axis.front() - double{origin[axis]}) / u[axis],
                                                      (of_axis.back() - double{origin[axis]}) / u[axis]});
                if (near > entered_at) across = static_cast<std::size_t>(axis);
                entered_at = std::max(entered_at, near);
                left_at = std::min(left_at, far);
            }
            if (std::abs(left_at - entered_at) < 1e-5) continue; // rounding may tell
            const std::uint32_t square = right::entry_square(grid->view, ray);
            ASSERT_EQ(square == 6 * n * n, left_at < entered_at) << grid->name << ", ray " << i;
            ++(left_at < entered_at ? missed : met);
            if (left_at < entered_at) continue;
            ASSERT_EQ(square / (n * n), 2 * across + (u[static_cast<int>(across)] < 0 ? 1 : 0));
            const std::uint32_t column = square % n, row = square / n % n;
            for (const auto& [axis, line] : {std::pair{(across + 1) % 3, column}, std::pair{(across + 2) % 3, row}}) {
                const auto point = origin[static_cast<int>(axis)] + entered_at * u[static_cast<int>(axis)];
                EXPECT_GT(point, lines[axis][line] - 0x1p-17) << grid->name << ", ray " << i;
                EXPECT_LT(point, lines[axis][line + 1] + 0x1p-17) << grid->name << ", ray " << i;
            }
        }
    }
    EXPECT_GT(met, 1000);
    EXPECT_GT(missed, 1000);
}

TEST(ProjectWalk, passes_over_no_boundary_face_that_it_enters_by)
{
    // At lines and corners of the domain's squares, and past them by a unit in the last place.
    Random random(65);
    std::uint32_t entered = 0, missed = 0;
    for (const auto& grid : grids()) {
        const auto& lines = grid->scene.domain.lines;
        const auto at = [&](std::size_t axis) {
            return lines[axis][random.below(static_cast<std::uint32_t>(lines[axis].size()))];
        };
        for (int i = 0; i < 500; ++i) {
            Float3 from{2 * at(0), 2 * at(1), 2 * at(2)}, to{at(0), at(1), at(2)};
            if (random.below(2) == 0) to = special_point(*grid, random);
            const auto axis = static_cast<int>(random.below(3));
            to[axis] = std::nextafter(to[axis], random.below(2) == 0 ? -8.0f : 8.0f);
            const Line line = {snap_to_grid(from), without_small({to.x - from.x, to.y - from.y, to.z - from.z})};
            if (grid->scene.domain.contains(line.origin) || line.direction == Float3{}) continue;
            const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
            std::uint32_t first = grid->packed.entry_ranges[grid->packed.entry_ranges.size() - 7]; // of all sides
            const auto faces = static_cast<std::uint32_t>(grid->packed.entry_half_faces.size());
            while (first < faces && right::depth_in(right::entry_face(grid->view, first), ray) < 0)
                ++first;
            ASSERT_EQ(right::entry_anywhere(grid->view, ray, 0, 0), first == faces ? NO_ENTRY : first)
                << grid->name << ", ray " << i;
            ++(first == faces ? missed : entered);
        }
    }
    EXPECT_GT(entered, 500u);
    EXPECT_GT(missed, 50u);
}

TEST(ProjectWalk, has_the_same_bits_on_openmp_and_cuda_host_where_rays_pass_vertices_and_edges)
{
    const Scene& scene = grids().front()->scene;
    const KernelId kernel{.method = Method::project};
    const auto packed = pack(scene, kernel.layout, TetOrder::chains);
    TraceJob job;
    job.view = {{0.25f, 0, 3}, {-1, -1, -2}, {0.125f, 0, 0}, {0, 0.125f, 0}};
    job.width = job.height = 17;
    job.start_tet = NO_TET;
    job.max_steps = step_cap(packed.tet_count, {});
    std::vector<std::vector<Hit>> answers;
    for (Backend* backend : all_backends())
        if (backend->name() == "openmp" || backend->name() == "cuda-host")
            answers.push_back(traced(*backend->open(0, kernel, {&scene.mesh, &packed}, {.threads = 2}), job));
    ASSERT_EQ(answers.size(), 2u);
    EXPECT_EQ(different_rays(answers[0], answers[1], 0), 0u);
    EXPECT_GT(std::count_if(answers[0].begin(), answers[0].end(),
                            [](const Hit& hit) { return hit.face_id != NO_HIT && hit.face_id != LOST; }),
              20);
}
