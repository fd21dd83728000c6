#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// Google Benchmark's flags as far as tetrace itself reacts to them; the others are only handed on.
struct BenchmarkFlags {
    std::string filter;                  ///< --benchmark_filter, applied to row names
    bool list_tests = false;             ///< --benchmark_list_tests
    std::optional<unsigned> repetitions; ///< --benchmark_repetitions: so many samples, whatever the budget
    std::optional<std::string> format;   ///< --benchmark_format: its output on standard output in place of the table
    std::string out;                     ///< --benchmark_out
    std::string out_format = "json";     ///< --benchmark_out_format
    std::vector<std::string> handed_on;  ///< to benchmark::Initialize
};

/// Reads them and lets Google Benchmark check the others.
/// Throws Error{usage} naming a flag that it does not know, or a value that is not accepted.
[[nodiscard]] BenchmarkFlags read_benchmark_flags(const std::vector<std::string>& arguments);

/// Calls benchmark::Initialize; throws Error{usage} naming a flag that it leaves.
void initialize_benchmark(const std::vector<std::string>& flags);

} // namespace tetrace
