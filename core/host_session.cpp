#include "core/host_session.h"

#include "core/elapsed.h"
#include "core/launch.h"

#include <algorithm>
#include <cassert>
#include <chrono>

namespace tetrace {

void HostSession::launch(const TraceJob& job)
{
    output_.assign(output_words(job), POISON);
    // A hit is six words without padding: the output holds hits as every device's does.
    const std::span hits(reinterpret_cast<Hit*>(output_.data() + GUARD_WORDS), std::size_t{job.width} * job.height);
    const auto start = std::chrono::steady_clock::now();
    trace(job, hits);
    kernel_s_ = seconds_since(start);
}

void HostSession::read_output(std::span<std::uint32_t> words)
{
    assert(words.size() == output_.size());
    std::copy(output_.begin(), output_.end(), words.begin());
}

} // namespace tetrace
