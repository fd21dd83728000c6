// Tets that share their vertices: what is packed comes back, word for word, and what cannot be walked is refused.
#include "core/base/error.h"
#include "core/pack/kernel_id.h"
#include "core/pack/packed_scene.h"
#include "scenes/procedural.h"
#include "tests/support/unpack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <tuple>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using Place = std::tuple<float, float, float>;

Place place_of(const TetMesh& mesh, std::uint32_t vertex)
{
    return {mesh.vertices[vertex].x, mesh.vertices[vertex].y, mesh.vertices[vertex].z};
}

/// What is opposite each vertex of a tet: the neighbour, and the triangle.
std::map<Place, std::pair<std::uint32_t, std::uint32_t>> faces_of(const TetMesh& mesh, const Tet& tet,
                                                                  const std::vector<std::uint32_t>& number_of_tet)
{
    std::map<Place, std::pair<std::uint32_t, std::uint32_t>> faces;
    for (std::size_t i = 0; i < 4; ++i)
        faces[place_of(mesh, tet.vertices[i])] = {
            tet.neighbours[i] == NO_HALF_FACE ? NO_TET : number_of_tet[half_face_tet(tet.neighbours[i])], tet.faces[i]};
    return faces;
}

std::string unsupported_text(const Scene& scene, Layout layout)
{
    try {
        (void)pack(scene, layout, TetOrder::chains);
    } catch (const Error& error) {
        return error.kind() == ErrorKind::unsupported ? error.what() : "another kind of error";
    }
    return "no error";
}

class CompactPacking : public testing::TestWithParam<Layout> {};

} // namespace

TEST_P(CompactPacking, unpacking_gives_the_tets_back)
{
    const Scene scene = make_cubes(6);
    for (const TetOrder order : {TetOrder::chains, TetOrder::input}) {
        const PackedScene packed = pack(scene, GetParam(), order);
        const TetMesh back = unpack(packed);
        ASSERT_EQ(back.tets.size(), scene.tets.tets.size());
        std::vector<std::uint32_t> same(back.tets.size());
        for (std::uint32_t i = 0; i < same.size(); ++i)
            same[i] = i;
        for (std::size_t i = 0; i < scene.tets.tets.size(); ++i)
            ASSERT_EQ(faces_of(scene.tets, scene.tets.tets[i], packed.packed_of_mesh),
                      faces_of(back, back.tets[packed.packed_of_mesh[i]], same));
        EXPECT_EQ(find_defect(back, scene.mesh.triangles.size()), std::nullopt);
    }
}

TEST_P(CompactPacking, sizes_are_those_of_the_layout)
{
    const Scene scene = make_cubes(4);
    const std::size_t tets = scene.tets.tets.size();
    const PackedScene packed = pack(scene, GetParam(), TetOrder::chains);
    EXPECT_EQ(packed.tets.size() * sizeof(Quad), (GetParam() == Layout::tet20 ? 20 : 16) * tets);
    EXPECT_EQ(packed.vertices.size(), scene.tets.vertices.size());
    EXPECT_EQ(packed.occlusive_faces.size(), OCCLUSIVE_WORDS * count_faces(scene.tets).occlusive_faces);
    EXPECT_TRUE(packed.entry_half_faces.empty());
    EXPECT_EQ(packed.entry_faces.size(), pack(scene, Layout::tet80, TetOrder::chains).entry_half_faces.size());
}

TEST_P(CompactPacking, numbers_the_tets_as_other_layouts_do)
{
    const Scene scene = make_cubes(5);
    EXPECT_EQ(pack(scene, GetParam(), TetOrder::chains).packed_of_mesh,
              pack(scene, Layout::tet80, TetOrder::chains).packed_of_mesh);
}

// Neighbours in memory share vertices: those of 64 tets that follow each other lie within a small part of them all.
TEST_P(CompactPacking, vertices_lie_as_the_tets_do)
{
    const Scene scene = make_cubes(16);
    const PackedScene packed = pack(scene, GetParam(), TetOrder::chains);
    std::vector<std::uint32_t> mesh_of_packed(packed.tet_count);
    for (std::uint32_t tet = 0; tet < packed.tet_count; ++tet)
        mesh_of_packed[packed.packed_of_mesh[tet]] = tet;
    double spread = 0;
    for (std::uint32_t tet : mesh_of_packed) {
        const auto& vertices = scene.tets.tets[tet].vertices;
        const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(), [&](auto a, auto b) {
            return packed.number_of_vertex[a] < packed.number_of_vertex[b];
        });
        spread += packed.number_of_vertex[*high] - packed.number_of_vertex[*low];
    }
    EXPECT_LT(spread / packed.tet_count, 0.15 * static_cast<double>(packed.vertices.size()));
}

TEST_P(CompactPacking, every_bit_of_a_tet_matters)
{
    const Scene scene = make_cubes(2);
    const PackedScene packed = pack(scene, GetParam(), TetOrder::chains);
    const TetMesh whole = unpack(packed);
    for (std::size_t word = 0; word < 20; ++word)
        for (const std::uint32_t bit : {0u, 3u, 17u, 31u}) {
            PackedScene spoilt = packed;
            Quad& quad = spoilt.tets[word / 4];
            std::uint32_t* at[] = {&quad.x, &quad.y, &quad.z, &quad.w};
            *at[word % 4] ^= 1u << bit;
            try {
                EXPECT_FALSE(unpack(spoilt) == whole) << "word " << word << " bit " << bit;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
            }
        }
}

TEST_P(CompactPacking, refuses_tets_that_a_walk_would_not_know_the_vertices_of)
{
    Scene scene = make_cubes(3);
    Tet& tet = scene.tets.tets[40];
    const auto inner = std::find_if(tet.neighbours.begin(), tet.neighbours.end(),
                                    [](auto half_face) { return half_face != NO_HALF_FACE; });
    *inner = make_half_face((half_face_tet(*inner) + 7) % 162, half_face_index(*inner));
    EXPECT_NE(unsupported_text(scene, GetParam()).find("do not name each other"), std::string::npos);
    Scene walled = make_cubes(3);
    for (Tet& one : walled.tets.tets)
        for (std::size_t i = 0; i < 4; ++i)
            if (one.neighbours[i] == NO_HALF_FACE) one.faces[i] = 0;
    EXPECT_NE(unsupported_text(walled, GetParam()).find("occlusive face on the domain's boundary"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(each, CompactPacking, testing::Values(Layout::tet20, Layout::tet16),
                         [](const auto& tested) { return std::string(name_of(tested.param)); });

TEST(CompactLimits, are_what_32_bits_index_and_links_name)
{
    EXPECT_EQ(traits_of(Layout::tet20).most, 858'993'459u) << "5 words each";
    EXPECT_EQ(traits_of(Layout::tet16).most, MAX_TETS) << "a quad each";
}
