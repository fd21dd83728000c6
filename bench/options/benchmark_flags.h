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
};

/// Reads them, and initialises Google Benchmark with the others; rows are interleaved at random unless they say
/// otherwise. To be called once: Google Benchmark keeps its flags to the program's end.
/// Throws Error{usage} naming a flag that it does not know, or a value that is not accepted.
[[nodiscard]] BenchmarkFlags read_benchmark_flags(const std::vector<std::string>& arguments);

/// Whether Google Benchmark's --benchmark_filter would keep the name: a regular expression found anywhere, negated by a
/// leading '-'; "all" and "" keep everything. Throws Error{usage} where it is no regular expression.
[[nodiscard]] bool benchmark_filter_keeps(const std::string& filter, const std::string& name);

} // namespace tetrace
