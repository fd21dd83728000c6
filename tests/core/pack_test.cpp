#include "core/pack/packed_scene.h"

#include "core/base/error.h"
#include "core/pack/hilbert.h"
#include "core/pack/kernel_id.h"
#include "scenes/procedural.h"
#include "tests/support/unpack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <tuple>

using namespace tetrace;
using namespace tetrace::test;

namespace {

// The scene's tets in packed order, with vertices by position, as unpack() gives them.
void expect_same_tets(const Scene& scene, const PackedScene& packed)
{
    const TetMesh back = unpack(packed);
    ASSERT_EQ(back.tets.size(), scene.tets.tets.size());
    for (std::size_t i = 0; i < scene.tets.tets.size(); ++i) {
        const Tet& tet = scene.tets.tets[i];
        const Tet& other = back.tets[packed.packed_of_mesh[i]];
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_EQ(scene.tets.vertices[tet.vertices[k]], back.vertices[other.vertices[k]]);
            ASSERT_EQ(tet.faces[k], other.faces[k]);
            const auto half_face = tet.neighbours[k];
            const auto expected =
                half_face == NO_HALF_FACE
                    ? NO_HALF_FACE
                    : make_half_face(packed.packed_of_mesh[half_face_tet(half_face)], half_face_index(half_face));
            ASSERT_EQ(other.neighbours[k], expected);
        }
    }
    EXPECT_EQ(find_defect(back, scene.mesh.triangles.size()), std::nullopt);
}

void expect_reached_first(const TetMesh& mesh)
{
    std::vector<bool> reached(mesh.tets.size());
    std::size_t count = 0;
    for (bool grows = true; grows;) {
        grows = false;
        for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet)
            for (std::size_t face = 0; face < 4 && !reached[tet]; ++face) {
                const auto half_face = mesh.tets[tet].neighbours[face];
                const bool is_open = half_face == NO_HALF_FACE ||
                                     (mesh.tets[tet].faces[face] == FREE_FACE && reached[half_face_tet(half_face)]);
                if (is_open) grows = reached[tet] = true, ++count;
            }
    }
    EXPECT_GT(count, 0u);
    EXPECT_LT(count, mesh.tets.size());
    EXPECT_TRUE(std::is_partitioned(reached.begin(), reached.end(), [](bool is_reached) { return is_reached; }));
}

class Packing : public testing::TestWithParam<std::tuple<Layout, TetOrder>> {};

} // namespace

