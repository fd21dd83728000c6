#include "backends/openmp/session.h"

namespace tetrace::openmp {

OpenmpSession::OpenmpSession(const CompiledKernel& kernel, Task task, const PackedScene& scene, unsigned threads,
                             unsigned tile_height)
    : HostSession(task), kernel_(kernel), searches_(task == Task::search), scene_(scene), threads_(threads),
      tile_height_(tile_height)
{
}

void OpenmpSession::run(const TraceJob& job, std::span<std::uint32_t> output)
{
    if (searches_)
        kernel_.search(scene_, rays_.data(), job, output.data(), threads_, tile_height_);
    else
        kernel_.trace(scene_, job, as_hits(output).data(), threads_, tile_height_);
}

} // namespace tetrace::openmp
