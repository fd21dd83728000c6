#include "core/device/team.h"

#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tetrace {

namespace {

void pause()
{
#if defined(__SSE2__)
    _mm_pause();
#endif
}

} // namespace

void SharedTiles::enter()
{
    inside_.fetch_add(1, std::memory_order_acq_rel);
}

void SharedTiles::leave()
{
    if (inside_.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
    is_done_.store(1, std::memory_order_release);
    is_done_.notify_all();
}

void SharedTiles::wait() const
{
    constexpr int polls = 1000; // some 20 to 50 us: on a quiet machine others end sooner, and sleep costs as much
    for (int i = 0; i < polls && is_done_.load(std::memory_order_acquire) == 0; ++i)
        pause();
    while (is_done_.load(std::memory_order_acquire) == 0)
        is_done_.wait(0, std::memory_order_acquire);
}

void on_team(unsigned threads, std::uint32_t passes, std::size_t jobs,
             const std::function<void(std::size_t job, SharedTiles& tiles)>& work)
{
    constexpr std::uint32_t max_at_once = 256; // passes that have tiles at the same time: memory is bounded
    for (std::uint32_t first = 0; first < passes; first += max_at_once) {
        const std::uint32_t count = std::min(max_at_once, passes - first);
        std::vector<std::vector<SharedTiles>> tiles(count);
        for (auto& pass : tiles)
            pass = std::vector<SharedTiles>(jobs);
#pragma omp parallel num_threads(static_cast <int>(threads))
        for (std::uint32_t pass = 0; pass < count; ++pass) {
            for (std::size_t job = 0; pass > 0 && job < jobs; ++job)
                tiles[pass - 1][job].wait();
            for (std::size_t job = 0; job < jobs; ++job)
                work(job, tiles[pass][job]);
        }
    }
}

} // namespace tetrace
