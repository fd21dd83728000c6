#pragma once

#include "bench/rows/rows.h"
#include "core/rays/ray_set.h"

#include <cstddef>
#include <map>
#include <tuple>
#include <vector>

namespace tetrace {

class SceneWork;

/// The given rays of a scene's rows, made at the first request and kept.
class RayStore {
public:
    /// The rays of a view (an index in SceneWork::views()). For task trace, kernels make those of kind primary
    /// themselves.
    /// Throws Error{internal} if openmp cannot trace the primary rays that they are made from.
    [[nodiscard]] const RaySet& set(SceneWork& scene, RayKind kind, RayOrder order, std::size_t view);

    /// The same in the form that a kernel's session takes for its task: from a tet of the packed scene for the cdt. For
    /// BVHs, whose rays start off the surface, packed may be null.
    [[nodiscard]] const std::vector<Quad>& rows(SceneWork& scene, const RowKey& key, const PackedScene* packed,
                                                std::size_t view);

private:
    using SetKey = std::tuple<RayKind, RayOrder, std::size_t>;

    [[nodiscard]] const std::vector<Hit>& primary_hits(SceneWork& scene, std::size_t view);

    std::map<std::size_t, std::vector<Hit>> primary_hits_; ///< by view
    std::map<SetKey, RaySet> sets_;
    std::map<std::tuple<SetKey, Task, Structure, TetOrder>, std::vector<Quad>>
        rows_; ///< shared by a structure's layouts
};

} // namespace tetrace
