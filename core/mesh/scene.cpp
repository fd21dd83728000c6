#include "core/mesh/scene.h"

#include "core/base/hash.h"

namespace tetrace {

std::string_view name_of(TetsKind kind)
{
    return kind == TetsKind::cdt ? "cdt" : "rays";
}

std::uint64_t scene_hash(const Scene& scene)
{
    std::uint64_t hash = hash_of(scene.mesh.vertices);
    hash = hash_of(scene.mesh.triangles, hash);
    hash = hash_of(scene.tets.vertices, hash);
    hash = hash_of(scene.tets.tets, hash);
    for (const auto& lines : scene.domain.lines)
        hash = hash_of(lines, hash);
    const std::uint32_t kind[] = {static_cast<std::uint32_t>(scene.domain.kind), scene.domain.divisions};
    return hash_of(kind, hash);
}

} // namespace tetrace
