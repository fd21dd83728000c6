// Sides of the domain that a ray sees at a grazing angle: rounding can fold them, so that the ray enters and leaves by
// the same side (docs/spec/project.md, P10).
#include "core/mesh/entry_grid.h"
#include "tests/support/project_on_grids.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// The boundary faces that contain a ray.
struct Crossed {
    std::vector<std::uint32_t> entries; ///< half-faces
    std::uint32_t folded = 0;           ///< faces that are seen from their wrong side
};

/// 1 where the ray enters by the face, -1 where it leaves by it, 0 if the face does not contain it.
int crossing(const Grid& grid, std::uint32_t half_face, const right::Ray& ray)
{
    const auto side = [&](std::uint32_t i) {
        const auto corner = [&](std::uint32_t k) {
            return right::vertex(grid.view, half_face >> 2, right::corner(half_face & 3u, k % 3));
        };
        return right::side_at_entry(ray, corner(i), corner(i + 1)) > 0 ? 1 : -1;
    };
    const int sum = side(0) + side(1) + side(2);
    return sum == 3 ? 1 : sum == -3 ? -1 : 0;
}

Crossed crossed_by(const Grid& grid, const Line& line)
{
    const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
    const std::size_t squares = std::size_t{grid.packed.divisions} * grid.packed.divisions;
    Crossed found;
    for (std::uint32_t side = 0; side < 6; ++side) {
        const auto inwards =
            side % 2 == 0 ? line.direction[static_cast<int>(side / 2)] : -line.direction[static_cast<int>(side / 2)];
        const std::size_t list = 6 * squares + side;
        for (auto i = grid.packed.entry_ranges[list]; i < grid.packed.entry_ranges[list + 1]; ++i) {
            const int way = crossing(grid, grid.packed.entry_half_faces[i], ray);
            if (way > 0) found.entries.push_back(grid.packed.entry_half_faces[i]);
            if ((way > 0 && inwards <= 0) || (way < 0 && inwards >= 0)) ++found.folded;
        }
    }
    return found;
}

/// The triangle that the path from a boundary face meets, or NO_HIT.
std::uint32_t met_from(const Grid& grid, std::uint32_t entry, const Line& line)
{
    const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
    for (std::uint32_t half_face = entry; half_face != NO_HALF_FACE;) {
        const std::uint32_t face = right::exit_face(grid.view, half_face >> 2, half_face & 3u, ray);
        const std::uint32_t triangle = right::face_triangle(grid.view, half_face >> 2, face);
        if (triangle != FREE_FACE) return triangle;
        half_face = right::opposite_half_face(grid.view, half_face >> 2, face);
    }
    return NO_HIT;
}

/// Its sides are one square each. Vertices inside a side are up to 0.3 of `cell` from their places in the grid, where
/// is_moved(place).
template <class IsMoved>
Scene with_irregular_sides(Scene scene, float cell, const IsMoved& is_moved)
{
    Random random(68);
    const auto is_on_side = [](float at) { return std::abs(at) == 1; };
    move_vertices(scene, [&](std::uint32_t i) {
        Float3 place = scene.tets.vertices[i];
        if (is_on_side(place.x) + is_on_side(place.y) + is_on_side(place.z) != 1 || !is_moved(place)) return place;
        for (int axis = 0; axis < 3; ++axis)
            if (!is_on_side(place[axis])) place[axis] = snap_to_grid(place[axis] + cell * random.between(-0.3f, 0.3f));
        return place;
    });
    scene.domain.divisions = 1;
    scene.domain.lines = {{{-1, 1}, {-1, 1}, {-1, 1}}};
    return scene;
}

constexpr float tiny = 0x1p-23f, tiny_at = 0.0625f;

/// `cubes` with faces of 2^-23 in the middle of its low z side, not in line.
Scene with_tiny_faces()
{
    const std::vector<float> across{-1, -0.5f, -0.25f, tiny_at - tiny, tiny_at, tiny_at + tiny, 0.5f, 0.75f, 1};
    return with_irregular_sides(grid_of({across, across, even_lines(8, 1)}), tiny,
                                [](Float3 place) { return place.z == -1; });
}

/// From outside, through the tiny faces towards the mesh.
Line line_through_tiny_faces(Random& random)
{
    const auto near = [&] { return snap_to_grid(tiny_at + tiny * random.between(-1, 1)); };
    const Float3 point{near(), near(), -1};
    const Float3 direction = without_small({random.between(-0.25f, 0.25f), random.between(-0.25f, 0.25f), 1});
    const float back = random.between(2, 4);
    return {
        snap_to_grid(Float3{point.x - back * direction.x, point.y - back * direction.y, point.z - back * direction.z}),
        direction};
}

