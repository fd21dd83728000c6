#include "backends/openmp/yardstick.h"

#include "core/base/stopwatch.h"
#include "core/device/host.h"
#include "core/device/yardstick.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tetrace::openmp {

namespace {

/// Each thread copies its share again and again, now one way and now the other, without waiting for the others.
void copy_words(std::uint64_t* a, std::uint64_t* b, std::size_t words, unsigned times, int team)
{
#pragma omp parallel num_threads(team)
    for (unsigned time = 0; time < times; ++time) {
        const std::uint64_t* const from = time % 2 == 0 ? a : b;
        std::uint64_t* const to = time % 2 == 0 ? b : a;
#pragma omp for schedule(static) nowait
        for (std::size_t i = 0; i < words; ++i)
            to[i] = from[i];
    }
}

Yardstick measured_copies(int team)
{
    const std::size_t bytes = copied_bytes(host_device().memory_bytes, 0), words = bytes / sizeof(std::uint64_t);
    // Not initialised here: each page belongs to the thread that touches it first.
    const std::unique_ptr<std::uint64_t[]> a(new std::uint64_t[words]), b(new std::uint64_t[words]);
#pragma omp parallel for schedule(static) num_threads(team)
    for (std::size_t i = 0; i < words; ++i)
        a[i] = b[i] = i;
    return measure_copies(words * sizeof(std::uint64_t), [&](std::uint64_t each, unsigned times) {
        const Stopwatch watch;
        copy_words(a.get(), b.get(), each / sizeof(std::uint64_t), times, team);
        return watch.seconds();
    });
}

double launch_s(int team)
{
    return median_seconds([&] {
        [[maybe_unused]] volatile int entered = 0;
#pragma omp parallel num_threads(team)
        {
#pragma omp single nowait
            entered = 1;
        }
    });
}

constexpr std::size_t chain_words = std::size_t{1} << 19; // 2 MiB
constexpr unsigned chain_steps = 1u << 17;

/// Any fixed words will do: splitmix64's.
std::uint64_t mixed(std::uint64_t x)
{
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

const std::vector<std::uint32_t>& chain()
{
    static const std::vector<std::uint32_t> table = [] {
        std::vector<std::uint32_t> made(chain_words);
        for (std::size_t i = 0; i < made.size(); ++i)
            made[i] = static_cast<std::uint32_t>(mixed(i));
        return made;
    }();
    return table;
}

/// Each step needs the one before it.
std::uint64_t follow(std::uint64_t x)
{
    const std::vector<std::uint32_t>& table = chain();
    for (unsigned step = 0; step < chain_steps; ++step)
        x = mixed(x + table[x % chain_words]);
    return x;
}

double seconds_of_chains(int team)
{
    std::uint64_t sum = 0;
    const Stopwatch watch;
#pragma omp parallel for schedule(static) num_threads(team) reduction(+ : sum)
    for (int thread = 0; thread < team; ++thread)
        sum += follow(static_cast<std::uint64_t>(thread));
    [[maybe_unused]] volatile std::uint64_t used = sum;
    return watch.seconds();
}

} // namespace

double pulse_s(unsigned threads)
{
    const int team = static_cast<int>(threads);
    static_cast<void>(chain()); // before the watch runs
    std::array<double, 3> times{};
    for (double& seconds : times)
        seconds = seconds_of_chains(team);
    std::ranges::sort(times);
    return times[1];
}

Yardstick measure_host(unsigned threads)
{
    const int team = static_cast<int>(threads);
    Yardstick measured = measured_copies(team);
    measured.launch_s = launch_s(team);
    return measured;
}

} // namespace tetrace::openmp
