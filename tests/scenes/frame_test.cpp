// Camera set `frame`: how much of an image the scene fills.
#include "core/base/hash.h"
#include "core/mesh/domain.h"
#include "core/rays/camera_set.h"
#include "scenes/catalogue.h"
#include "scenes/mesh_files.h"
#include "scenes/procedural.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <fstream>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr std::uint32_t side = 16;

Double3 ray_of(const View& view, std::uint32_t x, std::uint32_t y)
{
    return to_double(view.corner) + to_double(view.step_x) * x + to_double(view.step_y) * y;
}

/// Möller and Trumbore's test.
bool hits(Double3 origin, Double3 ray, Double3 a, Double3 b, Double3 c)
{
    const Double3 ab = b - a, ac = c - a, p = cross(ray, ac), from = origin - a, q = cross(from, ab);
    const double determinant = dot(ab, p);
    if (determinant == 0) return false;
    const double u = dot(from, p) / determinant, v = dot(ray, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && dot(ac, q) / determinant > 0;
}

/// The share of a view's rays that hit the mesh: each ray is tested with all triangles.
double hit_share(const TriangleMesh& mesh, const View& view)
{
    std::size_t hit = 0;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const Double3 origin = to_double(view.origin), ray = ray_of(view, i % side, i / side);
        hit += std::ranges::any_of(mesh.triangles, [&](const auto& t) {
            return hits(origin, ray, to_double(mesh.vertices[t[0]]), to_double(mesh.vertices[t[1]]),
                        to_double(mesh.vertices[t[2]]));
        });
    }
    return static_cast<double>(hit) / (side * side);
}

/// The share that enters the tight domain.
double domain_share(const TriangleMesh& mesh, const View& view)
{
    const Domain domain = make_domain(mesh, DomainKind::tight, 1);
    std::size_t entered = 0;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const Float3 ray = to_float(ray_of(view, i % side, i / side));
        double enter = 0, leave = 1e30;
        for (int axis = 0; axis < 3; ++axis) {
            const double low = (domain.low()[axis] - view.origin[axis]) / static_cast<double>(ray[axis]);
            const double high = (domain.high()[axis] - view.origin[axis]) / static_cast<double>(ray[axis]);
            enter = std::max(enter, std::min(low, high));
            leave = std::min(leave, std::max(low, high));
        }
        entered += enter <= leave;
    }
    return static_cast<double>(entered) / (side * side);
}

struct Shares {
    double entering = 0, hitting = 0, min_hitting = 1;
};
/// Means over the views, and the least of one view.
Shares shares_of(const TriangleMesh& mesh, const std::vector<Aim>& own)
{
    Shares shares;
    for (const Camera& camera : make_cameras(CameraSet::frame, mesh, own)) {
        const View view = make_view(camera, side, side);
        const double hitting = hit_share(mesh, view);
        shares.entering += domain_share(mesh, view) / own_view_count;
        shares.hitting += hitting / own_view_count;
        shares.min_hitting = std::min(shares.min_hitting, hitting);
    }
    return shares;
}

TriangleMesh read_off(const std::filesystem::path& path)
{
    std::ifstream text(path);
    std::string head;
    std::size_t vertices = 0, triangles = 0, edges = 0;
    text >> head >> vertices >> triangles >> edges;
    TriangleMesh mesh;
    for (Float3 p; mesh.vertices.size() < vertices && text >> p.x >> p.y >> p.z;)
        mesh.vertices.push_back(p);
    for (std::uint32_t n = 0, a = 0, b = 0, c = 0; text >> n >> a >> b >> c;)
        mesh.triangles.push_back({a, b, c});
    return mesh;
}

} // namespace

TEST(Frame, is_filled_by_each_scene_that_has_its_own_views)
{
    std::size_t scenes = 0;
    for (const CatalogueEntry& row : catalogue()) {
        if (row.views.empty()) continue;
        ++scenes;
        ASSERT_EQ(row.views.size(), own_view_count) << row.name;
        for (const Aim& aim : row.views)
            EXPECT_EQ(why_no_camera(aim), "") << row.name;
        const Shares shares = shares_of(row.procedural->usual(), row.views);
        EXPECT_GE(shares.entering, 0.95) << row.name;
        EXPECT_GE(shares.hitting, 0.6) << row.name;
        EXPECT_GE(shares.min_hitting, 0.4) << row.name;
    }
    EXPECT_EQ(scenes, 5u);
}

TEST(Frame, is_filled_by_a_mesh_without_its_own_views)
{
    for (const TriangleMesh& mesh : {make_banana(2'000), make_cubes(8).mesh}) {
        const Shares shares = shares_of(mesh, {});
        EXPECT_GE(shares.entering, 0.95);
        EXPECT_GE(shares.min_hitting, framed_hits - 0.05) << "the rule is kept in another image size";
    }
}

// No camera has three quarters of its rays on a wire, or on a single small triangle of a large box.
TEST(Frame, of_a_mesh_that_fills_no_image_is_where_most_rays_hit)
{
    const TriangleMesh wire{{{-1, -1, -1}, {1, 1, 1}, {1, 1.01F, 1}}, {{0, 1, 2}}};
    const std::vector<Aim> views = framing_views(wire);
    ASSERT_EQ(views.size(), own_view_count);
    for (const Aim& aim : views)
        EXPECT_EQ(why_no_camera(aim), "");
    EXPECT_GT(shares_of(wire, {}).hitting, 0);
}

TEST(Frame, of_a_rule_is_reproducible_to_the_bit)
{
    EXPECT_EQ(hash_text(hash_of_cameras(make_cameras(CameraSet::frame, make_banana(2'000)))), "268d73754c1a55c8");
}

TEST(Frame, is_filled_by_bunny_and_armadillo)
{
    for (const char* const name : {"bunny", "armadillo"}) {
        if (const std::string why = why_not_available(name); !why.empty()) GTEST_SKIP() << why;
        const Shares shares = shares_of(read_off(mesh_file(*find_in_catalogue(name))), {});
        EXPECT_GE(shares.entering, 0.95) << name;
        EXPECT_GE(shares.hitting, 0.6) << name;
        EXPECT_GE(shares.min_hitting, 0.6) << name;
    }
}
