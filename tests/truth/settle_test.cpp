#include "bench/truth/settle.h"

#include "bench/truth/hit_point.h"

#include <gtest/gtest.h>

using namespace tetrace;

namespace {

using Kind = Settlement::Kind;
constexpr double bound = 1e-6;
constexpr float e = 0x1p-22f; // 2.4e-7, well within the bound

struct Settled {
    explicit Settled(TriangleMesh triangles) : mesh(std::move(triangles)) {}
    Settled(const Settled&) = delete;

    [[nodiscard]] Settlement along(const ExactRay& ray, std::uint32_t answer, const RayPart& part = {}) const
    {
        return settler.settle(ray, part, answer, bound);
    }
    /// A ray from (x, y, 1) downwards.
    [[nodiscard]] Kind at(float x, float y, std::uint32_t answer) const
    {
        return along({{x, y, 1}, {0, 0, -1}}, answer).kind;
    }

    TriangleMesh mesh;
    ExactSearch search{mesh};
    Settler settler{mesh, search};
};

/// A square in z = 0 as two triangles that share the diagonal from (0,0) to (1,1); after it, at z = -1, a larger one.
const Settled squares({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-4, -4, -1}, {8, -4, -1}, {-4, 8, -1}},
                       {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}});
constexpr std::uint32_t lower = 0, upper = 1, behind = 2;

/// Triangles of that shape at these heights, each wide around the origin but ending at x = `right`.
TriangleMesh layers(std::initializer_list<std::pair<float, float>> heights_and_right)
{
    TriangleMesh mesh;
    for (const auto& [z, right] : heights_and_right) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {{right, -4, z}, {right, 4, z}, {-4, 0, z}});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

/// The same scene seen in a mirror: x and -x exchanged, so that all triangles turn round.
TriangleMesh mirrored(TriangleMesh mesh)
{
    for (Float3& vertex : mesh.vertices)
        vertex.x = -vertex.x;
    return mesh;
}

} // namespace

TEST(Settle, what_the_exact_ray_meets_first_is_exact)
{
    EXPECT_EQ(squares.at(0.75f, 0.25f, lower), Kind::exact);
    EXPECT_EQ(squares.at(-1, -1, behind), Kind::exact);
    EXPECT_EQ(squares.at(0.5f, 0.5f, lower), Kind::exact) << "on the edge of both";
    EXPECT_EQ(squares.at(0.5f, 0.5f, upper), Kind::exact) << "on the edge of both";
    EXPECT_EQ(squares.at(-5, -5, NO_HIT), Kind::exact);
    EXPECT_EQ(squares.along({{0.75f, 0.25f, 1}, {0, 0, -1}}, behind).first, lower);
}

TEST(Settle, either_side_of_a_shared_edge_is_a_tie_within_the_bound)
{
    const Settlement tie = squares.along({{0.5f + e, 0.5f, 1}, {0, 0, -1}}, upper);
    EXPECT_EQ(tie.kind, Kind::tie);
    EXPECT_GE(tie.distance, 0x1p-22 / 1.41421357) << "a witness crosses the edge";
    EXPECT_LE(tie.distance, bound);
    EXPECT_GE(tie.witness.size(), 2u);
}

TEST(Settle, outside_the_bound_the_wrong_side_of_a_shared_edge_is_wrong)
{
    EXPECT_EQ(squares.at(0.5f + 0x1p-18f, 0.5f, upper), Kind::wrong);
    EXPECT_EQ(squares.at(0.75f, 0.25f, upper), Kind::wrong);
}

TEST(Settle, slipping_past_a_silhouette_is_a_tie)
{
    EXPECT_EQ(squares.at(1 - e, 0.5f, behind), Kind::tie);
    EXPECT_EQ(squares.at(1 + e, 0.5f, lower), Kind::tie);
    EXPECT_EQ(squares.at(1 - 0x1p-18f, 0.5f, behind), Kind::wrong);
    EXPECT_EQ(squares.at(1 + 0x1p-18f, 0.5f, lower), Kind::wrong);
}

TEST(Settle, slipping_between_two_triangles_that_continue_each_other_is_wrong)
{
    EXPECT_EQ(squares.at(0.5f, 0.5f, behind), Kind::wrong) << "on the shared edge itself";
    EXPECT_EQ(squares.at(0.5f + e, 0.5f, NO_HIT), Kind::wrong);
}

