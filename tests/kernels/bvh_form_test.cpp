// The forms that BVHs have for processors against the text that every API compiles: hits bit for bit, and the same
// nodes and triangles visited (docs/spec/bvhs.md, B13).
#include "core/bvh/bvh.h"
#include "core/device/host.h"
#include "tests/kernels/bvh_form_probe.h"
#include "tests/support/bvh_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>

using namespace tetrace;
using namespace tetrace::test;

namespace {

struct Form {
    const char* name;
    Layout layout;
    TraceByForm* portable;
    TraceByForm* tested;
    bool needs_avx2;
};
const Form forms[] = {{"bvh2_tiles", Layout::bvh2, trace_bvh2_portable, trace_bvh2_tiles, false},
                      {"bvh2_native", Layout::bvh2, trace_bvh2_portable, trace_bvh2_native, true},
                      {"bvh4_tiles", Layout::bvh4, trace_bvh4_portable, trace_bvh4_tiles, false},
                      {"bvh4_native", Layout::bvh4, trace_bvh4_portable, trace_bvh4_native, true},
                      {"cwbvh_tiles", Layout::cwbvh, trace_cwbvh_portable, trace_cwbvh_tiles, false},
                      {"cwbvh_native", Layout::cwbvh, trace_cwbvh_portable, trace_cwbvh_native, true}};

class BvhForm : public testing::TestWithParam<std::tuple<Form, MeshRow>> {
protected:
    void SetUp() override
    {
        if (form().needs_avx2 && !host_has_fused_multiply())
            GTEST_SKIP() << "this processor does not run code for x86-64-v3";
        mesh_ = std::get<1>(GetParam()).make();
        for (Float3& vertex : mesh_.vertices)
            vertex = snap_to_grid(vertex);
        trees_[0] = make_bvh_scene(mesh_, form().layout);
        trees_[1] = pack_bvh(mesh_, build_balanced_bvh(mesh_), form().layout);
    }
    [[nodiscard]] static const Form& form() { return std::get<0>(GetParam()); }

    /// A vertex, a point of an edge, or one of a triangle.
    [[nodiscard]] Float3 point_of(Random& random) const
    {
        const auto& triangle = mesh_.triangles[random.below(static_cast<std::uint32_t>(mesh_.triangles.size()))];
        const Float3 a = mesh_.vertices[triangle[0]], b = mesh_.vertices[triangle[1]], c = mesh_.vertices[triangle[2]];
        const std::uint32_t kind = random.below(3);
        const float u = kind == 0 ? 0 : random.unit(), v = kind == 2 ? random.unit() * (1 - u) : 0;
        const auto at = [&](float p, float q, float r) { return p + (q - p) * u + (r - p) * v; };
        return snap_to_grid(Float3{at(a.x, b.x, c.x), at(a.y, b.y, c.y), at(a.z, b.z, c.z)});
    }

    /// Traces the ray with and without an end, to the nearest and to any hit, and counts in hits_.
    void expect_same(Float3 origin, Float3 direction, float end)
    {
        for (float& component : {std::ref(direction.x), std::ref(direction.y), std::ref(direction.z)})
            if (std::abs(component) < 0x1p-20f) component = component < 0 ? -0.0f : 0.0f;
        const auto bits = [](float a) { return std::bit_cast<std::uint32_t>(a); };
        for (const float limit : {NO_END, end})
            for (const bool any_hit : {false, true}) {
                const std::array<Quad, 2> quads = {Quad{bits(direction.x), bits(direction.y), bits(direction.z), 0},
                                                   Quad{bits(origin.x), bits(origin.y), bits(origin.z), bits(limit)}};
                for (const PackedScene& tree : trees_) {
                    const VisitedHit expected = form().portable(tree, quads, any_hit);
                    const VisitedHit found = form().tested(tree, quads, any_hit);
                    ASSERT_EQ(found.hit, expected.hit);
                    ASSERT_EQ(found.nodes, expected.nodes);
                    ASSERT_EQ(found.triangles, expected.triangles);
                    hits_ += expected.hit[0] != NO_HIT;
                }
            }
    }
    void expect_same_to(Float3 from, Float3 to, float end)
    {
        expect_same(from, {to.x - from.x, to.y - from.y, to.z - from.z}, end);
    }

    int hits_ = 0;

private:
    TriangleMesh mesh_;
    PackedScene trees_[2];
};

} // namespace

TEST_P(BvhForm, hits_and_visits_the_same_when_aimed_at_vertices_edges_and_triangles)
{
    Random random(41);
    for (int i = 0; i < 500; ++i)
        ASSERT_NO_FATAL_FAILURE(expect_same_to(random.point(-4, 4), point_of(random), random.between(0.5f, 1.5f)));
    EXPECT_GT(hits_, 500);
}

TEST_P(BvhForm, hits_and_visits_the_same_between_two_points_of_the_mesh)
{
    Random random(42);
    for (int i = 0; i < 1000; ++i) {
        const Float3 from = point_of(random);
        ASSERT_NO_FATAL_FAILURE(expect_same_to(from, point_of(random), random.between(0, 2)));
    }
}

TEST_P(BvhForm, hits_and_visits_the_same_along_axes_and_without_a_direction)
{
    Random random(43);
    for (int i = 0; i < 1000; ++i) {
        Float3 direction{};
        const int axis = static_cast<int>(random.below(3));
        direction[axis] = random.below(2) == 0 ? 1.0f : -1.0f;
        const std::uint32_t kind = random.below(4); // along an axis, in a plane of two, as much along two or all
        if (kind == 1) direction[(axis + 1) % 3] = random.between(-1, 1);
        if (kind >= 2) direction[(axis + 1) % 3] = random.below(2) == 0 ? 1.0f : -1.0f;
        if (kind == 3) direction[(axis + 2) % 3] = random.below(2) == 0 ? 1.0f : -1.0f;
        Float3 origin = point_of(random);
        for (int j = 0; j < 3; ++j)
            if (random.below(2) == 0) origin[j] -= 2 * direction[j];
        ASSERT_NO_FATAL_FAILURE(expect_same(snap_to_grid(origin), direction, random.between(0, 4)));
    }
    EXPECT_GT(hits_, 500);
    ASSERT_NO_FATAL_FAILURE(expect_same(point_of(random), {0, 0, 0}, 1));
}

INSTANTIATE_TEST_SUITE_P(each, BvhForm, testing::Combine(testing::ValuesIn(forms), testing::ValuesIn(meshes_to_pack())),
                         [](const auto& tested) {
                             return std::string(std::get<0>(tested.param).name) + "_" + std::get<1>(tested.param).name;
                         });
