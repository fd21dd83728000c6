#pragma once

#include "core/device/backend.h"
#include "core/device/team.h"

namespace tetrace::openmp {

/// Traces what this thread takes of a job's tiles. rays: the quads of given rays, empty for task trace. output: of the
/// whole job, words_per_ray() per ray, row after row.
using RunFunction = void(const PackedScene& scene, std::span<const Quad> rays, const TraceJob& job,
                         std::span<std::uint32_t> output, SharedTiles& shared, unsigned tile_height);

/// One compiled kernel: a function per task, null for tasks that it does not have. CMake compiles kernel.cpp once for
/// each kernel.
struct CompiledKernel {
    KernelId id; ///< of task trace and schedule tiles
    RunFunction* trace;
    RunFunction* rays;
    RunFunction* search;

    [[nodiscard]] RunFunction* function(Task task) const
    {
        return task == Task::trace ? trace : task == Task::rays ? rays : search;
    }
};
[[nodiscard]] const std::vector<CompiledKernel>& compiled_kernels();

/// The BVHs' kernels in exact mode, compiled to count what a ray visits: a hit's `tet` is the number of nodes fetched,
/// its `steps` the number of triangles tested; all else is as in compiled_kernels(). Never timed.
[[nodiscard]] const std::vector<CompiledKernel>& counting_kernels();

/// Those of schedule native, compiled for x86-64-v3 (host_has_fused_multiply() says whether they run); all else is as
/// in compiled_kernels().
[[nodiscard]] const std::vector<CompiledKernel>& native_kernels();

/// The function of a kernel in such a list, for any schedule; null if the list has none.
[[nodiscard]] RunFunction* find_function(const std::vector<CompiledKernel>& kernels, KernelId id);

} // namespace tetrace::openmp
