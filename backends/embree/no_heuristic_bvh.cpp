// In place of heuristic_bvh.cpp in a build without Embree (TETRACE_SMALL).
#include "backends/embree/heuristic_bvh.h"

namespace tetrace {

HeuristicBvh build_heuristic_bvh(const TriangleMesh&, unsigned, std::uint32_t)
{
    return {{}, "this build of tetrace is without Embree"};
}

} // namespace tetrace
