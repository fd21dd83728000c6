#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "scenes/catalogue.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// The program that makes CDTs: the one that TETRACE_BUILDER names, else `tetrace-builder` next to the running program,
/// else in PATH; empty if none can be executed.
[[nodiscard]] std::filesystem::path find_builder();

/// A way to make tets.
struct TetsAttempt {
    std::string switches;
    std::uint32_t order = 0; ///< in which TetGen gets the mesh, and the domain's sides: the builder's --order
    double weld = 0;         ///< tolerance of the repair; 0: only if it needs one

    friend bool operator==(const TetsAttempt&, const TetsAttempt&) = default;
};

/// What a build tries, in this order, if TetGen fails with the options' own switches; none if the user chose those.
/// TetGen's own optimiser may take minutes on near layers, and tets for rays have ours (hence O0); some layers are
/// nearer than its tolerance (T1e-13). TetGen crashes on some meshes in one order of vertices and not in another, most
/// often where it removes Steiner points (hence Y0/2/2); or with the domain's sides in some number of squares and not
/// in another; on some with pY and not with pq5Y, on others the other way round; and refuses some with pq5Y and not
/// with facets that stay apart (M) and a finer tolerance (T), or without Y and q. Where layers are too near to each
/// other for it, a repair merges them. At last CGAL makes the tets, if the builder has a CGAL that does. Figures:
/// results/repair.md.
[[nodiscard]] std::vector<TetsAttempt> fallback_attempts(const BuildOptions& options);

/// A build that left a scene.
struct BuildEnd {
    bool interrupted = false;     ///< Ctrl-C came; with keep_unfinished there may be a scene nevertheless
    std::optional<Error> no_tets; ///< with mesh_will_do: why the scene is without tets
};

/// Runs tetrace-builder on a mesh file within the options' limits; it writes `out`. If TetGen fails, runs it again with
/// each of fallback_attempts() in what is left of the time, until one of them will do.
/// If triangles cross, or TetGen fails with all of them, crashes, or reaches the limit of time or memory, and the mesh
/// will do, the builder
/// is run once more for only the mesh, within the same limits, but at least a minute. notes: the builder's remarks are
/// appended. progress: called with the stage about ten times per second. Throws Error; its text says how the builder
/// ended, its switches, its last stage and what to try. Kinds: missing (no builder, or a file that it needs),
/// interrupted (Ctrl-C), internal (a fault of the builder), usage (switches or divisions that it does not accept), else
/// invalid_input.
[[nodiscard]] BuildEnd build_scene(const std::filesystem::path& mesh, const std::filesystem::path& out,
                                   const std::string& label, const BuildOptions& options, const Progress& progress,
                                   std::vector<std::string>& notes);

/// Runs tetrace-builder for only the mesh, cleaned, repaired if that is asked for, and placed in its domain; it writes
/// `out`, a scene without tets. Throws as build_scene() does.
void build_mesh_only(const std::filesystem::path& mesh, const std::filesystem::path& out, const std::string& label,
                     const BuildOptions& options, const Progress& progress, std::vector<std::string>& notes);

/// Runs tetrace-builder for only the triangles of a mesh file as it has them: not cleaned, not placed, every number as
/// it is read. It writes `out`, which read_raw_mesh() reads. Throws as build_scene() does, and Error{invalid_input} for
/// a mesh whose coordinates have to be centred before they are rounded to float32.
void read_mesh_only(const std::filesystem::path& mesh, const std::filesystem::path& out, const std::string& label,
                    const Progress& progress, std::vector<std::string>& notes);

} // namespace tetrace
