#pragma once

#include "core/pack/kernel_id.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// A timed row as far as comparing tets with BVHs needs it, whether it is of a run, a result or a page.
struct Contender {
    std::string name;  ///< as texts call it: "bvh packet16 on embree"
    std::string arena; ///< equal: the same rays on the same device. An emulated device is one of its own
    bool is_bvh = false;
    bool is_embree = false;
    bool is_single = true; ///< traces one ray at a time, as is_single_ray() says
    double mrays_per_s = 0;
};

/// Which BVHs of an arena are asked about.
enum class BvhKind {
    any,
    our_single,   ///< of our own, those that trace one ray at a time
    embree_single ///< Embree's single rays
};

/// Whether a kernel traces one ray at a time: all but our packets, and Embree's packets and streams.
[[nodiscard]] bool is_single_ray(const KernelId& kernel);

/// The index of the fastest BVH of a kind in the arena of a row: what the row's rate is compared with. It may be the
/// row itself. Empty if the arena has none.
[[nodiscard]] std::optional<std::size_t> best_bvh(const std::vector<Contender>& rows, std::size_t row,
                                                  BvhKind kind = BvhKind::any);

/// How every printed ratio of tets to a BVH calls the BVH: "the fastest BVH, bvh packet16 on embree", or only "bvh bvh2
/// on openmp" if the arena has a faster one. No ratio is printed without it, so that none hides which BVH it is over.
[[nodiscard]] std::string bvh_text(const std::vector<Contender>& rows, std::size_t bvh);

} // namespace tetrace
