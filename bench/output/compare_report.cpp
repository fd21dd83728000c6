#include "bench/output/compare_report.h"

#include "bench/statistics/statistics.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace tetrace {

namespace {

template <class Value>
Cell cell_if(bool is, const Value& value)
{
    return is ? Cell(value) : Cell();
}

Cell median_of(const ResultRow* row)
{
    const bool timed = row != nullptr && !row->samples_s.empty();
    return timed ? Cell(statistics_of(row->samples_s).median) : Cell();
}

Cell rate_of(const ResultRow* row)
{
    return row != nullptr ? cell_of(row->mrays_per_s) : Cell();
}

std::string ratio_text(const SpeedChange& change)
{
    if (!change.interval) return fmt::format("{:.3f}", change.ratio);
    return fmt::format("{:.3f} [{:.3f}, {:.3f}]", change.ratio, change.interval->low, change.interval->high);
}

Table rows_table(const ResultComparison& comparison)
{
    Table table({{"name", "row"},
                 {.key = "before", .title = "A", .unit = "Mrays/s", .rank = 2},
                 {.key = "after", .title = "B", .unit = "Mrays/s", .rank = 2},
                 {"ratio", "B / A"},
                 {.key = "verdict", .title = "verdict", .coloured = true, .rank = 0}});
    for (const ComparedRow& row : comparison.rows)
        table.add({row.name(), rate_of(row.before), rate_of(row.after),
                   row.change ? Cell(ratio_text(*row.change)) : Cell(), row.verdict()});
    return table;
}

std::string device_text(const ResultFile& file, const ResultRow& row)
{
    const std::string& device = file.head.shown(row.device);
    return row.driver.empty() ? device : device + ", " + row.driver;
}

/// A sentence for each device that the compared rows ran on, in their order.
std::vector<std::string> device_sentences(const ResultComparison& comparison)
{
    std::vector<std::string> sentences;
    for (const ComparedRow& row : comparison.rows) {
        if (row.outcome != RowOutcome::compared) continue;
        const std::string a = device_text(*comparison.before, *row.before),
                          b = device_text(*comparison.after, *row.after);
        const std::string devices = a == b ? a + " in both" : fmt::format("{} in A; {} in B", a, b);
        std::string sentence = fmt::format("{}: {}.", row.before->api(), devices);
        if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(std::move(sentence));
    }
    return sentences;
}

/// A value of the section `tetrace`; null if the result has none there.
nlohmann::json recorded_at(const ResultFile& file, const char* pointer)
{
    const nlohmann::json::json_pointer place(pointer);
    const nlohmann::json& section = file.json.at("tetrace");
    return section.contains(place) ? section.at(place) : nlohmann::json();
}

/// What differs between the two results, apart from their date: a ratio shows the effect of all of it together.
std::string differences_text(const ResultComparison& comparison)
{
    struct Fact {
        const char *pointer, *name;
    };
    constexpr Fact facts[] = {{"/version", "the version"},
                              {"/commit", "the commit"},
                              {"/compiler", "the compiler"},
                              {"/flags", "the compiler's flags"},
                              {"/label", "the label"},
                              {"/host/cpu", "the processor"},
                              {"/host/family", "the CPU's family"},
                              {"/host/model", "the CPU's model"},
                              {"/host/stepping", "the CPU's stepping"},
                              {"/host/system", "the system"},
                              {"/host/threads", "the threads that the process may use"},
                              {"/threads", "the threads that it used"},
                              {"/packet_lanes", "the lanes of packets"}};
    constexpr Fact conditions[] = {{"/conditions/governor", "the CPUs' frequency governor"},
                                   {"/conditions/turbo", "turbo"},
                                   {"/conditions/smt", "SMT"},
                                   {"/conditions/on_battery", "mains or battery"}};
    std::vector<std::string> differences;
    for (const Fact& fact : facts)
        if (recorded_at(*comparison.before, fact.pointer) != recorded_at(*comparison.after, fact.pointer))
            differences.emplace_back(fact.name);
    for (const Fact& fact : conditions) { // which older results and some systems do not report
        const auto before = recorded_at(*comparison.before, fact.pointer),
                   after = recorded_at(*comparison.after, fact.pointer);
        if (!before.is_null() && !after.is_null() && before != after) differences.emplace_back(fact.name);
    }
    for (const ComparedRow& row : comparison.rows)
        if (row.outcome == RowOutcome::compared &&
            (row.before->device != row.after->device || row.before->driver != row.after->driver)) {
            differences.emplace_back("devices or their drivers");
            break;
        }
    return differences.empty() ? "nothing of version, commit, compiler, flags, processor, system, threads, devices and "
                                 "drivers."
                               : fmt::format("{}.", fmt::join(differences, ", "));
}

/// Each note, for all rows that have it: "FAILED" or "MISSING" of many rows has one cause as a rule.
Sheet notes_of(const ResultComparison& comparison)
{
    std::map<std::string, std::vector<const ComparedRow*>> notes;
    for (const ComparedRow& row : comparison.rows)
        if (!row.note().empty()) notes[row.verdict() + ": " + row.note()].push_back(&row);
    Sheet sheet;
    for (const auto& [note, rows] : notes)
        sheet.line(rows.size() == 1 ? fmt::format("{}: {}", rows.front()->name(), note)
                                    : fmt::format("{} rows, such as {}: {}", rows.size(), rows.front()->name(), note));
    if (!notes.empty()) sheet.gap();
    return sheet;
}

std::size_t count_of(const ResultComparison& comparison, SpeedVerdict verdict)
{
    std::size_t count = 0;
    for (const ComparedRow& row : comparison.rows)
        count += row.change && !row.is_noisy() && row.change->verdict == verdict ? 1 : 0;
    return count;
}

std::size_t noisy_count(const ResultComparison& comparison)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(comparison.rows, [](const ComparedRow& row) { return row.is_noisy(); }));
}

