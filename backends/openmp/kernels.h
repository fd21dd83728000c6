#pragma once

#include "core/device/backend.h"
#include "core/device/team.h"

#include <array>

namespace tetrace::openmp {

/// Traces what this thread takes of a job's tiles. rays: the quads of given rays, empty for task trace. output: of the
/// whole job, words_per_ray() per ray, row after row; of task tally then two words per tet.
using RunFunction = void(const PackedScene& scene, std::span<const Quad> rays, const TraceJob& job,
                         std::span<std::uint32_t> output, SharedTiles& shared, unsigned tile_height);

/// One compiled kernel. CMake compiles kernel.cpp once for each kernel.
struct CompiledKernel {
    KernelId id;                                                 ///< of task trace and schedule tiles
    std::array<RunFunction*, enum_names<Task>.size()> functions; ///< in the order of Task; null for tasks that it lacks

    [[nodiscard]] RunFunction* function(Task task) const { return functions[static_cast<std::size_t>(task)]; }
};
[[nodiscard]] const std::vector<CompiledKernel>& compiled_kernels();

/// The BVHs' kernels in exact mode, compiled to count what a ray visits: a hit's `tet` is the number of nodes fetched,
/// its `steps` the number of triangles tested; all else is as in compiled_kernels(). Never timed.
[[nodiscard]] const std::vector<CompiledKernel>& counting_kernels();

/// Those of schedule native, compiled for x86-64-v3 (host_has_fused_multiply() says whether they run); all else is as
/// in compiled_kernels().
[[nodiscard]] const std::vector<CompiledKernel>& native_kernels();

/// What a ray crosses, in order.
struct Crossings {
    std::vector<std::uint32_t> tets;   ///< in packed order
    std::vector<std::uint32_t> places; ///< of the walk's beginning, and of the face by which each tet is left
};

/// Walks as task segments does, or as task absorb does, and notes each tet. direction, origin: the ray's quads. noted:
/// empty for a ray that crosses no tet. Never timed.
using NoteFunction = void(const PackedScene& scene, bool absorbs, const Quad& direction, const Quad& origin,
                          std::uint32_t max_steps, Crossings& noted);

/// That of a kernel with task segments, in math mode exact; null if there is none.
[[nodiscard]] NoteFunction* find_note_function(KernelId id);

/// The function of a kernel in such a list, for any schedule; null if the list has none.
[[nodiscard]] RunFunction* find_function(const std::vector<CompiledKernel>& kernels, KernelId id);

} // namespace tetrace::openmp
