#pragma once

#include "core/mesh/scene.h"
#include "core/rays/camera.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// Where a scene's triangles come from.
enum class SceneSource {
    cubes,      ///< embedded: tets made directly, no TetGen
    procedural, ///< a mesh that is made here; tets by the builder
    points,     ///< points that are made here; their Delaunay tets by the builder
    lattice,    ///< embedded as cubes are, of any size
    file,       ///< a mesh file: of Debian's libcgal-demo, or the user's
};

/// A generator of meshes of any size, or of points.
struct ProceduralMesh {
    std::uint32_t least, most;                                  ///< triangles, or points, that a name can ask for
    TriangleMesh (*usual)();                                    ///< without a number; null for points
    TriangleMesh (*make)(std::uint32_t triangles);              ///< with about this many triangles; null for points
    std::string (*make_points)(std::uint32_t points) = nullptr; ///< text of a .node file; null for triangles
    std::uint32_t usual_points = 0;
};

/// One row of the catalogue: adding a scene is adding a row.
struct CatalogueEntry {
    std::string name;
    SceneSource source;
    std::string description;
    std::string archive_member;          ///< path inside the package's data archive; empty if the scene is made here
    std::vector<std::string> file_names; ///< what the mesh may be called in a folder that the user names
    std::optional<ProceduralMesh> procedural = {}; ///< if that is the source
    std::vector<Aim> views = {};                   ///< its own, of camera set `frame`: own_view_count of them, or none
};
[[nodiscard]] const std::vector<CatalogueEntry>& catalogue();

/// A procedural scene that a name asks for.
struct ProceduralScene {
    const CatalogueEntry& entry;
    std::optional<std::uint32_t> triangles; ///< or points; empty: as many as usual
};
/// Of a name "NAME" or "NAME@N" whose NAME is a procedural row; empty for another name. Throws Error{usage} if N is not
/// a number in the row's range.
[[nodiscard]] std::optional<ProceduralScene> find_procedural(const std::string& name);

/// Cubes along an axis that `lattice` can have; of these more than 563 have more tets than half-faces can name.
inline constexpr std::uint32_t min_lattice = 4, max_lattice = 563;
/// What `lattice` has where no number is given: 200 MB in layout half32.
inline constexpr std::uint32_t usual_lattice = 64;
[[nodiscard]] constexpr std::uint64_t lattice_tets(std::uint64_t resolution)
{
    return 6 * resolution * resolution * resolution;
}
/// N of a name "lattice:N"; usual_lattice of "lattice"; empty for another name. Throws Error{usage} if N is not a
/// number in that range.
[[nodiscard]] std::optional<std::uint32_t> lattice_resolution(const std::string& name);
/// Whether its tets are made in place, with nothing built and nothing cached: `cubes` and `lattice`.
[[nodiscard]] bool is_made_in_place(const std::string& name);

/// The optimiser's effort where none is asked for (scenes/optimise/optimise.h).
inline constexpr int usual_effort = 2;

/// How a scene's tets are to be made. Part of the scene's key. See default_build() for tets for rays.
struct BuildOptions {
    DomainKind domain = DomainKind::tight;
    std::uint32_t divisions = 8;
    std::string switches = "pq5Y"; ///< TetGen's, as in its manual; results/switches.md says why these
    bool repair = true;            ///< cut triangles of a mesh that cross, in place of refusing it
    TetsKind tets = TetsKind::cdt;
    int effort = usual_effort;     ///< of the optimiser, 0 to 3; for TetsKind::rays
    std::uint32_t resolution = 16; ///< of `cubes`: cubes along each axis
    double time_limit_s = 600;     ///< of processor time, for the builder
    double optimise_s = 0;         ///< for its optimiser; 0: half of time_limit_s
    std::uint64_t memory_limit_bytes = std::uint64_t{8} << 30;
    bool mesh_will_do = false;    ///< whether a scene without tets is loaded if triangles cross or TetGen fails
    bool keep_unfinished = false; ///< whether Ctrl-C lets the optimiser end with what it has reached
    bool optimise_own = false;    ///< whether TetsKind::rays is for the tets of a file of tets too
};

/// The options of a kind of tets where nothing else is asked for. Tets for rays have switches without q: their points
/// are another set (docs/spec/rays-tets.md).
[[nodiscard]] BuildOptions default_build(TetsKind tets);

/// Whether the tets are those of default_build(TetsKind::rays): limits of time and memory may differ.
[[nodiscard]] bool is_usual_build(const BuildOptions& build);

/// A scene that the user asked for: a name of the catalogue, a pinned scene (scenes/pinned.h), `NAME@N` of a procedural
/// one, `lattice:N`, or the path of a mesh file or a `.tet` file.
struct SceneRequest {
    std::string name; ///< as given; rows show scene_label()
    BuildOptions build;
    bool is_default = false; ///< nobody named it: of a pinned scene whose mesh is another one here, that mesh will do
};

/// The row of that name, or null.
[[nodiscard]] const CatalogueEntry* find_in_catalogue(const std::string& name);

/// Short name for rows: the catalogue's name, of pinned scenes too, or the file's stem.
[[nodiscard]] std::string scene_label(const std::string& name);

/// Empty if the scene's mesh is available here, else the reason and how to get it.
[[nodiscard]] std::string why_not_available(const std::string& name);

/// The scenes of `make bench`: bunny and armadillo if their meshes are installed, else `cubes` and `banana`; and
/// `atrium`. Without a builder, only those that need none or may be in the cache: bunny and armadillo, or `cubes`.
[[nodiscard]] std::vector<std::string> default_scenes();

/// Every scene of the catalogue that is available here, except `lattice` and `field`, whose size is the user's choice.
[[nodiscard]] std::vector<std::string> all_scenes();

} // namespace tetrace