std::size_t too_few_count(const ResultComparison& comparison)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(comparison.rows, [](const ComparedRow& row) { return row.has_too_few_samples(); }));
}

/// A line for each row that has become slower, one for all that failed, and one for all that are missing.
void add_regressions(Sheet& sheet, const ResultComparison& comparison, bool allow_missing)
{
    std::map<std::string, std::vector<std::string>> without_rate;
    for (const ComparedRow* row : comparison.regressions(allow_missing)) {
        if (!row->change)
            without_rate[row->verdict()].push_back(row->name());
        else
            sheet.labelled("Regressed",
                           fmt::format("{}: {:.1f} % slower, more than the tolerance of {:g} %.", row->name(),
                                       100 * (1 / row->change->ratio - 1), 100 * comparison.tolerance));
    }
    for (const auto& [verdict, names] : without_rate)
        sheet.labelled("Regressed", names.size() == 1
                                        ? fmt::format("{}: {}, and A has its rate.", names.front(), verdict)
                                        : fmt::format("{} rows are {}, and A has their rates.", names.size(), verdict));
}

std::string promise_text(const ResultComparison& comparison)
{
    const std::size_t compared = comparison.count(RowOutcome::compared);
    const double error = comparison.error();
    std::string text = fmt::format("rates of B over those of A, by medians: above 1, B is faster; in brackets the "
                                   "interval from the samples. If nothing changed, the chance that any of these "
                                   "rows is called FASTER or SLOWER is at most {:.2g} %",
                                   100 * error);
    if (error > 1.000001 * comparison_error || error == 0)
        text += fmt::format("; {} or more samples per row, for {} rows, reduce it to 1 %", samples_needed(compared),
                            compared);
    return text + ". Runs also differ in ways that no interval shows: the tolerance is for that.";
}

std::string verdicts_text(double tolerance)
{
    return fmt::format(
        "SAME: the interval is within the tolerance, {:.3f} to {:.3f}. FASTER, SLOWER: it does not contain 1. "
        "UNSURE: it contains 1 and exceeds the tolerance, or there are fewer than {} samples, which give no "
        "interval; more samples would decide. NOISY: the machine's own speed changed, as calibration shows.",
        1 / (1 + tolerance), 1 + tolerance, min_samples);
}

Sheet comparison_sheet(const ResultComparison& comparison, const Options& options)
{
    Sheet sheet = comparison_head(comparison);
    sheet.gap();
    sheet.table(rows_table(comparison));
    sheet.gap();
    sheet.append(notes_of(comparison));
    add_search_note(sheet, comparison);
    sheet.labelled("Compared", summary_text(comparison));
    if (const std::size_t count = noisy_count(comparison); count > 0)
        sheet.labelled("Noisy", fmt::format("the machine itself was not the same while {} of these rows were measured: "
                                            "they decide nothing. Measure again on a quieter machine.",
                                            count));
    add_regressions(sheet, comparison, options.allow_missing);
    if (comparison.count(RowOutcome::compared) > 0) {
        sheet.labelled("B / A", promise_text(comparison));
        sheet.labelled("Verdicts", verdicts_text(comparison.tolerance));
    }
    return sheet;
}

} // namespace

Sheet comparison_head(const ResultComparison& comparison)
{
    Sheet sheet;
    sheet.labelled("A", source_text(*comparison.before));
    sheet.labelled("B", source_text(*comparison.after));
    sheet.labelled("Differ in", differences_text(comparison));
    for (const std::string& sentence : device_sentences(comparison))
        sheet.labelled("Device", sentence);
    return sheet;
}

