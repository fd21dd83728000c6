#pragma once

#include "bench/rows/scene_work.h"
#include "core/base/enum_names.h"

#include <string>
#include <string_view>

namespace tetrace {

/// How like the paper's a scene and its tets are.
enum class LikenessKind {
    not_its_scene, ///< not a scene of the paper
    other_mesh,    ///< the same object, of another number of triangles: no ratio to the paper's numbers means anything
    tets_for_rays, ///< its mesh, in tets that are not a CDT
    other_tets,    ///< its mesh, as near as there is one, in another domain or with other counts of tets and faces
    near_counts,   ///< a domain as the paper's, and all counts within near_counts_tolerance
    papers_counts  ///< and within equal_counts_tolerance
};
template <>
inline constexpr auto
    enum_names<LikenessKind> = names_up_to<LikenessKind::papers_counts>("not its scene", "other mesh", "tets for rays",
                                                                        "other tets", "near its counts", "its counts");

/// Shares of the paper's numbers. Counts of one mesh vary by 0.2 % with the order of its triangles, and more between
/// versions of TetGen.
inline constexpr double equal_counts_tolerance = 0.02, near_counts_tolerance = 0.1;

/// Whether numbers of a scene may be compared with the paper's, and why.
struct Likeness {
    LikenessKind kind = LikenessKind::not_its_scene;
    std::string reason; ///< a sentence with the numbers for the kind; empty if it is not the paper's scene

    /// Whether ratios of our numbers to the paper's are given, and its claims about the scene decided.
    [[nodiscard]] bool is_compared() const { return kind >= LikenessKind::other_tets; }
};

/// scene: the paper's name of it. counts: of the loaded scene's tets.
[[nodiscard]] Likeness likeness_of(std::string_view scene, const Scene& loaded, const TetMeshCounts& counts);

/// Whether the numbers are equal within a share of the paper's.
[[nodiscard]] bool is_within(double ours, double papers, double tolerance);

} // namespace tetrace
