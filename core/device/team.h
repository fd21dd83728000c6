#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace tetrace {

/// The tiles of a job, which the threads of a team take a few at a time. A thread that finds none left goes on with the
/// next job and waits for nobody: on a busy machine the one that it would wait for may have no processor. Only where a
/// job has the output of an earlier one that is not yet done, threads sleep until it is.
class SharedTiles {
public:
    /// earlier: has the same output. Before any thread takes a tile.
    void come_after(SharedTiles& earlier) { earlier_ = &earlier; }

    /// Calls work(tile) for tiles that no other thread has taken, at_once of them one after the other, until none is
    /// left.
    template <class Work>
    void take(std::uint32_t tiles, std::uint32_t at_once, const Work& work)
    {
        wait_for_earlier();
        std::uint32_t done = 0;
        for (std::uint32_t first; (first = next_.fetch_add(at_once, std::memory_order_relaxed)) < tiles;) {
            const std::uint32_t end = std::min(tiles, first + at_once);
            for (std::uint32_t tile = first; tile < end; ++tile)
                work(tile);
            done += end - first;
        }
        count_done(done, tiles);
    }

    /// Calls work(next), which takes by itself what it adds to *next, until none is left. Each thread of the team must
    /// call this once.
    template <class Work>
    void share(std::uint32_t threads, const Work& work)
    {
        wait_for_earlier();
        work(&taken_);
        count_done(1, threads);
    }

private:
    // Not inline: kernels are compiled for other processors than the rest of the program.
    void wait_for_earlier() const;
    void count_done(std::uint32_t more, std::uint32_t all);

    alignas(64) std::atomic<std::uint32_t> next_{0}; // a cache line of its own
    std::uint32_t taken_ = 0;
    std::atomic<std::uint32_t> done_{0};
    std::atomic<int> is_done_{0};
    SharedTiles* earlier_ = nullptr;
};

/// Calls work(job, tiles) for each of these jobs, pass after pass, on each of that many threads of OpenMP. A job has
/// the same output in each pass. Returns when all is done.
void on_team(unsigned threads, std::uint32_t passes, std::size_t jobs,
             const std::function<void(std::size_t job, SharedTiles& tiles)>& work);

} // namespace tetrace
