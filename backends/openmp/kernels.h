#pragma once

#include "core/backend.h"

namespace tetrace::openmp {

/// Does all rays of a job, tile after tile, on so many threads. rays: the rows of those that are given, empty for task
/// trace. output: words_per_ray() a ray, row after row.
using RunFunction = void(const PackedScene& scene, std::span<const Row> rays, const TraceJob& job,
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

} // namespace tetrace::openmp
