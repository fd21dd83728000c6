#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tetrace {

/// Told of each repetition that Google Benchmark reports without an error: the row's name, seconds.
using SampleSeen = std::function<void(const std::string&, double)>;

/// Hands on what Google Benchmark reports to several reporters, under row names alone: without the suffixes
/// "/iterations:1/manual_time", which are the same for all, and would make names depend on how often was measured.
class RowReporter : public benchmark::BenchmarkReporter {
public:
    RowReporter(std::vector<std::unique_ptr<benchmark::BenchmarkReporter>> receivers, SampleSeen sample_seen)
        : receivers_(std::move(receivers)), sample_seen_(std::move(sample_seen))
    {
    }

    bool ReportContext(const Context& context) override;
    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

private:
    std::vector<std::unique_ptr<benchmark::BenchmarkReporter>> receivers_;
    SampleSeen sample_seen_;
};

/// Google Benchmark's own reporter of a format: "console", "json" or "csv".
[[nodiscard]] std::unique_ptr<benchmark::BenchmarkReporter> make_reporter(const std::string& format,
                                                                          std::ostream& stream);

} // namespace tetrace