TEST(Settle, a_miss_past_a_silhouette_is_a_tie_and_through_a_triangle_is_wrong)
{
    const Settled one({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    EXPECT_EQ(one.at(0.25f, e, NO_HIT), Kind::tie);
    EXPECT_EQ(one.at(0.25f, 0.25f, NO_HIT), Kind::wrong);
    EXPECT_EQ(one.at(0.25f, -e, NO_HIT), Kind::exact);
}

TEST(Settle, a_fold_is_a_silhouette)
{
    // Two triangles on one edge, both to its left as seen from above.
    const Settled fold({{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, 0, -1}}, {{0, 1, 2}, {0, 1, 3}}});
    EXPECT_EQ(fold.at(-e, 0.25f, NO_HIT), Kind::tie);
    EXPECT_EQ(fold.at(-0.25f, 0.25f, 1), Kind::wrong) << "it hides the lower one";
}

TEST(Settle, a_miss_inside_a_silhouette_is_wrong_if_a_solid_triangle_follows)
{
    EXPECT_EQ(squares.at(1 - e, 0.5f, NO_HIT), Kind::wrong);
    EXPECT_EQ(squares.at(1 + e, 0.5f, NO_HIT), Kind::wrong);
    const Settled mirror(mirrored(squares.mesh));
    EXPECT_EQ(mirror.at(-1 + e, 0.5f, NO_HIT), Kind::wrong);
    EXPECT_EQ(mirror.at(-1 - e, 0.5f, NO_HIT), Kind::wrong);
}

TEST(Settle, a_triangle_two_layers_back_is_wrong_where_the_layer_between_is_solid)
{
    const TriangleMesh three = layers({{0, e}, {-1, 4}, {-2, 4}});
    const Settled solid(three), mirror(mirrored(three));
    EXPECT_EQ(solid.at(0, 0, 0), Kind::exact);
    EXPECT_EQ(solid.at(0, 0, 1), Kind::tie) << "past the silhouette of the first";
    EXPECT_EQ(solid.at(0, 0, 2), Kind::wrong);
    EXPECT_EQ(mirror.at(0, 0, 1), Kind::tie);
    EXPECT_EQ(mirror.at(0, 0, 2), Kind::wrong);
}

TEST(Settle, a_triangle_after_two_silhouettes_is_a_tie_even_if_no_straight_ray_passes_both)
{
    // The first layer ends to the right of the ray, the second begins there, and they overlap as seen from above: a
    // curve passes the first on the right, and the second on the left.
    TriangleMesh mesh = layers({{0, e}, {-2, 4}});
    mesh.vertices.insert(mesh.vertices.end(), {{-e, -4, -1}, {-e, 4, -1}, {4, 0, -1}});
    mesh.triangles.push_back({6, 7, 8});
    const Settled overlapping(mesh), mirror(mirrored(mesh));
    const Settlement tie = overlapping.along({{0, 0, 1}, {0, 0, -1}}, 1);
    EXPECT_EQ(tie.kind, Kind::tie);
    EXPECT_GT(tie.witness.size(), 3u) << "it bends between the layers";
    EXPECT_EQ(mirror.at(0, 0, 1), Kind::tie);

    // If the second layer's edge is out of reach, so is everything after it.
    for (const std::uint32_t v : {6u, 7u})
        mesh.vertices[v].x = -0x1p-18f;
    EXPECT_EQ(Settled(mesh).at(0, 0, 1), Kind::wrong);
}

TEST(Settle, layers_that_touch_leave_no_way_between_them)
{
    // As above, but the second layer hangs on the first one's edge: a pocket.
    TriangleMesh mesh = layers({{0, e}, {-2, 4}});
    mesh.vertices.insert(mesh.vertices.end(), {{-4, 0, -1}});
    mesh.triangles.push_back({0, 1, 6});
    EXPECT_EQ(Settled(mesh).at(0, 0, 1), Kind::tie) << "round both";
    mesh.vertices.insert(mesh.vertices.end(), {{4, 0, -1}});
    mesh.triangles.push_back({0, 1, 7});
    EXPECT_EQ(Settled(mesh).at(0, 0, 1), Kind::wrong) << "between both";
    EXPECT_EQ(Settled(mirrored(mesh)).at(0, 0, 1), Kind::wrong);
}

TEST(Settle, a_triangle_that_is_seen_edge_on_does_not_hide_what_lies_before_it)
{
    // Edge-on in the plane x = 0, one unit after a solid triangle whose interior the ray meets.
    TriangleMesh mesh = layers({{0, 4}});
    mesh.vertices.insert(mesh.vertices.end(), {{0, -1, -2}, {0, 1, -2}, {0, 0, -1}});
    mesh.triangles.push_back({3, 4, 5});
    for (const TriangleMesh& seen : {mesh, mirrored(mesh)}) {
        const Settled solid(seen);
        EXPECT_EQ(solid.at(0, 0, 0), Kind::exact);
        EXPECT_EQ(solid.at(0, 0, 1), Kind::wrong);
        EXPECT_EQ(solid.at(e, 0, 1), Kind::wrong);
    }
}

TEST(Settle, a_triangle_that_is_seen_edge_on_may_be_met_or_passed)
{
    // Edge-on in the plane x = 0, with a solid triangle after it.
    TriangleMesh mesh = layers({{-2, 4}});
    mesh.vertices.insert(mesh.vertices.end(), {{0, -1, -1}, {0, 1, -1}, {0, 0, 0}});
    mesh.triangles.push_back({3, 4, 5});
    const Settled wall(mesh);
    for (const float x : {-e, 0.0f, e}) {
        EXPECT_EQ(wall.at(x, 0, 1), Kind::tie) << x;
        EXPECT_EQ(wall.at(x, 0, 0), x == 0 ? Kind::tie : Kind::exact) << x;
        EXPECT_EQ(wall.at(x, 0, NO_HIT), Kind::wrong) << x;
    }
    EXPECT_EQ(wall.at(0x1p-18f, 0, 1), Kind::wrong);
}

TEST(Settle, a_curve_does_not_go_back)
{
    // A triangle that rises along the ray, met from one side only by going back.
    TriangleMesh mesh = layers({{0, 4}, {-1, 4}});
    const Settled two(mesh);
    EXPECT_EQ(two.at(0, 0, 1), Kind::wrong);
    EXPECT_EQ(two.along({{0, 0, -0.5f}, {0, 0, -1}}, 0).kind, Kind::wrong) << "before the origin";
    EXPECT_EQ(two.along({{0, 0, -0.5f}, {0, 0, -1}}, 1).kind, Kind::exact);
}

TEST(Settle, a_part_that_starts_on_a_triangle_begins_within_the_bound_and_leaves_that_one_out)
{
    const Settled two(layers({{0, 4}, {-e, 4}, {-1, 4}}));
    const ExactRay ray{{0, 0, 0}, {0, 0, -1}};
    const RayPart part{.start = 0};
    EXPECT_EQ(two.along(ray, 0, part).kind, Kind::wrong);
    EXPECT_EQ(two.along(ray, 1, part).kind, Kind::exact);
    EXPECT_EQ(two.along(ray, 2, part).kind, Kind::tie) << "a curve may begin past the second";
    EXPECT_EQ(two.along(ray, NO_HIT, part).kind, Kind::wrong);
    EXPECT_EQ(two.along(ray, 2).kind, Kind::wrong) << "a ray that starts on none begins at its origin";
}

TEST(Settle, a_part_that_starts_at_a_corner_may_meet_a_thin_triangle_that_leads_back_from_it)
{
    // Walls around the corner 2 of cells as thin as 1 : 10,000. A curve that meets triangle 5 first must begin
    // past it, and only less than half the bound from the corner can it do so.
    constexpr float h = 4.99999987e-05f;
    const Settled cells({{{-0.5f, -0.5f, -h},
                          {0, -0.5f, -h},
                          {-0.5f, 0, -h},
                          {0, 0, -h},
                          {-0.5f, 0.5f, -h},
                          {0, 0.5f, -h},
                          {0, -0.5f, 0},
                          {-0.5f, 0, 0},
                          {-0.5f, 0.5f, 0}},
                         {{0, 3, 1}, {0, 7, 2}, {0, 1, 6}, {0, 2, 3}, {2, 5, 3}, {2, 8, 4}, {2, 7, 8}, {2, 4, 5}}});
    const RayPart part{.start = 8}; // on none of these
    const ExactRay ray{{-0.5f, 0, -h}, {0.25f, -0.5f, 0}};
    EXPECT_EQ(cells.along(ray, 5, part).kind, Kind::tie);
    EXPECT_EQ(cells.along({{-0.25f, -0.5f, -h}, ray.direction}, 5, part).kind, Kind::wrong);
}

TEST(Settle, a_part_that_starts_on_an_edge_may_begin_past_both_of_its_triangles)
{
    // The edge of a column's two walls, and its floor. A curve that meets the floor first must begin inside the column,
    // and of the two cells that the edge makes of the tube's cross-section only a part of each is inside.
    constexpr float low = -0x1.ffffp-2f, high = 0x1p-1f;
    const Settled column({{{high, high, low},
                           {high, high, high},
                           {high, low, low},
                           {low, high, high},
                           {low, high, low},
                           {low, low, -high},
                           {low, high, -high},
                           {high, high, -high}},
                          {{0, 1, 2}, {3, 1, 4}, {4, 1, 0}, {5, 6, 7}}});
    const RayPart part{.start = 4}; // on none of these
    const ExactRay ray{{high, high, 0x1p-19f}, {-0x1p-18f, -0x1p-19f, -0x1p-1f}};
    EXPECT_EQ(column.along(ray, 3, part).kind, Kind::tie);
    EXPECT_EQ(column.along(ray, 3).kind, Kind::wrong) << "a ray that starts on none begins at its origin";
}

TEST(Settle, a_part_ends_within_the_bound_of_its_end)
{
    const Settled one(layers({{0, 4}}));
    const auto ends = [&](float end, std::uint32_t answer) {
        return one.along({{0, 0, 1}, {0, 0, -1}}, answer, {.end = end}).kind;
    };
    EXPECT_EQ(ends(2, 0), Kind::exact);
    EXPECT_EQ(ends(2, NO_HIT), Kind::wrong);
    EXPECT_EQ(ends(1 + e, NO_HIT), Kind::tie);
    EXPECT_EQ(ends(1 - e, 0), Kind::tie);
    EXPECT_EQ(ends(1 - e, NO_HIT), Kind::exact);
    EXPECT_EQ(ends(0.5f, 0), Kind::wrong);
}

TEST(Settle, a_triangle_that_is_seen_edge_on_past_the_end_is_not_met)
{
    const Settled wall({{{0, -1, -1}, {0, 1, -1}, {0, 0, 0}}, {{0, 1, 2}}});
    for (const bool any_hit : {false, true}) {
        const auto ends = [&](float end, std::uint32_t answer) {
            return wall.along({{0, 0, 1}, {0, 0, -1}}, answer, {.end = end, .any_hit = any_hit}).kind;
        };
        EXPECT_EQ(ends(1.5f, 0), Kind::tie);
        EXPECT_EQ(ends(0.5f, 0), Kind::wrong);
        EXPECT_EQ(ends(0.97f, 0), Kind::wrong) << "so near that it is gathered";
        EXPECT_EQ(ends(0.5f, NO_HIT), Kind::exact);
        EXPECT_EQ(ends(1.5f, NO_HIT), Kind::tie);
    }
}

TEST(Settle, a_wall_that_is_seen_edge_on_closes_the_way_between_two_layers)
{
    // One layer left of the ray and one right of it, a unit farther, joined by a wall in the plane of the ray.
    const TriangleMesh step{{{0, -4, 0}, {0, 4, 0}, {-4, 0, 0}, {0, -4, -1}, {0, 4, -1}, {4, 0, -1}},
                            {{0, 1, 2}, {3, 4, 5}, {0, 1, 3}, {1, 4, 3}}};
    for (const TriangleMesh& mesh : {step, mirrored(step)}) {
        const Settled closed(mesh);
        const ExactRay ray{{0, 0, 1}, {0, 0, -1}};
        EXPECT_EQ(closed.along(ray, NO_HIT).kind, Kind::wrong);
        EXPECT_EQ(closed.along(ray, NO_HIT, {.end = 3}).kind, Kind::wrong) << "no t says that the wall is before 3";
        TriangleMesh open = mesh;
        open.triangles.resize(2);
        EXPECT_EQ(Settled(open).along(ray, NO_HIT).kind, Kind::tie) << "without the wall";
    }
}

namespace {

Witness straight_down(double x, double to)
{
    return {{0, 0, 0}, {x, 0, 0}, {x, 0, to}};
}

bool holds(const Witness& witness, std::uint32_t answer)
{
    static const std::vector<std::uint32_t> all{lower, upper, behind};
    return is_witness(squares.mesh, {{{1, 0.5f, 1}, {0, 0, -1}}, {}, answer, bound, all}, witness);
}

} // namespace

TEST(Witness, is_refused_unless_it_proves_what_it_is_for)
{
    EXPECT_TRUE(holds(straight_down(0x1p-21, -2.5), behind)) << "past the square's edge at x = 1";
    EXPECT_TRUE(holds(straight_down(-0x1p-21, -1.5), lower));
    EXPECT_FALSE(holds(straight_down(-0x1p-21, -2.5), behind)) << "it meets the square first";
    EXPECT_FALSE(holds(straight_down(0, -2.5), behind)) << "it touches the square's edge";
    EXPECT_FALSE(holds(straight_down(0x1p-21, -1.5), behind)) << "it ends before";
    EXPECT_FALSE(holds(straight_down(0x1p-19, -2.5), behind)) << "farther than the bound";
    EXPECT_FALSE(holds(straight_down(0x1p-21, -2.5), NO_HIT));
    EXPECT_FALSE(holds(straight_down(0x1p-21, -1.5), NO_HIT)) << "it ends before the last triangle";
    EXPECT_FALSE(holds({{0, 0, -1.5}, {0x1p-21, 0, -1.5}, {0x1p-21, 0, -2.5}}, behind)) << "it starts elsewhere";
    EXPECT_FALSE(
        holds({{0, 0, 0}, {0x1p-21, 0, 0}, {0x1p-21, 0, -1.5}, {0x1p-21, 0, -1.25}, {0x1p-21, 0, -2.5}}, behind))
        << "it goes back";
    EXPECT_FALSE(holds({}, behind));
}

// A needle, one part in a thousand wide: by the old allowance its t could be off by 5e-3.
TEST(HitPoint, t_u_and_v_are_held_to_the_error_of_the_formula)
{
    const TriangleMesh needle{{{0, 0, 0}, {1, 0, 0}, {0.5f, 0x1p-10f, 0}}, {{0, 1, 2}}};
    const ExactRay ray{{0.5f, 0x1p-12f, 1}, {0, 0, -1}};
    const auto is_right = [&](float t, float u, float v) {
        return names_right_point(needle, ray, {0, 0, t, u, v, 0}, HitFormula::kernels, bound);
    };
    EXPECT_TRUE(is_right(1, 0.375f, 0.25f));
    EXPECT_TRUE(is_right(1 + 0x1p-23f, 0.375f, 0.25f));
    EXPECT_FALSE(is_right(1 + 0x1p-18f, 0.375f, 0.25f));
    EXPECT_FALSE(is_right(1, 0.375f + 0x1p-12f, 0.25f));
    EXPECT_FALSE(is_right(1, 0.375f, 0.25f + 0x1p-12f));
    EXPECT_FALSE(is_right(std::numeric_limits<float>::quiet_NaN(), 0.375f, 0.25f));
}

TEST(HitPoint, of_a_well_shaped_triangle_is_right_to_some_units)
{
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const ExactRay ray{{0.25f, 0.5f, 1}, {0, 0, -1}};
    const auto is_right = [&](float t, float u, float v) {
        return names_right_point(mesh, ray, {0, 0, t, u, v, 0}, HitFormula::kernels, bound);
    };
    constexpr float few = 0x1p-23f, many = 0x1p-19f;
    for (const float sense : {-1.0f, 1.0f}) {
        EXPECT_TRUE(is_right(1 + sense * few, 0.25f + sense * few, 0.5f + sense * few));
        EXPECT_FALSE(is_right(1 + sense * many, 0.25f, 0.5f));
        EXPECT_FALSE(is_right(1, 0.25f + sense * many, 0.5f));
        EXPECT_FALSE(is_right(1, 0.25f, 0.5f + sense * many));
    }
}

TEST(HitPoint, of_a_triangle_seen_edge_on_lies_in_it)
{
    const TriangleMesh wall{{{0, -1, -1}, {0, 1, -1}, {0, 0, 0}}, {{0, 1, 2}}};
    const ExactRay ray{{0, 0, 1}, {0, 0, -1}};
    const auto is_right = [&](float t, float u, float v) {
        return names_right_point(wall, ray, {0, 0, t, u, v, 0}, HitFormula::kernels, bound);
    };
    EXPECT_TRUE(std::isinf(point_of(wall, ray, 0).t));
    EXPECT_TRUE(is_right(1.5f, 1.0f / 3, 1.0f / 3));
    EXPECT_TRUE(is_right(1, 0, 1));
    EXPECT_FALSE(is_right(2.25f, 1.0f / 3, 1.0f / 3)) << "past all of it";
    EXPECT_FALSE(is_right(0.5f, 1.0f / 3, 1.0f / 3)) << "before all of it";
    EXPECT_FALSE(is_right(1.5f, -0.5f, 1.0f / 3));
    EXPECT_FALSE(is_right(1.5f, 0.75f, 0.75f));
}
