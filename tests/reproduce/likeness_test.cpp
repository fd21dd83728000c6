#include "bench/reproduce/likeness.h"

#include "bench/reproduce/paper.h"
#include "tests/support/temporary_folder.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

Scene scene_of(std::size_t triangles, DomainKind kind)
{
    Scene scene;
    scene.mesh.triangles.resize(triangles);
    scene.domain.kind = kind;
    return scene;
}

/// The paper's counts times a factor.
TetMeshCounts papers_counts(const char* scene, double factor)
{
    const auto figures = paper::figures_of(scene).value();
    const auto scaled = [&](std::uint64_t count) {
        return static_cast<std::uint64_t>(factor * static_cast<double>(count));
    };
    return {scaled(figures.tets), scaled(figures.occlusive_faces), scaled(figures.free_faces), 12};
}

LikenessKind kind_of(const char* scene, std::size_t triangles, DomainKind domain, double factor)
{
    return likeness_of(scene, scene_of(triangles, domain), papers_counts(scene, factor)).kind;
}

} // namespace

TEST(Likeness, its_counts_are_within_two_per_cent_and_near_ones_within_ten)
{
    EXPECT_EQ(kind_of("bunny", 69'451, DomainKind::wide, 1), LikenessKind::papers_counts);
    EXPECT_EQ(kind_of("bunny", 69'451, DomainKind::wide, 1.019), LikenessKind::papers_counts);
    EXPECT_EQ(kind_of("bunny", 69'451, DomainKind::wide, 0.97), LikenessKind::near_counts);
    EXPECT_EQ(kind_of("bunny", 69'451, DomainKind::wide, 1.11), LikenessKind::other_tets);
    EXPECT_EQ(kind_of("bunny", 69'451, DomainKind::tight, 1), LikenessKind::other_tets) << "another domain";
}

TEST(Likeness, one_count_that_is_off_makes_other_tets)
{
    for (const auto member : {&TetMeshCounts::tets, &TetMeshCounts::occlusive_faces, &TetMeshCounts::free_faces}) {
        TetMeshCounts counts = papers_counts("bunny", 1);
        counts.*member *= 5;
        EXPECT_EQ(likeness_of("bunny", scene_of(69'451, DomainKind::wide), counts).kind, LikenessKind::other_tets);
    }
}

TEST(Likeness, another_mesh_is_not_compared_whatever_its_counts)
{
    const Likeness debians =
        likeness_of("armadillo", scene_of(52'000, DomainKind::wide), papers_counts("armadillo", 1));
    EXPECT_EQ(debians.kind, LikenessKind::other_mesh);
    EXPECT_FALSE(debians.is_compared());
    EXPECT_TRUE(contains(debians.reason, "52,000 triangles, but the paper's counts are from 345,944"));
    EXPECT_TRUE(contains(debians.reason, "TETRACE_MESHES"));
    EXPECT_EQ(kind_of("armadillo", 345'944, DomainKind::wide, 1), LikenessKind::papers_counts) << "the user's file";
    EXPECT_EQ(kind_of("bunny", 75'408, DomainKind::wide, 0.99), LikenessKind::papers_counts)
        << "Debian's bunny is near";
}

TEST(Likeness, tets_for_rays_are_not_compared_whatever_their_counts)
{
    Scene scene = scene_of(69'451, DomainKind::wide);
    scene.build.optimised.asked = TetsKind::rays;
    const Likeness likeness = likeness_of("bunny", scene, papers_counts("bunny", 1));
    EXPECT_EQ(likeness.kind, LikenessKind::tets_for_rays);
    EXPECT_FALSE(likeness.is_compared());
    EXPECT_TRUE(contains(likeness.reason, "no CDT"));
    scene.mesh.triangles.resize(100);
    EXPECT_EQ(likeness_of("bunny", scene, papers_counts("bunny", 1)).kind, LikenessKind::other_mesh);
}

TEST(Likeness, other_scenes_are_not_the_papers)
{
    const Likeness cubes = likeness_of("cubes", scene_of(100, DomainKind::wide), {});
    EXPECT_EQ(cubes.kind, LikenessKind::not_its_scene);
    EXPECT_FALSE(cubes.is_compared());
    EXPECT_TRUE(cubes.reason.empty());
}
