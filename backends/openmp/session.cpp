#include "backends/openmp/session.h"

namespace tetrace::openmp {

OpenmpSession::OpenmpSession(TraceFunction kernel, const PackedScene& scene, unsigned threads)
    : kernel_(kernel), scene_(scene), threads_(threads)
{
}

void OpenmpSession::trace(const TraceJob& job, std::span<Hit> hits)
{
    kernel_(scene_, job, hits.data(), threads_);
}

} // namespace tetrace::openmp
