#include "bench/options/benchmark_flags.h"

#include "bench/options/name_filter.h"
#include "bench/options/option_values.h"
#include "core/base/error.h"
#include "core/base/printable.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

namespace tetrace {

namespace {

bool is_true(const std::string& text)
{
    for (const char* const no : {"0", "f", "n", "false", "no", "off"})
        if (text == no) return false;
    return true;
}

std::string checked_format(const std::string& flag, const std::string& text)
{
    if (text != "console" && text != "json" && text != "csv") reject_value(flag, text, "console, json or csv");
    return text;
}

/// Takes a flag that tetrace itself uses; false: the flag is for Google Benchmark.
bool take_flag(BenchmarkFlags& flags, const std::string& name, const std::string& value)
{
    if (name == "--benchmark_filter")
        flags.filter = value;
    else if (name == "--benchmark_list_tests")
        flags.list_tests = is_true(value);
    else if (name == "--benchmark_repetitions")
        flags.repetitions = static_cast<unsigned>(parse_count(name, value, 1, 1'000'000));
    else if (name == "--benchmark_format")
        flags.format = checked_format(name, value);
    else if (name == "--benchmark_out_format")
        flags.out_format = checked_format(name, value);
    else
        return false;
    return true;
}

/// Calls benchmark::Initialize, only once: each call would add the flags' context again.
void initialize_benchmark(const std::vector<std::string>& flags)
{
    static char program[] = "tetrace"; // Google Benchmark keeps this pointer until the program ends
    std::vector<std::string> texts = {"--benchmark_enable_random_interleaving=true"};
    texts.insert(texts.end(), flags.begin(), flags.end()); // the user's come last, so they take precedence
    std::vector<char*> arguments = {program};
    for (std::string& text : texts)
        arguments.push_back(text.data());
    arguments.push_back(nullptr);
    int count = static_cast<int>(arguments.size()) - 1;
    benchmark::Initialize(&count, arguments.data());
    if (count > 1)
        throw Error(ErrorKind::usage, std::string("Google Benchmark does not accept '") + arguments[1] +
                                          "'; its flags: --benchmark_filter, --benchmark_repetitions, "
                                          "--benchmark_list_tests, --benchmark_format, --benchmark_out, "
                                          "--benchmark_out_format, --benchmark_enable_random_interleaving, "
                                          "--benchmark_report_aggregates_only, --benchmark_display_aggregates_only, "
                                          "--benchmark_context, --benchmark_color, --benchmark_counters_tabular, "
                                          "--benchmark_perf_counters, --benchmark_time_unit, --benchmark_min_time");
}

} // namespace

BenchmarkFlags read_benchmark_flags(const std::vector<std::string>& arguments)
{
    BenchmarkFlags flags;
    std::vector<std::string> handed_on;
    for (const std::string& argument : arguments) {
        if (printable_line(argument) != argument) // it would be printed unchanged
            throw Error(ErrorKind::usage,
                        fmt::format("'{}' is not accepted: it has characters that cannot be printed", argument));
        const auto equals = argument.find('=');
        const std::string name = argument.substr(0, equals);
        const std::string value = equals == std::string::npos ? "" : argument.substr(equals + 1);
        if (take_flag(flags, name, value)) continue;
        if (name == "--benchmark_out") flags.out = value;
        if (name == "--benchmark_color" && value != "auto") flags.colour = is_true(value);
        if (name == "--benchmark_counters_tabular") flags.tabular = is_true(value);
        // Google Benchmark does not notice a full disk: measure_rows() writes the file.
        handed_on.push_back(name == "--benchmark_out" && !value.empty() ? "--benchmark_out=/dev/null" : argument);
    }
    static_cast<void>(benchmark_filter_keeps(flags.filter, "")); // checks that it is an expression
    initialize_benchmark(handed_on);
    return flags;
}

bool benchmark_filter_keeps(const std::string& filter, const std::string& name)
{
    if (filter.empty() || filter == "all") return true;
    const bool negated = filter.front() == '-';
    return NameFilter("--benchmark_filter", negated ? filter.substr(1) : filter).keeps(name) != negated;
}

} // namespace tetrace
