#pragma once

#include "core/device/backend.h"

namespace tetrace::openmp {

/// Does all rays of a job, tile after tile. rays: the quads of those that are given, empty for task
/// trace. output: words_per_ray() a ray, row after row.
using RunFunction = void(const PackedScene& scene, std::span<const Quad> rays, const TraceJob& job,
                         std::span<std::uint32_t> output, unsigned threads, unsigned tile_height);

/// One compiled kernel by task, null where it has none; CMake compiles kernel.cpp once for each.
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

/// The BVHs' kernels in exact mode, compiled to count what a ray visits: a hit's `tet` is the number of nodes that were
/// fetched for it, its `steps` that of the triangles tested; all else is as compiled_kernels() have it. Never timed.
[[nodiscard]] const std::vector<CompiledKernel>& counting_kernels();

/// The function of a kernel, of any schedule, in such a list; null where the list has none.
[[nodiscard]] RunFunction* find_function(const std::vector<CompiledKernel>& kernels, KernelId id);

} // namespace tetrace::openmp
