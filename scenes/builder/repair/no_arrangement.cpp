#include "scenes/builder/failure.h"
#include "scenes/builder/repair/arrangement.h"

#include <fmt/format.h>

// In place of arrangement.cpp for a first table, whose scene needs no repair.

namespace tetrace {

CutMesh cut_along_intersections(const TriangleMesh&, std::span<const TrianglePair> pairs)
{
    throw BuilderFailure(
        BUILDER_SELF_INTERSECTION,
        fmt::format("{} pairs of triangles cross, and this tetrace-builder, built for a first table, cuts "
                    "none; build all of tetrace (`make build`)",
                    pairs.size()));
}

} // namespace tetrace
