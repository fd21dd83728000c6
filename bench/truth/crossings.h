#pragma once

#include "bench/truth/oracle.h"
#include "core/mesh/scene.h"
#include "core/rays/segments.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tetrace {

/// A walk that is said to be a ray's, tet by tet. It is a claim: what it shows is judged.
struct CrossedTets {
    std::vector<std::uint32_t> tets;   ///< in packed order
    std::vector<std::uint32_t> places; ///< of its beginning, then of the face by which it leaves each tet
};

/// The answer that a walk makes: its tets and places, counted, hashed and summed (docs/spec/volume.md, S4 and S5).
[[nodiscard]] Segments summary_of(const CrossedTets& walk);

/// Judges the answers to given rays of a task that crosses tets (docs/spec/volume.md, S7 and S12). Shares nothing with
/// the kernels but the walk, which the answer must follow from, and which is judged in double precision with margins. A
/// ray whose exact line crosses the same tets has agreed; another is a tie, with the largest distance of its faces from
/// the ray. answers: by ray, in the set's order. mesh_of_packed: the scene's number of each packed tet. walk_of: the
/// walk of a ray by its number, called by several threads; empty if it crosses no tet. threads: 0 is all.
[[nodiscard]] Verdicts judge_crossings(Task task, const Scene& scene, const RaySet& set, std::span<const Hit> answers,
                                       std::span<const std::uint32_t> mesh_of_packed,
                                       const std::function<CrossedTets(std::size_t)>& walk_of, unsigned threads);

} // namespace tetrace
