#include "backends/openmp/session.h"

#include <algorithm>
#include <cassert>
#include <chrono>

namespace tetrace::openmp {

OpenmpSession::OpenmpSession(TraceFunction trace, const PackedScene& scene, unsigned threads)
    : trace_(trace), scene_(scene), threads_(threads)
{
}

void OpenmpSession::launch(const TraceJob& job)
{
    const Hit poison{POISON, POISON, 0, 0, 0, POISON};
    hits_.assign(std::size_t{job.width} * job.height, poison);
    const auto start = std::chrono::steady_clock::now();
    trace_(scene_, job, hits_.data(), threads_);
    kernel_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double OpenmpSession::wait()
{
    return kernel_s_;
}

void OpenmpSession::read_back(std::span<Hit> hits)
{
    assert(hits.size() == hits_.size());
    std::copy(hits_.begin(), hits_.end(), hits.begin());
}

std::uint64_t OpenmpSession::bytes() const
{
    return scene_.bytes();
}

} // namespace tetrace::openmp
