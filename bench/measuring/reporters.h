#pragma once

#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

namespace tetrace {

/// Passes Google Benchmark's reports on to several reporters, under the bare row names. It removes the suffixes
/// "/iterations:1/manual_time", which are the same for all rows and would make names depend on the number of
/// measurements. Leaves out the warning that the library was built for debugging: what it times here is one call, by
/// our own clock. Several runs in turn are one report.
class RowReporter : public benchmark::BenchmarkReporter {
public:
    explicit RowReporter(std::vector<std::unique_ptr<benchmark::BenchmarkReporter>> receivers, std::size_t runs = 1)
        : receivers_(std::move(receivers)), runs_left_(runs)
    {
    }

    bool ReportContext(const Context& context) override;
    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

private:
    std::vector<std::unique_ptr<benchmark::BenchmarkReporter>> receivers_;
    std::size_t runs_left_; ///< the report ends with the last
    bool has_begun_ = false;
};

/// Google Benchmark's own reporter for a format: "console", "json" or "csv". Its options are those of the console's.
[[nodiscard]] std::unique_ptr<benchmark::BenchmarkReporter>
make_reporter(const std::string& format, std::ostream& stream,
              benchmark::ConsoleReporter::OutputOptions options = benchmark::ConsoleReporter::OO_None);

} // namespace tetrace
