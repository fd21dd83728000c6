#include "core/mesh/scene.h"

#include "core/base/hash.h"

#include <cmath>

namespace tetrace {

BoundingSphere source_sphere(const Scene& scene)
{
    const BoundingSphere placed = bounding_sphere(scene.mesh);
    const double unit = std::ldexp(1.0, -scene.build.scale_exponent);
    return {placed.centre * unit + scene.build.centre, placed.radius * unit};
}

std::uint32_t source_triangle(const Scene& scene, std::uint32_t face_id)
{
    return face_id < scene.origins.size() ? scene.origins[face_id] : face_id;
}

std::uint64_t mesh_hash(const TriangleMesh& mesh)
{
    return hash_of(mesh.triangles, hash_of(mesh.vertices));
}

std::uint64_t scene_hash(const Scene& scene)
{
    std::uint64_t hash = mesh_hash(scene.mesh);
    hash = hash_of(scene.tets.vertices, hash);
    hash = hash_of(scene.tets.tets, hash);
    for (const auto& lines : scene.domain.lines)
        hash = hash_of(lines, hash);
    const std::uint32_t kind[] = {static_cast<std::uint32_t>(scene.domain.kind), scene.domain.divisions};
    return hash_of(kind, hash);
}

} // namespace tetrace
