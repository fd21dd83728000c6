#pragma once

#include "scenes/optimise/editable_mesh.h"

#include <algorithm>
#include <vector>

namespace tetrace::test {

/// As `least` of an operation: whatever is possible is done.
inline constexpr double anything = -1e9;

/// The tets' vertices, in an order that does not depend on how they came to be.
[[nodiscard]] inline std::vector<Corners> corners_of(const EditableMesh& mesh)
{
    std::vector<Corners> all;
    for (const Tet& tet : mesh.take().tets) {
        all.push_back(tet.vertices);
        std::sort(all.back().begin(), all.back().end());
    }
    std::sort(all.begin(), all.end());
    return all;
}

} // namespace tetrace::test
