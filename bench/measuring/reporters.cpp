#include "bench/measuring/reporters.h"

#include "core/base/error.h"

#include <sstream>
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

bool RowReporter::ReportContext(const Context& context)
{
    if (std::exchange(has_begun_, true)) return true;
    bool go_on = true;
    for (const auto& receiver : receivers_) {
        std::ostream& errors = receiver->GetErrorStream();
        std::ostringstream told;
        receiver->SetErrorStream(&told);
        go_on = receiver->ReportContext(context) && go_on;
        receiver->SetErrorStream(&errors);
        errors << without_debug_warning(told.str());
    }
    return go_on;
}

void RowReporter::ReportRuns(const std::vector<Run>& runs)
{
    std::vector<Run> renamed = runs;
    for (Run& run : renamed) {
        run.run_name.iterations.clear();
        run.run_name.repetitions.clear();
        run.run_name.time_type.clear();
    }
    for (const auto& receiver : receivers_)
        receiver->ReportRuns(renamed);
}

void RowReporter::Finalize()
{
    if (--runs_left_ > 0) return;
    for (const auto& receiver : receivers_)
        receiver->Finalize();
}

std::unique_ptr<benchmark::BenchmarkReporter> make_reporter(const std::string& format, std::ostream& stream,
                                                            benchmark::ConsoleReporter::OutputOptions options)
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

} // namespace tetrace
