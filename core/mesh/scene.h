#pragma once

#include "core/mesh/domain.h"
#include "core/mesh/tet_mesh.h"
#include "core/mesh/triangle_mesh.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// How the domain was filled with tets. Scene files hold the values.
enum class TetsKind {
    cdt = 0,  ///< TetGen's, a constrained Delaunay tetrahedralization; or those of `cubes`, unchanged
    rays = 1, ///< then changed so that rays cross fewer faces (scenes/optimise); no longer Delaunay
};

template <>
inline constexpr auto enum_names<TetsKind> = names_up_to<TetsKind::rays>("cdt", "rays");

/// Why the optimiser of tets ended. Scene files hold the values.
enum class OptimiserEnd {
    finished = 0,
    out_of_time = 1, ///< what it reached by then depends on the machine's speed
    interrupted = 2
};

template <>
inline constexpr auto enum_names<OptimiserEnd> = names_up_to<OptimiserEnd::interrupted>("finished", "out of time",
                                                                                        "interrupted");

/// What one kind of operation of the optimiser of tets did.
struct OptimiserOperation {
    std::string name;
    std::uint64_t done = 0;
    double gain = 0;    ///< by which it lowered the cost
    double seconds = 0; ///< of all threads together

    friend bool operator==(const OptimiserOperation&, const OptimiserOperation&) = default;
};

/// What the optimiser of tets did. Costs: free faces outside the objects (of a file of tets, inside too) that a uniform
/// line crosses.
struct OptimisedInfo {
    TetsKind asked = TetsKind::cdt;
    TetsKind tets = TetsKind::cdt; ///< what the scene has
    std::string reason;            ///< why these differ
    int effort = 0;
    double cost_before = 0, cost_after = 0; ///< 0 if no optimiser ran
    double seconds = 0;                     ///< part of BuildInfo::build_s
    std::uint32_t rounds = 0;
    std::vector<OptimiserOperation> operations = {};
    OptimiserEnd end = OptimiserEnd::finished;

    friend bool operator==(const OptimisedInfo&, const OptimisedInfo&) = default;
};

/// What was done to a mesh whose triangles cross or overlap.
struct RepairInfo {
    bool asked = false;               ///< whether triangles that cross were to be cut; else such a mesh is refused
    std::uint64_t crossing_pairs = 0; ///< pairs of the mesh's triangles that met outside a shared vertex or edge
    std::uint64_t cut_triangles = 0;  ///< triangles of the mesh that were cut
    std::uint64_t pieces = 0;         ///< triangles of the scene that are parts of these
    std::uint64_t dropped = 0;        ///< parts that lay on another, or that rounding left without area
    std::uint32_t passes = 0;         ///< rounding makes new crossings, so that pieces may be cut again
    double tolerance = 0;             ///< domain units; what was nearer was merged; 0: nothing was moved
    double moved = 0;                 ///< domain units; no vertex and no point of a face went farther

    friend bool operator==(const RepairInfo&, const RepairInfo&) = default;
};

/// How a scene was made; recorded with every result.
struct BuildInfo {
    std::string source;            ///< the mesh file's name, or the generator
    std::uint64_t source_hash = 0; ///< XXH3 of the mesh file's bytes
    std::string switches;          ///< TetGen's switches as passed; empty if no TetGen ran
    std::uint32_t order = 0;       ///< in which TetGen got vertices and triangles; 0: as they are
    std::string tool;              ///< program and version that made the tets
    double build_s = 0;            ///< seconds from mesh file to checked tets; 0: not known, the tets were stored
    Double3 centre{};       ///< what was subtracted from the file's coordinates before they were rounded to float
    double rounding = 0;    ///< largest distance by which rounding moved a vertex; mesh units
    int scale_exponent = 0; ///< domain units = (mesh units - centre) * 2^scale_exponent
    std::uint64_t merged_vertices = 0;
    std::uint64_t degenerate_triangles = 0;
    std::uint64_t duplicate_triangles = 0;
    std::uint64_t snapped_coordinates = 0; ///< coordinates rounded to the 2^-40 grid (only those below 2^-16)
    RepairInfo repair;
    OptimisedInfo optimised;

    friend bool operator==(const BuildInfo&, const BuildInfo&) = default;
};

/// What the user's own file of tets says of one of them.
struct SourceTet {
    std::uint32_t number = 0; ///< in the file, as its format counts; 0 if the tets were optimised
    std::int32_t region = 0;

    friend bool operator==(const SourceTet&, const SourceTet&) = default;
};

/// A triangle mesh placed in its domain, and a tetrahedralization of the two. Independent of any packed layout.
struct Scene {
    std::string name;
    TriangleMesh
        mesh; ///< the input triangles in domain units: what Hit::face_id counts, what Embree and the oracle get
    /// Of each triangle, the number of the source's triangle that it is, or is a part of; empty: they are the same.
    std::vector<std::uint32_t> origins = {};
    TetMesh tets;
    Domain domain;
    BuildInfo build;
    /// Of the first tets, if the mesh file has tets: they are the file's, in its order, or, if BuildInfo::optimised
    /// says so, others in the same regions. The rest fills the domain.
    std::vector<SourceTet> source_tets = {};

    friend bool operator==(const Scene&, const Scene&) = default;
};

/// The bounding sphere of the mesh in the coordinates of its file: what cameras refer to.
[[nodiscard]] BoundingSphere source_sphere(const Scene& scene);

/// The source's triangle of a Hit::face_id: what users see. What names no triangle (NO_HIT, LOST) stays.
[[nodiscard]] std::uint32_t source_triangle(const Scene& scene, std::uint32_t face_id);

/// 64-bit hash of the triangles that rays hit, in domain units: all of a scene that decides a BVH's answers.
[[nodiscard]] std::uint64_t mesh_hash(const TriangleMesh& mesh);

/// 64-bit hash of all that decides a ray's answer: mesh, tets, domain. Neither name nor origins nor build time is part
/// of it.
[[nodiscard]] std::uint64_t scene_hash(const Scene& scene);

} // namespace tetrace
