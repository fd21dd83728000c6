#include "bench/measuring/reporters.h"

#include "bench/terminal/text.h"
#include "core/base/error.h"
#include "core/base/files.h"

#include <iostream>
#include <unistd.h>
#include <utility>

namespace tetrace {

namespace {

std::string without_debug_warning(const std::string& text)
{
    std::istringstream lines(text);
    std::string kept;
    for (std::string line; std::getline(lines, line);)
        if (line.find("Library was built as DEBUG") == std::string::npos) kept += line + "\n";
    return kept;
}

} // namespace

/// Passes Google Benchmark's reports on under the bare row names. It removes the suffixes
/// "/iterations:1/manual_time", which are the same for all rows and would make names depend on the number of
/// measurements. Leaves out the warning that the library was built for debugging: what it times here is one call, by
/// our own clock. Several parts in turn are one report.
class RowReporter : public benchmark::BenchmarkReporter {
public:
    /// receiver: null where nothing is to be reported.
    RowReporter(std::unique_ptr<benchmark::BenchmarkReporter> receiver, std::size_t parts)
        : receiver_(std::move(receiver)), parts_left_(parts)
    {
    }

    bool ReportContext(const Context& context) override
    {
        if (std::exchange(has_begun_, true) || receiver_ == nullptr) return true;
        std::ostream& errors = receiver_->GetErrorStream();
        std::ostringstream said;
        receiver_->SetErrorStream(&said);
        const bool goes_on = receiver_->ReportContext(context);
        receiver_->SetErrorStream(&errors);
        errors << without_debug_warning(said.str());
        return goes_on;
    }

    void ReportRuns(const std::vector<Run>& runs) override
    {
        std::vector<Run> renamed = runs;
        for (Run& run : renamed) {
            run.run_name.iterations.clear();
            run.run_name.repetitions.clear();
            run.run_name.time_type.clear();
        }
        if (receiver_ != nullptr) receiver_->ReportRuns(renamed);
    }

    void Finalize() override
    {
        if (--parts_left_ == 0) end();
    }

    /// Ends the report now, as after an interrupt.
    void end()
    {
        if (std::exchange(has_ended_, true) || !has_begun_ || receiver_ == nullptr) return;
        receiver_->Finalize();
    }

private:
    std::unique_ptr<benchmark::BenchmarkReporter> receiver_;
    std::size_t parts_left_;
    bool has_begun_ = false, has_ended_ = false;
};

namespace {

/// Google Benchmark's own reporter for a format: "console", "json" or "csv".
std::unique_ptr<benchmark::BenchmarkReporter>
make_reporter(const std::string& format, std::ostream& stream,
              benchmark::ConsoleReporter::OutputOptions options = benchmark::ConsoleReporter::OO_None)
{
    std::unique_ptr<benchmark::BenchmarkReporter> reporter;
    if (format == "console") reporter = std::make_unique<benchmark::ConsoleReporter>(options);
    if (format == "json") reporter = std::make_unique<benchmark::JSONReporter>();
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations" // of the console's CSV; the flag still accepts it
    if (format == "csv") reporter = std::make_unique<benchmark::CSVReporter>();
#pragma GCC diagnostic pop
    if (reporter == nullptr)
        throw Error(ErrorKind::usage,
                    "Google Benchmark does not support format '" + format + "'; accepted: console, json or csv");
    reporter->SetOutputStream(&stream);
    return reporter;
}

/// As Google Benchmark chooses them, but that NO_COLOR is honoured.
benchmark::ConsoleReporter::OutputOptions console_options(const BenchmarkFlags& flags)
{
    using Console = benchmark::ConsoleReporter;
    const int colour = flags.colour.value_or(has_colour(STDOUT_FILENO)) ? Console::OO_Color : Console::OO_None;
    return static_cast<Console::OutputOptions>(colour | (flags.tabular ? Console::OO_Tabular : Console::OO_None));
}

} // namespace

GoogleReports::GoogleReports(const BenchmarkFlags& flags, std::size_t parts)
    : flags_(flags),
      display_(std::make_unique<RowReporter>(
          flags.format ? make_reporter(*flags.format, std::cout, console_options(flags)) : nullptr, parts)),
      file_(flags.out.empty() ? nullptr : std::make_unique<RowReporter>(make_reporter(flags.out_format, text_), parts))
{
}

GoogleReports::~GoogleReports() = default;

void GoogleReports::run()
{
    benchmark::RunSpecifiedBenchmarks(display_.get(), file_.get(), "all");
}

void GoogleReports::write()
{
    display_->end();
    if (file_ != nullptr) file_->end();
    std::cout.flush(); // Google Benchmark looks at no stream's state
    if (flags_.format && !std::cout)
        throw Error(ErrorKind::invalid_input, "writing the output of --benchmark_format to standard output failed; "
                                              "check that the disk is not full, or use --benchmark_out FILE");
    if (file_ != nullptr) write_whole(flags_.out, text_.str());
}

} // namespace tetrace
