#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace tetrace {

/// The tiles of a job, which the threads of a team take a few at a time. A thread that finds none left goes on with the
/// next job: on a busy machine those that it would wait for may have no processor.
class SharedTiles {
public:
    /// Calls work(tile) for tiles that no other thread has taken, at_once of them one after the other, until none is
    /// left.
    template <class Work>
    void take(std::uint32_t tiles, std::uint32_t at_once, const Work& work)
    {
        enter();
        const std::atomic_ref<std::uint32_t> next(next_);
        for (std::uint32_t first; (first = next.fetch_add(at_once, std::memory_order_relaxed)) < tiles;) {
            const std::uint32_t end = std::min(tiles, first + at_once);
            for (std::uint32_t tile = first; tile < end; ++tile)
                work(tile);
        }
        leave();
    }

    /// Calls work(next), which takes its work by adding to *next, 0 at first, and returns when none is left to take.
    template <class Work>
    void share(const Work& work)
    {
        enter();
        work(&next_);
        leave();
    }

    /// Waits until all that was taken is done, asleep if that takes long. A thread has left before.
    void wait() const;

private:
    // Not inline: kernels are compiled for other processors than the rest of the program.
    void enter();
    void leave();

    alignas(64) std::uint32_t next_ = 0;
    std::atomic<std::uint32_t> inside_{0}; // threads; the last to leave has seen that nothing is left to take
    std::atomic<int> is_done_{0};
};

/// Calls work(job, tiles) for each of these jobs, pass after pass, on that many threads of OpenMP, each of which takes
/// tiles. A pass begins when the one before it has ended. Returns when all is done. work must not throw.
void on_team(unsigned threads, std::uint32_t passes, std::size_t jobs,
             const std::function<void(std::size_t job, SharedTiles& tiles)>& work);

} // namespace tetrace
