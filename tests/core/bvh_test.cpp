#include "core/bvh/bvh.h"

#include "tests/support/bvh_meshes.h"

#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

TEST(Box, grown_box_has_the_margin_whatever_the_rounding)
{
    constexpr double margin = 0x1p-17;
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const Float3 a = random.point(-60, 60);
        const Box box = grown({a, a}, margin);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(double{box.low[axis]}, a[axis] - margin);
            EXPECT_GE(double{box.high[axis]}, a[axis] + margin);
            EXPECT_GT(double{box.low[axis]}, a[axis] - 2 * margin);
        }
    }
}

TEST(Box, floats_below_and_above_enclose_and_are_next_to_each_other)
{
    EXPECT_EQ(float_below(0.1), std::nextafter(float_above(0.1), 0.0f));
    EXPECT_LT(float_below(-0.1), float_above(-0.1));
    EXPECT_EQ(float_below(0.5), 0.5f);
    EXPECT_EQ(float_above(0.5), 0.5f);
}

TEST(Box, boxes_apart_have_nothing_in_common)
{
    const Box a = {{0, 0, 0}, {1, 1, 1}};
    EXPECT_TRUE(is_empty(common(a, {{2, 0, 0}, {3, 1, 1}})));
    EXPECT_EQ(common(a, {{1, 0, 0}, {3, 1, 1}}), (Box{{1, 0, 0}, {1, 1, 1}}));
    EXPECT_EQ(merged(a, Box{}), a);
    EXPECT_EQ(half_area(Box{}), 0);
    EXPECT_EQ(half_area({{0, 0, 0}, {1, 2, 3}}), 11);
}

namespace {

// Two leaves of two triangles each.
struct SmallBvh {
    TriangleMesh mesh;
    Bvh bvh;
};
SmallBvh small_bvh()
{
    SmallBvh small;
    for (int i = 0; i < 4; ++i)
        add_triangle(small.mesh, {static_cast<float>(i), 0, 0}, {static_cast<float>(i), 1, 0},
                     {static_cast<float>(i), 0, 1});
    small.bvh.nodes = {
        {{{0, 0, 0}, {3, 1, 1}}, {1, 2}, 0, 0}, {{{0, 0, 0}, {1, 1, 1}}, {}, 0, 2}, {{{2, 0, 0}, {3, 1, 1}}, {}, 2, 2}};
    small.bvh.references = {0, 1, 2, 3};
    return small;
}

std::string defect_of(const SmallBvh& small)
{
    return find_defect(small.bvh, small.mesh).value_or("");
}

} // namespace

TEST(Bvh, a_whole_one_has_no_defect)
{
    EXPECT_EQ(defect_of(small_bvh()), "");
    EXPECT_EQ(depth_of(small_bvh().bvh), 1u);
}

TEST(Bvh, a_triangle_may_stand_in_two_leaves)
{
    SmallBvh small = small_bvh();
    small.bvh.references = {0, 1, 2, 3, 1};
    small.bvh.nodes[2].count = 3;
    EXPECT_EQ(defect_of(small), "");
}

TEST(Bvh, each_defect_is_found)
{
    const struct {
        const char* says;
        void (*spoil)(SmallBvh&);
    } rows[] = {
        {"the root is missing", [](auto& s) { s.bvh.nodes.clear(); }},
        {"before it or past", [](auto& s) { s.bvh.nodes[0].child[1] = 0; }},
        {"before it or past", [](auto& s) { s.bvh.nodes[0].child[1] = 3; }},
        {"child twice", [](auto& s) { s.bvh.nodes[0].child[1] = 1; }},
        {"nobody's child",
         [](auto& s) {
             s.bvh.references.push_back(0);
             s.bvh.nodes.push_back({s.bvh.nodes[1].box, {}, 4, 1});
         }},
        {"not in its parent's", [](auto& s) { s.bvh.nodes[0].box.high.x = 2.9f; }},
        {"references past", [](auto& s) { s.bvh.nodes[2].count = 3; }},
        {"in two leaves", [](auto& s) { s.bvh.nodes[2].first = 1; }},
        {"in no leaf", [](auto& s) { s.bvh.references.push_back(0); }},
        {"past the last", [](auto& s) { s.bvh.references[3] = 4; }},
        {"triangle twice", [](auto& s) { s.bvh.references[1] = 0; }},
        {"triangle 3 is not covered",
         [](auto& s) {
             s.bvh.nodes[2].box.high.y = 0.5f;
             s.mesh.triangles[2] = {6, 6, 6};
         }},
        {"triangle 4 is not covered",
         [](auto& s) {
             s.mesh.triangles.push_back({0, 1, 2});
         }},
    };
    for (const auto& row : rows) {
        SmallBvh small = small_bvh();
        row.spoil(small);
        EXPECT_NE(defect_of(small).find(row.says), std::string::npos) << row.says << ": '" << defect_of(small) << "'";
    }
}
