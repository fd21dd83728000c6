#pragma once

#include "core/base/stopwatch.h"
#include "core/mesh/domain.h"
#include "core/mesh/scene.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/builder/convert_tets.h"
#include "scenes/builder/own_tets.h"
#include "scenes/builder/raw_tets.h"
#include "scenes/builder/repair/repair.h"
#include "scenes/optimise/optimise.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace tetrace {

/// How a mesh came into domain units.
struct Placement {
    int scale_exponent = 0;                ///< domain units = mesh units * 2^scale_exponent
    std::uint64_t snapped_coordinates = 0; ///< coordinates that the 2^-40 grid rounded; every other one is exact
    double moved = 0;                      ///< the largest distance by which that moved a vertex; mesh units
};

/// Scales a mesh by a power of two, so that its domain is in [-1, 1]^3 and exceeds 1/2, and rounds coordinates to the
/// grid of core/base/exact.h. No translation. The mesh has at least one vertex, all finite.
Placement place(TriangleMesh& mesh, DomainKind kind);

/// The number of pieces of a mesh: triangles with a common vertex are in the same one.
[[nodiscard]] std::size_t count_pieces(const TriangleMesh& mesh);

/// What the command line asks for.
struct BuilderOptions {
    std::filesystem::path mesh, out;
    std::string name; ///< empty: the mesh file's name without extension
    DomainKind domain = DomainKind::tight;
    std::uint32_t divisions = 8;
    std::string switches = "pq5Y"; ///< TetGen's, or cgal_switches
    std::uint32_t order = 0; ///< in which TetGen gets the mesh (run_tetgen); from 100 on it also gets the sides of
                             ///< the domain in order / 100 squares each way, in place of `divisions`
    bool repair = false;     ///< cut triangles that cross
    double weld = 0;         ///< repair: with at least this tolerance, domain units; 0: only if it must be
    TetsKind tets = TetsKind::cdt;
    int effort = default_effort; ///< of the optimiser, for TetsKind::rays
    bool as_read = false;        ///< nothing is built: the triangles are written as the file has them (raw_mesh.h)
    bool mesh_only = false;      ///< no tets: the mesh is read, cleaned and placed in its domain
    double tetgen_for_s = 0;     ///< TetGen has failed if it takes more processor time; 0: no limit
    double optimise_for_s = 300; ///< the optimiser stops then, with what it has reached; 0: no limit
    bool optimise_own = false;   ///< whether TetsKind::rays is for the tets of a file of tets too
    std::filesystem::path prepared =
        {}; ///< the mesh as repaired and placed: read if it is there, else written; empty: no
};

/// Called with the stage that begins, and with notes for the user, one line each; and with what a stage reports of
/// itself.
struct BuilderTalk {
    std::function<void(const std::string&)> stage, note;
    std::function<void(double fraction, const std::string& detail)> progress = {};
};

/// Everything that TetGen needs; scene.tets is empty.
struct PreparedScene {
    Scene scene;
    TriangleMesh surface; ///< the domain's
    std::vector<Float3>
        points; ///< more vertices for TetGen; if tets are for rays, switches lack q and O0, and nothing is welded
    OptimiserLimits limits;
    Stopwatch watch;  ///< since its mesh was read
    OwnTets own = {}; ///< of a file of tets; they stay as they are, unless limits.closed_too

    /// The triangles that TetGen keeps.
    [[nodiscard]] const TriangleMesh& facets() const { return own.tets.empty() ? scene.mesh : own.hull; }
};

/// This program and the libraries that decide a scene, with their versions.
[[nodiscard]] std::string builder_tool();

/// Reads, cleans, places and checks a mesh, or repairs it, and makes its domain; or reads the file of a run before that
/// did so with the same options, but for those of TetGen and the optimiser. A file of tets is read each time.
/// Throws Error as read_mesh and make_domain do, and BuilderFailure{BUILDER_SELF_INTERSECTION} with the first pairs, or
/// as repair() does.
[[nodiscard]] PreparedScene prepare_scene(const BuilderOptions& options, const BuilderTalk& talk);

/// Why optimised tets may not take the place of the scene's own: they cost no less, or fail a check. Empty if they
/// may.
[[nodiscard]] std::string objection_to(const OptimisedTets& result, const Scene& scene);

/// Joins raw tets with those of the file, if it has some. Converts them and checks them: structure, orientation, every
/// input triangle covered, the domain filled, the entry grid complete. Throws BuilderFailure{BUILDER_ABSURD_OUTPUT}
/// naming the check that failed. Then optimises the tets, if they are for rays, those of a file only if they are to be
/// (these keep their regions, and lose their numbers); what that cannot improve, or what fails
/// a check, stays as it was, with the reason.
[[nodiscard]] Scene finish_scene(PreparedScene prepared, const RawTets& filled, const BuilderTalk& talk);

} // namespace tetrace
