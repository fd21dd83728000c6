#pragma once

#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

namespace tetrace {

/// Hands on what Google Benchmark reports to several reporters, under row names alone: without the suffixes
/// "/iterations:1/manual_time", which are the same for all, and would make names depend on how often was measured.
class RowReporter : public benchmark::BenchmarkReporter {
public:
    explicit RowReporter(std::vector<std::unique_ptr<benchmark::BenchmarkReporter>> receivers)
        : receivers_(std::move(receivers))
    {
    }

    bool ReportContext(const Context& context) override;
    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

private:
    std::vector<std::unique_ptr<benchmark::BenchmarkReporter>> receivers_;
};

/// Google Benchmark's own reporter of a format: "console", "json" or "csv".
[[nodiscard]] std::unique_ptr<benchmark::BenchmarkReporter> make_reporter(const std::string& format,
                                                                          std::ostream& stream);

} // namespace tetrace
