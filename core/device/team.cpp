#include "core/device/team.h"

#include <vector>

namespace tetrace {

void SharedTiles::wait_for_earlier() const
{
    if (earlier_ == nullptr) return;
    while (earlier_->is_done_.load(std::memory_order_acquire) == 0)
        earlier_->is_done_.wait(0, std::memory_order_acquire);
}

void SharedTiles::count_done(std::uint32_t more, std::uint32_t all)
{
    if (done_.fetch_add(more, std::memory_order_acq_rel) + more != all) return;
    is_done_.store(1, std::memory_order_release);
    is_done_.notify_all();
}

void on_team(unsigned threads, std::uint32_t passes, std::size_t jobs,
             const std::function<void(std::size_t job, SharedTiles& tiles)>& work)
{
    constexpr std::uint32_t max_at_once = 256; // passes without a common end: memory is bounded
    for (std::uint32_t done = 0; done < passes; done += max_at_once) {
        const std::uint32_t count = std::min(max_at_once, passes - done);
        std::vector<SharedTiles> tiles(count * jobs);
        for (std::size_t i = jobs; i < tiles.size(); ++i)
            tiles[i].come_after(tiles[i - jobs]);
#pragma omp parallel num_threads(static_cast <int>(threads))
        for (std::size_t i = 0; i < tiles.size(); ++i)
            work(i % jobs, tiles[i]);
    }
}

} // namespace tetrace
