#include "core/device/host_session.h"

#include "core/base/stopwatch.h"
#include "core/device/launch.h"

#include <algorithm>
#include <cassert>

namespace tetrace {

void HostSession::start(std::span<const TraceJob> jobs)
{
    const OutputParts parts = output_parts(words_per_ray(task_));
    output_.assign(parts.words(), POISON);
    const Stopwatch watch;
    for (std::uint32_t pass = 0; pass < jobs.front().passes; ++pass)
        for (std::size_t job = 0; job < jobs.size(); ++job)
            run(jobs[job], parts.results(std::span(output_), job));
    kernel_s_ = watch.seconds();
}

void HostSession::read_output(std::span<std::uint32_t> words)
{
    assert(words.size() == output_.size());
    std::ranges::copy(output_, words.begin());
}

} // namespace tetrace
