#include "backends/openmp/session.h"

namespace tetrace::openmp {

OpenmpSession::OpenmpSession(TraceFunction kernel, const PackedScene& scene, unsigned threads, unsigned tile_height)
    : kernel_(kernel), scene_(scene), threads_(threads), tile_height_(tile_height)
{
}

void OpenmpSession::trace(const TraceJob& job, std::span<Hit> hits)
{
    kernel_(scene_, job, hits.data(), threads_, tile_height_);
}

} // namespace tetrace::openmp
