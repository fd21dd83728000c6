#pragma once

#include "bench/output/bench_report.h"
#include "bench/statistics/launch_line.h"
#include "bench/terminal/table.h"

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tetrace {

/// A place on an axis of a run: a size of images, or a number of host threads.
struct AxisValue {
    std::uint64_t number = 0; ///< of rays in an image, or of threads
    std::string text;         ///< "512x512", "2 threads"

    auto operator<=>(const AxisValue&) const = default;
};

/// The rate of a row at a place on an axis.
struct AxisRate {
    double mrays_per_s = 0;
    LaunchSamples per_mray; ///< launches and seconds, sample by sample, of a million rays
};

/// What mrays million rays took in each sample.
[[nodiscard]] AxisRate axis_rate(double mrays_per_s, double mrays, double launches,
                                 const std::vector<double>& samples_s);

/// The rates of rows that differ only along an axis.
struct AxisLine {
    std::string scene, row, backend; ///< what is equal in all of them, as tables call it
    std::map<AxisValue, AxisRate> rates;

    [[nodiscard]] const AxisRate& first() const { return rates.begin()->second; }
    [[nodiscard]] const AxisRate& last() const { return rates.rbegin()->second; }
    /// The rate at the last place over that at the first, by the ratio of their numbers: 1 is ideal.
    [[nodiscard]] double efficiency() const;
};

/// Lines in the order of their first rates.
class AxisLines {
public:
    void add(const AxisLine& line, AxisValue value, AxisRate rate);
    /// Those with two rates or more.
    [[nodiscard]] std::vector<AxisLine> whole() const;

private:
    std::vector<AxisLine> lines_;
};

/// The lines of a run of `bench` with several sizes, and with several numbers of threads; empty if it has one.
[[nodiscard]] std::vector<AxisLine> size_lines(const BenchResult& result);
[[nodiscard]] std::vector<AxisLine> thread_lines(const BenchResult& result);

/// "512x512", and "2 threads".
[[nodiscard]] AxisValue size_value(std::uint64_t width, std::uint64_t height);
[[nodiscard]] AxisValue thread_value(std::uint64_t threads);

/// Rates by size, and the line through the smallest and the largest: what a launch costs, and what a million rays cost.
[[nodiscard]] Table size_table(const std::vector<AxisLine>& lines);
/// Rates by threads, and how near they come to the ideal.
[[nodiscard]] Table thread_table(const std::vector<AxisLine>& lines);

} // namespace tetrace
