#include "core/device/host_session.h"

#include "core/base/stopwatch.h"
#include "core/device/launch.h"

#include <algorithm>
#include <cassert>

namespace tetrace {

void HostSession::launch(const TraceJob& job)
{
    output_.assign(output_words(job, task_), POISON);
    const auto between_guards = std::span(output_).subspan(GUARD_WORDS, output_.size() - 2 * std::size_t{GUARD_WORDS});
    const Stopwatch watch;
    for (std::uint32_t pass = 0; pass < job.passes; ++pass)
        run(job, between_guards);
    kernel_s_ = watch.seconds();
}

void HostSession::read_output(std::span<std::uint32_t> words)
{
    assert(words.size() == output_.size());
    std::ranges::copy(output_, words.begin());
}

} // namespace tetrace
