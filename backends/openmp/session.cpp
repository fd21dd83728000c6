#include "backends/openmp/session.h"

namespace tetrace::openmp {

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