TEST_P(Packing, unpacking_gives_the_tets_back_bit_for_bit)
{
    const Scene scene = make_cubes(6);
    expect_same_tets(scene, pack(scene, std::get<0>(GetParam()), std::get<1>(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(each, Packing,
                         testing::Combine(testing::Values(Layout::tet80, Layout::tet96, Layout::half32, Layout::tet64),
                                          testing::Values(TetOrder::chains, TetOrder::hilbert, TetOrder::reached,
                                                          TetOrder::input)),
                         [](const auto& tested) {
                             return std::string(name_of(std::get<0>(tested.param))) + "_" +
                                    std::string(name_of(std::get<1>(tested.param)));
                         });

TEST(Pack, sizes_are_those_of_the_layout)
{
    const Scene scene = make_cubes(3);
    const auto tets = scene.tets.tets.size();
    EXPECT_EQ(pack(scene, Layout::tet80, TetOrder::chains).tets.size() * sizeof(Quad), 80 * tets);
    EXPECT_EQ(pack(scene, Layout::tet96, TetOrder::chains).tets.size() * sizeof(Quad), 96 * tets);
    EXPECT_EQ(pack(scene, Layout::half32, TetOrder::chains).tets.size() * sizeof(Quad), 4 * 32 * tets);
    EXPECT_EQ(pack(scene, Layout::tet64, TetOrder::chains).tets.size() * sizeof(Quad), 64 * tets);
}

TEST(Pack, a_layout_holds_no_more_tets_than_its_kernels_index_with_32_bits)
{
    EXPECT_EQ(traits_of(Layout::tet80).most, 214'748'364u) << "20 words each";
    EXPECT_EQ(traits_of(Layout::tet96).most, 715'827'882u) << "6 quads each";
    EXPECT_EQ(traits_of(Layout::half32).most, 268'435'455u) << "28 bits in an exit";
    EXPECT_EQ(traits_of(Layout::tet64).most, 67'108'863u) << "26 bits in an exit";
}

// Along the curve no two tets that follow each other are far apart; row after row of cubes, the ends of rows are.
TEST(Pack, hilbert_order_has_no_long_jumps)
{
    const Scene scene = make_cubes(12);
    const auto longest_jump = [&](TetOrder order) {
        const TetMesh mesh = unpack(pack(scene, Layout::tet80, order));
        double longest = 0;
        for (std::size_t i = 1; i < mesh.tets.size(); ++i)
            longest = std::max(longest, length(to_double(mesh.vertices[mesh.tets[i].vertices[0]]) -
                                               to_double(mesh.vertices[mesh.tets[i - 1].vertices[0]])));
        return longest;
    };
    EXPECT_LT(longest_jump(TetOrder::hilbert), 0.5 * longest_jump(TetOrder::input));
}

// A tet is followed by its neighbour across its largest free face of those that are not placed yet.
TEST(Pack, chains_continue_across_the_largest_free_face_and_begin_along_the_curve)
{
    const Scene scene = make_cubes(9);
    const TetMesh mesh = unpack(pack(scene, Layout::tet80, TetOrder::chains));
    const auto area = [&](std::uint32_t tet, std::uint32_t face) {
        std::array<Double3, 3> corners;
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = to_double(mesh.vertices[mesh.tets[tet].vertices[face_corners[face][i]]]);
        return length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    };
    std::size_t followed = 0;
    for (std::uint32_t tet = 0; tet + 1 < mesh.tets.size(); ++tet) {
        double largest = 0, to_next = 0;
        for (std::uint32_t face = 0; face < 4; ++face) {
            const std::uint32_t half_face = mesh.tets[tet].neighbours[face];
            if (mesh.tets[tet].faces[face] != FREE_FACE || half_face == NO_HALF_FACE || half_face_tet(half_face) < tet)
                continue;
            largest = std::max(largest, area(tet, face));
            if (half_face_tet(half_face) == tet + 1) to_next = area(tet, face);
        }
        EXPECT_NEAR(to_next, largest, 1e-12) << "after tet " << tet;
        followed += to_next > 0 ? 1 : 0;
    }
    EXPECT_GT(followed, mesh.tets.size() / 2);

    const auto first_of = [&](TetOrder order) {
        const auto& packed = pack(scene, Layout::tet80, order).packed_of_mesh;
        return std::ranges::find(packed, 0u) - packed.begin();
    };
    const auto is_reached = reached_tets(scene.tets);
    ASSERT_TRUE(is_reached[static_cast<std::size_t>(first_of(TetOrder::hilbert))]);
    EXPECT_EQ(first_of(TetOrder::chains), first_of(TetOrder::hilbert));
}

// cubes are closed surfaces: a part of the tets is inside them.
TEST(Pack, tets_that_no_ray_reaches_come_last_in_order_reached_and_in_chains)
{
    const Scene scene = make_cubes(12);
    for (const TetOrder order : {TetOrder::reached, TetOrder::chains})
        expect_reached_first(unpack(pack(scene, Layout::tet80, order)));
}

TEST(Pack, layouts_number_the_tets_alike)
{
    const Scene scene = make_cubes(5);
    EXPECT_EQ(pack(scene, Layout::tet80, TetOrder::chains).packed_of_mesh,
              pack(scene, Layout::tet96, TetOrder::chains).packed_of_mesh);
}

// One flipped bit anywhere in the tets' quads must be visible after unpacking: no word is ignored but tet96's w.
TEST(Pack, every_word_of_a_tet_matters)
{
    const Scene scene = make_cubes(2);
    for (const auto layout : {Layout::tet80, Layout::tet96}) {
        const PackedScene packed = pack(scene, layout, TetOrder::chains);
        const TetMesh whole = unpack(packed);
        const std::size_t words = layout == Layout::tet80 ? 20 : 24;
        for (std::size_t word = 0; word < words; ++word) {
            if (layout == Layout::tet96 && word < 16 && word % 4 == 3) continue; // padding
            PackedScene spoilt = packed;
            Quad& quad = spoilt.tets[word / 4];
            std::uint32_t* at[] = {&quad.x, &quad.y, &quad.z, &quad.w};
            *at[word % 4] ^= 1u;
            EXPECT_FALSE(unpack(spoilt) == whole) << name_of(layout) << " word " << word;
        }
    }
}

// Records say most things several times: no copy may differ from the others.
TEST(Pack, no_word_of_a_record_may_contradict_the_others)
{
    const Scene scene = make_cubes(2);
    for (const Layout layout : {Layout::half32, Layout::tet64}) {
        const PackedScene packed = pack(scene, layout, TetOrder::chains);
        const std::size_t tets_words = layout == Layout::half32 ? std::size_t{16} * HALF32_QUADS : 16;
        const auto refused = [&](std::vector<Quad> PackedScene::*quads, std::size_t word, std::uint32_t bit) {
            PackedScene spoilt = packed;
            Quad& quad = (spoilt.*quads)[word / 4];
            std::uint32_t* at[] = {&quad.x, &quad.y, &quad.z, &quad.w};
            *at[word % 4] ^= bit;
            EXPECT_THROW((void)unpack(spoilt), Error) << name_of(layout) << " word " << word << ", bit " << bit;
        };
        for (const std::uint32_t bit : {1u, 2u, 4u, 1u << 31}) {
            for (std::size_t word = 0; word < tets_words; ++word)
                refused(&PackedScene::tets, word, bit);
            for (const std::size_t word : {7u, 11u}) // a row's two half-faces
                if (layout == Layout::tet64) refused(&PackedScene::triangles, word, bit);
        }
    }
}

// Compilers compute with the fourth word of a quad as with the three coordinates before it.
TEST(Pack, only_coordinates_are_denormal_as_floats)
{
    const Scene scene = make_cubes(4);
    const auto expect_no_denormal = [](const std::vector<Quad>& quads, std::size_t stride) {
        for (std::size_t quad = 0; quad < quads.size(); quad += stride)
            ASSERT_NE(std::fpclassify(std::bit_cast<float>(quads[quad].w)), FP_SUBNORMAL) << "quad " << quad;
    };
    expect_no_denormal(pack(scene, Layout::half32, TetOrder::chains).tets, HALF32_QUADS);
    const PackedScene packed = pack(scene, Layout::tet64, TetOrder::chains);
    expect_no_denormal(packed.tets, 1);
    expect_no_denormal(packed.triangles, 1);
}

// An occlusive face has a row, which its two sides share; a triangle that is cut has several.
TEST(Pack, rows_of_tet64_name_their_triangle_and_what_is_on_both_sides)
{
    const Scene scene = make_cubes(4);
    const PackedScene packed = pack(scene, Layout::tet64, TetOrder::chains);
    const PackedScene of_triangles = pack(scene, Layout::tet80, TetOrder::chains);
    const std::size_t rows = packed.triangles.size() / TRIANGLE_QUADS;
    EXPECT_EQ(rows, count_faces(scene.tets).occlusive_faces);
    const TetMesh mesh = unpack(packed);
    for (std::size_t row = 0; row < rows; ++row) {
        const Quad* const quads = &packed.triangles[TRIANGLE_QUADS * row];
        const std::uint32_t triangle = quads[0].w - NORMAL_BIAS;
        const std::uint32_t one = quads[1].w ^ EXIT_IS_NORMAL, other = quads[2].w ^ EXIT_IS_NORMAL;
        ASSERT_EQ(mesh.tets[half_face_tet(one)].faces[half_face_index(one)], triangle) << "row " << row;
        ASSERT_EQ(mesh.tets[half_face_tet(one)].neighbours[half_face_index(one)], other) << "row " << row;
        for (std::size_t i = 0; i < TRIANGLE_QUADS; ++i) {
            const Quad& right = of_triangles.triangles[TRIANGLE_QUADS * triangle + i];
            ASSERT_EQ(std::tie(quads[i].x, quads[i].y, quads[i].z), std::tie(right.x, right.y, right.z)) << row;
        }
    }
}

TEST(Pack, triangles_hold_a_corner_and_two_edges)
{
    const Scene scene = make_cubes(3);
    const PackedScene packed = pack(scene, Layout::tet80, TetOrder::chains);
    ASSERT_EQ(packed.triangles.size(), 3 * scene.mesh.triangles.size());
    const auto& [a, b, c] = scene.mesh.triangles[1];
    const auto x = [](const Quad& quad) { return std::bit_cast<float>(quad.x); };
    EXPECT_EQ(x(packed.triangles[3]), scene.mesh.vertices[a].x);
    EXPECT_EQ(x(packed.triangles[4]), scene.mesh.vertices[b].x - scene.mesh.vertices[a].x);
    EXPECT_EQ(x(packed.triangles[5]), scene.mesh.vertices[c].x - scene.mesh.vertices[a].x);
}

TEST(Hilbert, neighbouring_cells_follow_each_other)
{
    // Through the centres of an 8^3 grid the curve visits every cell once, and each step goes to a neighbour.
    std::vector<std::pair<std::uint64_t, std::array<int, 3>>> cells;
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y)
            for (int z = 0; z < 8; ++z)
                cells.push_back({hilbert_index({(x + 0.5) / 8, (y + 0.5) / 8, (z + 0.5) / 8}), {x, y, z}});
    std::sort(cells.begin(), cells.end());
    for (std::size_t i = 1; i < cells.size(); ++i) {
        int apart = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            apart += std::abs(cells[i].second[axis] - cells[i - 1].second[axis]);
        EXPECT_EQ(apart, 1) << "at cell " << i;
    }
}
