#include "backends/openmp/yardstick.h"

#include "core/base/stopwatch.h"
#include "core/device/yardstick.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

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

} // namespace

Yardstick measure_host(unsigned threads)
{
    const int team = static_cast<int>(threads);
    return {copy_bytes_per_s(team), launch_s(team)};
}

} // namespace tetrace::openmp
