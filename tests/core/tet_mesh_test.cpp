#include "core/mesh/tet_mesh.h"

#include "scenes/procedural.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace tetrace;

namespace {

using Kind = TetMeshDefect::Kind;

Double3 size_of(const Domain& domain)
{
    return to_double(domain.high()) - to_double(domain.low());
}

// The kind of the first defect of a mesh that was spoilt on purpose.
template <class Spoil>
std::optional<Kind> defect_after(const Spoil& spoil)
{
    Scene scene = make_cubes(3);
    spoil(scene);
    const auto defect = find_defect(scene.tets, scene.mesh.triangles.size());
    return defect ? std::optional(defect->kind) : std::nullopt;
}

template <class Spoil>
std::optional<Kind> gap_after(const Spoil& spoil)
{
    Scene scene = make_cubes(3);
    spoil(scene);
    const auto defect = find_gap(scene.tets, scene.mesh, size_of(scene.domain));
    return defect ? std::optional(defect->kind) : std::nullopt;
}

std::uint32_t inner_face_of(const Tet& tet)
{
    for (std::uint32_t face = 0; face < 4; ++face)
        if (tet.neighbours[face] != NO_HALF_FACE) return face;
    return 4;
}

} // namespace

TEST(TetMesh, cubes_have_no_defect_and_no_gap)
{
    EXPECT_EQ(defect_after([](Scene&) {}), std::nullopt);
    EXPECT_EQ(gap_after([](Scene&) {}), std::nullopt);
}

TEST(TetMesh, a_bad_index_is_found)
{
    EXPECT_EQ(defect_after([](Scene& s) { s.tets.tets[5].vertices[2] = 1000000; }), Kind::bad_index);
    EXPECT_EQ(defect_after([](Scene& s) { s.tets.tets[5].neighbours[1] = make_half_face(999999, 0); }),
              Kind::bad_index);
    EXPECT_EQ(defect_after([](Scene& s) { s.tets.tets[5].faces[1] = 999999; }), Kind::bad_index);
    EXPECT_EQ(defect_after([](Scene& s) { s.tets.tets.clear(); }), Kind::bad_index);
}

TEST(TetMesh, an_asymmetric_link_is_found)
{
    EXPECT_EQ(defect_after([](Scene& s) {
                  Tet& tet = s.tets.tets[7];
                  tet.neighbours[inner_face_of(tet)] ^= 1u;
              }),
              Kind::asymmetric_neighbour);
    EXPECT_EQ(defect_after([](Scene& s) {
                  Tet& tet = s.tets.tets[7];
                  tet.neighbours[inner_face_of(tet)] = NO_HALF_FACE;
              }),
              Kind::asymmetric_neighbour);
}

// Two pairs of neighbours change partners: each names the other back, over faces that have other vertices.
TEST(TetMesh, neighbours_that_share_other_vertices_are_found)
{
    EXPECT_EQ(defect_after([](Scene& s) {
                  const auto half_face_of = [&](std::uint32_t tet) {
                      const std::uint32_t face = inner_face_of(s.tets.tets[tet]);
                      EXPECT_EQ(s.tets.tets[tet].faces[face], FREE_FACE);
                      return make_half_face(tet, face);
                  };
                  const auto partner = [&](std::uint32_t half_face) -> std::uint32_t& {
                      return s.tets.tets[half_face_tet(half_face)].neighbours[half_face_index(half_face)];
                  };
                  const std::uint32_t a = half_face_of(0), c = half_face_of(100);
                  const std::uint32_t b = partner(a), d = partner(c);
                  EXPECT_EQ(s.tets.tets[half_face_tet(b)].faces[half_face_index(b)], FREE_FACE);
                  EXPECT_EQ(s.tets.tets[half_face_tet(d)].faces[half_face_index(d)], FREE_FACE);
                  partner(a) = d, partner(d) = a;
                  partner(c) = b, partner(b) = c;
              }),
              Kind::asymmetric_neighbour);
}

TEST(TetMesh, an_inverted_and_a_flat_tet_are_distinguished)
{
    // Two vertices change places, with their faces: half-faces stay symmetric, only the orientation turns.
    EXPECT_EQ(defect_after([](Scene& s) {
                  Tet& tet = s.tets.tets[0];
                  std::swap(tet.vertices[0], tet.vertices[1]);
                  std::swap(tet.neighbours[0], tet.neighbours[1]);
                  std::swap(tet.faces[0], tet.faces[1]);
                  for (std::uint32_t face = 0; face < 2; ++face) {
                      const auto half_face = tet.neighbours[face];
                      if (half_face != NO_HALF_FACE)
                          s.tets.tets[half_face_tet(half_face)].neighbours[half_face_index(half_face)] =
                              make_half_face(0, face);
                  }
              }),
              Kind::inverted);
    EXPECT_EQ(defect_after([](Scene& s) {
                  for (auto& v : s.tets.vertices)
                      v.z = 0;
              }),
              Kind::flat);
}

TEST(TetMesh, sides_that_disagree_about_the_triangle_are_found)
{
    EXPECT_EQ(defect_after([](Scene& s) {
                  Tet& tet = s.tets.tets[7];
                  tet.faces[inner_face_of(tet)] = tet.faces[inner_face_of(tet)] == FREE_FACE ? 0 : FREE_FACE;
              }),
              Kind::asymmetric_face);
}

TEST(TetMesh, an_input_triangle_that_no_face_covers_is_found)
{
    EXPECT_EQ(gap_after([](Scene& s) {
                  for (auto& tet : s.tets.tets)
                      for (auto& face : tet.faces)
                          if (face == 1) face = FREE_FACE;
              }),
              Kind::uncovered_triangle);
}

TEST(TetMesh, tets_that_do_not_fill_the_domain_are_found)
{
    EXPECT_EQ(gap_after([](Scene& s) { s.domain.lines[0].back() += 0.01f; }), Kind::open_boundary);
}

TEST(TetMesh, tets_are_reached_only_through_free_faces)
{
    TetMesh mesh = make_cubes(3).tets;
    for (Tet& tet : mesh.tets)
        tet.faces.fill(FREE_FACE);
    EXPECT_EQ(count_faces(mesh).reached_tets, mesh.tets.size());
    std::uint32_t inner = 0; // one without a side of the boundary, then walled in
    while (std::ranges::count(mesh.tets[inner].neighbours, NO_HALF_FACE) > 0)
        ++inner;
    for (std::size_t face = 0; face < 4; ++face) {
        const std::uint32_t half_face = mesh.tets[inner].neighbours[face];
        mesh.tets[inner].faces[face] = 0;
        mesh.tets[half_face_tet(half_face)].faces[half_face_index(half_face)] = 0;
    }
    EXPECT_EQ(count_faces(mesh).reached_tets, mesh.tets.size() - 1);
    EXPECT_FALSE(reached_tets(mesh)[inner]);
}

TEST(TetMesh, faces_are_counted_once)
{
    const Scene scene = make_cubes(3);
    const TetMeshCounts counts = count_faces(scene.tets);
    EXPECT_EQ(counts.tets, 6u * 27);
    EXPECT_EQ(counts.boundary_faces, 6u * 9 * 2);
    EXPECT_EQ(counts.occlusive_faces, scene.mesh.triangles.size());
    EXPECT_EQ(4 * counts.tets, 2 * (counts.occlusive_faces + counts.free_faces) + counts.boundary_faces);
}
