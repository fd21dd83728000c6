#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// The Google Benchmark flags that tetrace itself uses; all others are passed on.
struct BenchmarkFlags {
    std::string filter;                  ///< --benchmark_filter, applied to row names
    bool list_tests = false;             ///< --benchmark_list_tests
    std::optional<unsigned> repetitions; ///< --benchmark_repetitions: the number of samples, whatever the budget
    std::optional<std::string> format;   ///< --benchmark_format: its output on standard output instead of the table
    std::string out;                     ///< --benchmark_out
    std::optional<bool> colour;          ///< --benchmark_color; empty: on terminals, unless NO_COLOR is set
    bool tabular = false;                ///< --benchmark_counters_tabular
    std::string out_format = "json";     ///< --benchmark_out_format
};

/// Reads these flags, and initialises Google Benchmark with the others. Rows are interleaved at random unless the flags
/// say otherwise. Call once: Google Benchmark keeps its flags until the program ends.
/// Throws Error{usage} naming an unknown flag or a value that is not accepted.
[[nodiscard]] BenchmarkFlags read_benchmark_flags(const std::vector<std::string>& arguments);

/// Whether Google Benchmark's --benchmark_filter would keep the name: a regular expression found anywhere, negated by a
/// leading '-'; "all" and "" keep everything. Throws Error{usage} if it is not a regular expression.
[[nodiscard]] bool benchmark_filter_keeps(const std::string& filter, const std::string& name);

} // namespace tetrace
