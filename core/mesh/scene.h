#pragma once

#include "core/mesh/domain.h"
#include "core/mesh/tet_mesh.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <string>

namespace tetrace {

/// How a scene was made; recorded with every result.
struct BuildInfo {
    std::string source;            ///< the mesh file's name, or the generator
    std::uint64_t source_hash = 0; ///< XXH3 of the mesh file's bytes
    std::string switches;          ///< TetGen's switches as passed; empty where no TetGen ran
    std::string tool;              ///< program and version that made the tets
    double build_s = 0;            ///< seconds from mesh file to checked tets
    int scale_exponent = 0;        ///< domain units = mesh units * 2^scale_exponent
    std::uint64_t merged_vertices = 0;
    std::uint64_t degenerate_triangles = 0;
    std::uint64_t duplicate_triangles = 0;
    std::uint64_t snapped_coordinates = 0; ///< coordinates rounded to the 2^-40 grid (only those below 2^-16)

    friend bool operator==(const BuildInfo&, const BuildInfo&) = default;
};

/// A triangle mesh placed in its domain, and the CDT of the two. Independent of any packed layout.
struct Scene {
    std::string name;
    TriangleMesh mesh; ///< the input triangles in domain units: what face_id counts, what Embree and the oracle get
    TetMesh tets;
    Domain domain;
    BuildInfo build;

    friend bool operator==(const Scene&, const Scene&) = default;
};

/// 64-bit hash of all that decides a ray's answer: mesh, tets, domain. Neither name nor build time is part of it.
[[nodiscard]] std::uint64_t scene_hash(const Scene& scene);

} // namespace tetrace
