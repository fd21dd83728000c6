#include "bench/output/report.h"

#include "bench/options/host_conditions.h"
#include "bench/options/identity.h"
#include "bench/results/result_file.h"
#include "bench/results/result_value.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/printable.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

namespace tetrace {

namespace {

Format format_of_file(const Options& options)
{
    if (options.format && *options.format != Format::table) return *options.format;
    const std::string ending = options.out->extension().string();
    if (ending == ".json") return Format::json;
    if (ending == ".csv") return Format::csv;
    if (ending == ".md") return Format::markdown;
    if (ending == ".txt") return Format::table;
    throw Error(ErrorKind::usage,
                fmt::format("--out: the extension of '{}' does not name a format; use .json, .csv, .md or .txt, or "
                            "add --format",
                            options.out->string()));
}

SheetStyle style_of(const Options& options, std::size_t width)
{
    return {width, options.columns};
}

std::string in_format(const Report& report, Format format, const Options& options)
{
    const auto shown = [&](const std::string& text) {
        return options.anonymous ? anonymous_text(text, options) : text;
    };
    switch (format) {
    case Format::table: return shown(without_colour(report.sheet.text(style_of(options, 0))));
    case Format::json: return result_text(options.anonymous ? anonymous_json(report.json, options) : report.json);
    case Format::csv: return shown(report.table.csv());
    case Format::markdown: return shown(report.markdown.empty() ? report.table.markdown() : report.markdown);
    }
    throw Error(ErrorKind::internal, "in_format: no such format");
}

} // namespace

void check_output(const Options& options)
{
    const bool is_shard = !shard_of(options).is_whole();
    if (is_shard && (!options.out || format_of_file(options) != Format::json))
        throw Error(ErrorKind::usage, "--shard: a shard's result is a JSON file, from which 'merge' reads it; name it "
                                      "with --out FILE.json");
    if (!options.out) return;
    static_cast<void>(format_of_file(options));
    check_writable("--out", *options.out);
}

void check_not_an_input(const std::filesystem::path& out, const std::vector<std::filesystem::path>& inputs,
                        const char* option)
{
    for (const std::filesystem::path& input : inputs) {
        std::error_code not_there; // then they are different files
        if (std::filesystem::equivalent(out, input, not_there))
            throw Error(ErrorKind::usage,
                        fmt::format("{}: writing '{}' would replace the input '{}'; name another file", option,
                                    out.string(), input.string()));
    }
}

void check_writable(const char* option, const std::filesystem::path& path)
{
    try {
        require_writable(path);
    } catch (const Error& error) {
        throw Error(error.kind(), fmt::format("{}: {}", option, error.what()));
    }
}

void check_columns(const Options& options, const std::vector<std::string>& keys)
{
    for (const std::string& key : options.columns)
        if (std::ranges::find(keys, key) == keys.end())
            throw Error(ErrorKind::usage, fmt::format("--columns: no table has the column '{}'; accepted: {}", key,
                                                      fmt::join(keys, ", ")));
}

void deliver_to_file(const Options& options, const Report& report)
{
    write_whole(*options.out, in_format(report, format_of_file(options), options));
}

void deliver(const Options& options, const Report& report)
{
    if (options.out) deliver_to_file(options, report);
    if (options.is_silent) return;
    const Format format = options.format.value_or(Format::table);
    if (format == Format::table) {
        const std::string text = report.sheet.text(style_of(options, terminal_columns(STDOUT_FILENO)));
        const std::string shown = has_colour(STDOUT_FILENO) ? text : without_colour(text);
        print(options.anonymous ? anonymous_text(shown, options) : shown);
    } else if (!options.out)
        print(in_format(report, format, options));
}

nlohmann::json to_json(const Table& table)
{
    nlohmann::json rows = nlohmann::json::array();
    for (const auto& row : table.rows()) {
        nlohmann::json object = nlohmann::json::object();
        for (std::size_t c = 0; c < row.size(); ++c)
            std::visit(
                [&](const auto& value) {
                    if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
                        object[table.columns()[c].key] = value;
                },
                row[c]);
        rows.push_back(std::move(object));
    }
    return rows;
}

nlohmann::json result_head(const Options& options)
{
    const BuildIdentity build = build_identity();
    const HostIdentity host = host_identity();
    nlohmann::json head = {{"schema_version", schema_version},
                           {"verb", name_of(options.verb)},
                           {"date", utc_now()},
                           {"version", build.version},
                           {"commit", build.commit},
                           {"compiler", build.compiler},
                           {"flags", build.flags},
                           {"host", {{"cpu", host.cpu}, {"system", host.system}, {"threads", host.threads}}}};
    const std::pair<const char*, std::optional<unsigned>> numbers[] = {
        {"family", host.family}, {"model", host.model}, {"stepping", host.stepping}};
    for (const auto& [key, number] : numbers)
        if (number) head["host"][key] = *number;
    if (!options.label.empty()) head["label"] = options.label;
    if (nlohmann::json conditions = conditions_json(host_conditions()); !conditions.empty())
        head["conditions"] = std::move(conditions);
    if (!options.words.empty()) head["command"] = printable_line(command_of(options.words));
    if (const Shard shard = shard_of(options); !shard.is_whole()) {
        head["shard"] = {{"number", shard.number}, {"of", shard.of}, {"arguments", options.arguments}};
        if (!options.job.empty()) head["shard"]["job"] = options.job;
    }
    if (is_interrupted()) head["interrupted"] = true;
    for (const char* const variable : {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"}) // the latter wins
        if (const char* const value = std::getenv(variable))
            head["waiting"] = printable_line(fmt::format("{}={}", variable, value));
    if (options.packet_lanes != 0) head["packet_lanes"] = options.packet_lanes;
    return head;
}

} // namespace tetrace
