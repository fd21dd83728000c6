#pragma once

#include "bench/options/benchmark_flags.h"

#include <benchmark/benchmark.h>
#include <memory>
#include <sstream>

namespace tetrace {

class RowReporter;

/// What Google Benchmark prints and writes about rows that it runs, if it is asked to.
class GoogleReports {
public:
    /// parts: run() will be called so often at most, for one report.
    GoogleReports(const BenchmarkFlags& flags, std::size_t parts);
    ~GoogleReports();

    /// Runs the registered benchmarks. The flags' filter was applied to the rows themselves, under the reported names.
    void run();
    /// Ends the reports, and writes the file of --benchmark_out. Throws Error{invalid_input} if it cannot be written,
    /// or what was printed.
    void write();

private:
    BenchmarkFlags flags_;
    std::ostringstream text_; ///< for the file: Google Benchmark does not notice a full disk
    std::unique_ptr<RowReporter> display_, file_;
};

} // namespace tetrace
