#include "core/host_session.h"

#include <algorithm>
#include <cassert>
#include <chrono>

namespace tetrace {

void HostSession::launch(const TraceJob& job)
{
    hits_.assign(std::size_t{job.width} * job.height, Hit{POISON, POISON, 0, 0, 0, POISON});
    const auto start = std::chrono::steady_clock::now();
    trace(job, hits_);
    kernel_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void HostSession::read_back(std::span<Hit> hits)
{
    assert(hits.size() == hits_.size());
    std::copy(hits_.begin(), hits_.end(), hits.begin());
}

} // namespace tetrace
