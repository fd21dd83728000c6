#pragma once

#include "scenes/optimise/edge_removal.h"
#include "scenes/optimise/editable_mesh.h"
#include "scenes/procedural.h"

#include <algorithm>
#include <cstddef>
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

/// Least cost of all triangulations of an open ring, tried one by one; impossible where none may be made.
[[nodiscard]] inline double cheapest(const EditableMesh& mesh, const EdgeRing& ring, std::size_t i, std::size_t k)
{
    if (k - i < 2) return 0;
    const auto at = [&](std::size_t n) { return mesh.point(ring.vertices[n]); };
    const Double3 a = mesh.point(ring.a), b = mesh.point(ring.b);
    const bool on_side = k - i + 1 == ring.vertices.size(); // the faces at the last chord are on the boundary
    double best = impossible;
    for (std::size_t j = i + 1; j < k; ++j) {
        if (!may_be_made(a, at(i), at(j), at(k)) || !may_be_made(b, at(i), at(k), at(j))) continue;
        best = std::min(best, cheapest(mesh, ring, i, j) + cheapest(mesh, ring, j, k) + area(at(i), at(j), at(k)));
    }
    return best + (on_side ? 0 : area(a, at(i), at(k)) + area(b, at(i), at(k)));
}

/// The jittered cubes with their ball: occlusive faces, hidden tets, free and held vertices.
[[nodiscard]] inline const Scene& cubes()
{
    static const Scene scene = make_cubes(8);
    return scene;
}

} // namespace tetrace::test
