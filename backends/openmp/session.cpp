#include "backends/openmp/session.h"

#include <algorithm>

namespace tetrace::openmp {

RunFunction* find_function(const std::vector<CompiledKernel>& kernels, KernelId id)
{
    const Task task = id.task;
    id.task = Task::trace;
    id.schedule = Schedule::tiles;
    const auto found =
        std::find_if(kernels.begin(), kernels.end(), [&](const CompiledKernel& kernel) { return kernel.id == id; });
    return found == kernels.end() ? nullptr : found->function(task);
}

OpenmpSession::OpenmpSession(RunFunction* function, Task task, const PackedScene& scene, unsigned threads,
                             unsigned tile_height)
    : HostSession(task), run_(function), scene_(scene), threads_(threads), tile_height_(tile_height)
{
}

void OpenmpSession::run(const TraceJob& job, std::span<std::uint32_t> output)
{
    run_(scene_, rays_, job, output, threads_, tile_height_);
}

} // namespace tetrace::openmp
