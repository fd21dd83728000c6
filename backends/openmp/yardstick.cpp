#include "backends/openmp/yardstick.h"

#include "core/base/stopwatch.h"
#include "core/device/yardstick.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tetrace::openmp {

namespace {

constexpr std::size_t words = std::size_t{128} << 17; // 128 MiB
constexpr int passes = 6;                             // the first one touches the pages

void copy_words(std::uint64_t* to, const std::uint64_t* from, int threads)
{
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::size_t i = 0; i < words; ++i)
        to[i] = from[i];
}

double copy_bytes_per_s(int team)
{
    // Not initialised here: each page belongs to the thread that touches it first.
    const std::unique_ptr<std::uint64_t[]> a(new std::uint64_t[words]), b(new std::uint64_t[words]);
#pragma omp parallel for schedule(static) num_threads(team)
    for (std::size_t i = 0; i < words; ++i)
        a[i] = i;
    double best_s = 1e300;
    for (int pass = 0; pass < passes; ++pass) {
        const Stopwatch watch;
        if (pass % 2 == 0)
            copy_words(b.get(), a.get(), team);
        else
            copy_words(a.get(), b.get(), team);
        if (pass > 0) best_s = std::min(best_s, watch.seconds());
    }
    return 2.0 * static_cast<double>(words * sizeof(std::uint64_t)) / best_s;
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
    return {copy_bytes_per_s(team), launch_s(team)};
}

} // namespace tetrace::openmp
