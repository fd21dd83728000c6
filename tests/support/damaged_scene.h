#pragma once

#include "scenes/procedural.h"
#include "tests/support/random.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tetrace::test {

/// Cubes whose free faces lead to random tets: a walk enters tets that its ray misses, and may get lost.
/// size: cubes along an axis.
inline Scene make_damaged_cubes(std::uint32_t size)
{
    Scene scene = make_cubes(size);
    auto& tets = scene.tets.tets;
    const auto count = static_cast<std::uint32_t>(tets.size());
    Random random(30);
    for (Tet& tet : tets)
        for (std::size_t face = 0; face < 4; ++face)
            if (tet.neighbours[face] != NO_HALF_FACE && tet.faces[face] == FREE_FACE)
                tet.neighbours[face] = make_half_face(random.below(count), random.below(4));
    return scene;
}

} // namespace tetrace::test