nlohmann::json source_json(const ResultFile& file)
{
    return {{"file", file.path.filename().string()},
            {"date", file.head.date},
            {"version", file.head.version},
            {"commit", file.head.commit},
            {"host", {{"cpu", file.head.cpu}, {"system", file.head.system}}}};
}

std::string summary_text(const ResultComparison& comparison)
{
    const std::size_t compared = comparison.count(RowOutcome::compared);
    std::string text = fmt::format("{} of {} rows", compared, comparison.rows.size());
    const char* separator = ": ";
    for (const SpeedVerdict verdict :
         {SpeedVerdict::same, SpeedVerdict::faster, SpeedVerdict::slower, SpeedVerdict::unsure})
        if (const std::size_t count = count_of(comparison, verdict); count > 0) {
            text += fmt::format("{}{} {}", separator, count, name_of(verdict));
            separator = ", ";
        }
    if (const std::size_t count = noisy_count(comparison); count > 0)
        text += fmt::format("{}{} NOISY", separator, count);
    if (const std::size_t count = comparison.count(RowOutcome::different); count > 0)
        text += fmt::format("; {} DIFFERENT, not compared", count);
    if (const std::size_t count = comparison.count(RowOutcome::agreed); count > 0)
        text += fmt::format("; {} of another API with the SAME ANSWERS", count);
    if (const std::size_t count = too_few_count(comparison); count > 0)
        text += fmt::format("; {} with fewer than {} samples, so no interval", count, min_samples);
    if (const auto mean = comparison.geometric_mean())
        text += fmt::format("; geometric mean of B / A {:.3f}{}", *mean,
                            noisy_count(comparison) > 0 ? ", with the NOISY rows in it" : "");
    return text + ".";
}

std::string source_text(const ResultFile& file)
{
    return fmt::format("{}: {} by tetrace {} ({}) on {}, {}", file.path.string(), file.head.date, file.head.version,
                       file.head.commit, file.head.machine, file.head.system);
}

void add_search_note(Sheet& sheet, const ResultComparison& comparison)
{
    const auto is_search = [](const ComparedRow& row) { return row.name().starts_with("search/"); };
    if (std::ranges::any_of(comparison.rows, is_search))
        sheet.labelled("Searches", "Rows that begin with search/ are exit searches (Table 5); their rates are in "
                                   "millions of searches per second.");
}

Table flat_rows(const ResultComparison& comparison)
{
    Table table({{"name", "name"},
                 {"verdict", "verdict"},
                 {"ratio", "B / A", "", 3},
                 {"low", "low", "", 3},
                 {"high", "high", "", 3},
                 {"confidence", "confidence", "", 5},
                 {"before_median_s", "A", "s", 6},
                 {"after_median_s", "B", "s", 6},
                 {"before_mrays_per_s", "A", "Mrays/s"},
                 {"after_mrays_per_s", "B", "Mrays/s"},
                 {"note", "note"}});
    for (const ComparedRow& row : comparison.rows) {
        const SpeedChange change = row.change.value_or(SpeedChange{});
        const FactorInterval interval = change.interval.value_or(FactorInterval{});
        const bool has_interval = change.interval.has_value();
        table.add({row.name(), row.verdict(), cell_if(row.change.has_value(), change.ratio),
                   cell_if(has_interval, interval.low), cell_if(has_interval, interval.high),
                   cell_if(has_interval, 1 - change.error), median_of(row.before), median_of(row.after),
                   rate_of(row.before), rate_of(row.after), cell_if(!row.note().empty(), row.note())});
    }
    return table;
}

nlohmann::json comparison_json(const ResultComparison& comparison, bool allow_missing)
{
    nlohmann::json json = {{"before", source_json(*comparison.before)}, {"after", source_json(*comparison.after)},
                           {"tolerance", comparison.tolerance},         {"error", comparison.error()},
                           {"rows", to_json(flat_rows(comparison))},    {"regressions", nlohmann::json::array()}};
    for (const ComparedRow* row : comparison.regressions(allow_missing))
        json["regressions"].push_back(row->name());
    if (const auto mean = comparison.geometric_mean()) json["geometric_mean"] = *mean;
    return json;
}

Report compare_report(const ResultComparison& comparison, const Options& options)
{
    nlohmann::json section = result_head(options);
    section["comparison"] = comparison_json(comparison, options.allow_missing);
    Report report{comparison_sheet(comparison, options), flat_rows(comparison), {{"tetrace", std::move(section)}}};
    check_columns(options, report.sheet.column_keys());
    report.markdown = report.sheet.markdown({.columns = options.columns});
    if (options.out) report.sheet.labelled("Result", options.out->string());
    return report;
}

} // namespace tetrace
