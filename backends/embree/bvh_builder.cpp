#include "backends/embree/bvh_builder.h"

#include "backends/embree/heuristic_bvh.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/bvh/bvh.h"

#include <cfenv>
#include <limits>

namespace tetrace {
namespace {

void check_bvh_input(const TriangleMesh& mesh)
{
    const auto refuse = [](const std::string& reason) {
        throw Error(ErrorKind::invalid_input, "building a BVH: " + reason);
    };
    if (mesh.triangles.empty()) refuse("the mesh is empty; it needs at least one triangle");
    if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max() / 4)
        refuse(std::to_string(mesh.triangles.size()) + " triangles, at most 2^30 can be numbered");
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const auto v : mesh.triangles[i]) {
            if (v >= mesh.vertices.size()) refuse("triangle " + std::to_string(i) + " has a missing corner");
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(mesh.vertices[v][axis]) <= max_bvh_coordinate))
                    refuse("triangle " + std::to_string(i) + " has a corner that is not finite or exceeds " +
                           std::to_string(static_cast<int>(max_bvh_coordinate)) +
                           " domain units; place the mesh in the domain");
        }
    }
}

} // namespace

BuiltBvh build_bvh(const TriangleMesh& mesh, unsigned threads, std::uint32_t max_depth)
{
    check_bvh_input(mesh);
    const Stopwatch watch;
    std::fenv_t environment; // Embree asserts rounding to nearest, and may leave the thread flushing denormals
    std::fegetenv(&environment);
    std::fesetenv(FE_DFL_ENV);
    HeuristicBvh tree = build_heuristic_bvh(mesh, threads, max_depth);
    std::fesetenv(&environment);

    BuiltBvh built;
    built.bvh = tree.bvh ? std::move(*tree.bvh) : build_balanced_bvh(mesh);
    if (!tree.bvh) built.fall_back = "triangles are halved by number: " + tree.why_not;
    built.spatial_splits = built.bvh.references.size() - mesh.triangles.size();
    built.build_s = watch.seconds();
    return built;
}

} // namespace tetrace
