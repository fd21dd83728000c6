#include "bench/reproduce/likeness.h"

#include "bench/reproduce/paper.h"
#include "bench/terminal/text.h"

#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// A mesh that has the paper's number of triangles within this share is taken for its mesh, or near enough: Debian's
/// bunny has 9 % more than Stanford's, and the counts of its tets are within 3 % of the paper's.
constexpr double mesh_tolerance = 0.1;

bool are_within(const TetMeshCounts& counts, const paper::SceneFigures& papers, double share)
{
    const auto is_near = [&](std::uint64_t ours, std::uint64_t theirs) {
        return is_within(static_cast<double>(ours), static_cast<double>(theirs), share);
    };
    return is_near(counts.tets, papers.tets) && is_near(counts.occlusive_faces, papers.occlusive_faces) &&
           is_near(counts.free_faces, papers.free_faces);
}

std::string counts_text(const TetMeshCounts& counts, const paper::SceneFigures& papers)
{
    return fmt::format("{} tets, {} occlusive and {} free faces, the paper's {}, {} and {}", with_commas(counts.tets),
                       with_commas(counts.occlusive_faces), with_commas(counts.free_faces), with_commas(papers.tets),
                       with_commas(papers.occlusive_faces), with_commas(papers.free_faces));
}

std::string other_mesh_text(std::size_t triangles, const paper::NearestBuild& nearest)
{
    return fmt::format("another mesh: {} triangles, but the paper's counts are from {}; ratios to its numbers would "
                       "mean nothing. A folder with that mesh can be named in TETRACE_MESHES.",
                       with_commas(triangles), with_commas(nearest.triangles));
}

} // namespace

bool is_within(double ours, double papers, double share)
{
    return std::abs(ours - papers) <= share * papers;
}

Likeness likeness_of(std::string_view scene, const Scene& loaded, const TetMeshCounts& counts)
{
    const auto papers = paper::figures_of(scene);
    const auto nearest = paper::nearest_build(scene);
    if (!papers || !nearest) return {};
    const std::size_t triangles = loaded.mesh.triangles.size();
    if (!is_within(static_cast<double>(triangles), static_cast<double>(nearest->triangles), mesh_tolerance))
        return {LikenessKind::other_mesh, other_mesh_text(triangles, *nearest)};
    if (loaded.build.optimised.asked == TetsKind::rays)
        return {LikenessKind::tets_for_rays,
                fmt::format("no CDT: {} tets that were changed for rays, which the paper does not have.",
                            with_commas(counts.tets))};
    const std::string text = counts_text(counts, *papers);
    if (loaded.domain.kind != DomainKind::wide)
        return {LikenessKind::other_tets, "another domain, which does not hold the cameras: " + text + '.'};
    if (are_within(counts, *papers, equal_counts_tolerance))
        return {LikenessKind::papers_counts,
                fmt::format("{}: all within {:.0f} %.", text, 100 * equal_counts_tolerance)};
    if (are_within(counts, *papers, near_counts_tolerance))
        return {LikenessKind::near_counts, fmt::format("{}: all within {:.0f} %.", text, 100 * near_counts_tolerance)};
    return {LikenessKind::other_tets, "another tetrahedralization: " + text + '.'};
}

} // namespace tetrace