/// Almost in the plane of a side, and into the domain by it near one of its vertices: by 2^-`least` to 2^-`most` of its
/// length.
Line grazing_line(const Grid& grid, Random& random, int least, int most)
{
    const auto& vertices = grid.scene.tets.vertices;
    const Domain& domain = grid.scene.domain;
    for (;;) {
        const Float3 point = vertices[random.below(static_cast<std::uint32_t>(vertices.size()))];
        const auto axis = static_cast<int>(random.below(3));
        const bool low = point[axis] == domain.low()[axis];
        if (!low && point[axis] != domain.high()[axis]) continue;
        const auto small = [&] {
            const auto more = static_cast<int>(random.below(static_cast<std::uint32_t>(most - least)));
            return std::ldexp(random.between(1, 2), -least - 1 - more);
        };
        Float3 direction;
        for (const int other : {(axis + 1) % 3, (axis + 2) % 3})
            direction[other] = random.below(4) == 0 ? small() : random.between(-1, 1);
        direction[axis] = low ? small() : -small();
        direction = without_small(direction);
        const float back = random.between(1, 4);
        return {snap_to_grid(
                    Float3{point.x - back * direction.x, point.y - back * direction.y, point.z - back * direction.z}),
                direction};
    }
}

struct Counts {
    std::uint32_t rays = 0, entered = 0, hits = 0;
    std::uint32_t folded = 0;    ///< rays that see a boundary face from its wrong side
    std::uint32_t several = 0;   ///< rays with several entries
    std::uint32_t differing = 0; ///< whose paths from these lead to different answers
    std::uint32_t wrong = 0;     ///< by exact arithmetic, of those and one ray in 16
};

/// make_line: draws a ray.
template <class MakeLine>
Counts count_folds(const Grid& grid, std::uint32_t number, const MakeLine& make_line)
{
    Counts counts;
    while (counts.rays < number) {
        const Line line = make_line();
        const auto ray = right::make_ray(right::to_vec3(line.origin), right::to_vec3(line.direction));
        if (grid.scene.domain.contains(line.origin)) continue;
        if (right::entry_square(grid.view, ray) == 6 * grid.packed.divisions * grid.packed.divisions) continue;
        ++counts.rays;
        const Crossed crossed = crossed_by(grid, line);
        const std::uint32_t ours = traced(grid, line, NO_TET).face_id;
        counts.hits += ours != NO_HIT;
        counts.entered += !crossed.entries.empty();
        counts.folded += crossed.folded > 0;
        counts.several += crossed.entries.size() > 1;
        bool differs = false;
        for (const std::uint32_t entry : crossed.entries)
            differs = differs || met_from(grid, entry, line) != ours;
        counts.differing += differs;
        if (crossed.folded == 0 && !differs && counts.rays % 16 != 0) continue; // exact arithmetic takes its time
        const std::uint32_t exact = nearest_triangle(grid.scene.mesh, line);
        if (ours == exact) continue;
        const auto settled = grid.settler.settle({line.origin, line.direction}, {}, ours, tie_bound(line.origin));
        counts.wrong += settled.kind == Settlement::Kind::wrong;
    }
    return counts;
}

} // namespace

TEST(ProjectFolds, no_side_of_a_sound_domain_is_folded_at_any_angle)
{
    std::vector<std::unique_ptr<Grid>> sound;
    sound.push_back(std::make_unique<Grid>("regular", grid_of({even_lines(8, 1), even_lines(8, 1), even_lines(8, 1)})));
    sound.push_back(
        std::make_unique<Grid>("irregular", with_irregular_sides(make_cubes(8), 0.25f, [](Float3) { return true; })));
    for (const auto& grid : sound) {
        ASSERT_EQ(find_defect(grid->scene.tets, grid->scene.mesh.triangles.size()), std::nullopt);
        ASSERT_EQ(find_weak_side(grid->scene, make_entry_grid(grid->scene.domain, grid->scene.tets)), "");
        Random random(67);
        const Counts counts = count_folds(*grid, 20'000, [&] { return grazing_line(*grid, random, 0, 20); });
        EXPECT_EQ(counts.folded, 0u) << grid->name;
        EXPECT_EQ(counts.several, 0u) << grid->name;
        EXPECT_EQ(counts.wrong, 0u) << grid->name;
        EXPECT_GT(counts.entered, 10'000u) << grid->name;
        EXPECT_GT(counts.hits, 100u) << grid->name;
    }
}

TEST(ProjectFolds, a_side_with_faces_within_rounding_is_folded_and_refused)
{
    const Grid grid("tiny faces", with_tiny_faces());
    ASSERT_EQ(find_defect(grid.scene.tets, grid.scene.mesh.triangles.size()), std::nullopt);
    EXPECT_NE(find_weak_side(grid.scene, make_entry_grid(grid.scene.domain, grid.scene.tets)).find("has a height of"),
              std::string::npos);
    Random random(69);
    const Counts counts = count_folds(grid, 20'000, [&] { return line_through_tiny_faces(random); });
    EXPECT_GT(counts.folded, 10u);
    EXPECT_GT(counts.several, 10u) << "rays that enter twice, and leave once by the same side";
    EXPECT_GT(counts.wrong, 3u) << "walks that such an exit leads past the mesh";
}
