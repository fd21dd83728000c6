#include "bench/debugging/defect_report.h"
#include "bench/debugging/trace_sheet.h"
#include "bench/expectations/check_verdict.h"
#include "bench/output/report.h"
#include "bench/output/trust.h"
#include "bench/reproduce/tables/recorded_tables.h"
#include "bench/results/result_file.h"
#include "bench/show/show_report.h"
#include "bench/variants/variant_report.h"
#include "bench/verbs/commands.h"
#include "core/base/error.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

std::string made_by(const ResultFile& file)
{
    return fmt::format("tetrace {}, {} by {} ({}) on {}, {}", file.head.verb, file.head.date, file.head.version,
                       file.head.commit, file.head.machine, file.head.system);
}

/// Of a result of `reproduce`: empty if nothing was timed, or where its version took no pulse.
std::string trust_of(const ResultFile& file)
{
    const Steadiness steadiness = read_steadiness(file.section());
    return steadiness.pulses.empty() || steadiness.timed == 0 ? std::string() : trust_text(steadiness);
}

Report shown(const ResultFile& file, const Options& options)
{
    if (options.brief && file.head.verb != "bench")
        throw Error(ErrorKind::usage,
                    fmt::format("--brief is for results of bench; '{}' is of {}", file.path.string(), file.head.verb));
    Report report{{}, Table({}), file.json};
    report.sheet.line(made_by(file));
    report.sheet.gap();
    if (file.head.verb == "reproduce") {
        PaperTables all = read_tables(file.section());
        all.trust = trust_of(file);
        report.sheet.append(tables_sheet(all));
        report.table = tidy_table(all.tables, all.figures);
        report.markdown = fmt::format("{}\n\n{}", made_by(file), tables_markdown(all));
    } else if (file.head.verb == "trace") {
        ShownTrace trace = shown_trace(file.section());
        report.sheet.append(trace.sheet);
        report.table = std::move(trace.table);
    } else if (file.section().find("defects")) {
        ShownDefects defects = shown_defects(file.section());
        report.sheet.append(defects.sheet);
        report.table = std::move(defects.table);
    } else if (file.section().find("variants")) {
        ShownVariants variants = shown_variants(file.section());
        report.sheet.append(variants.sheet);
        report.sheet.append(verdict_line(file.section()));
        report.table = std::move(variants.table);
    } else {
        RunAgain again = run_again(file, options.brief);
        report.sheet.append(again.sheet);
        report.table = std::move(again.table);
    }
    check_columns(options, report.sheet.column_keys());
    if (report.markdown.empty() || !options.columns.empty())
        report.markdown = report.sheet.markdown({.columns = options.columns});
    return report;
}

} // namespace

int show_command(const Options& options)
{
    if (options.out) check_not_an_input(*options.out, options.files);
    check_output(options);
    deliver(options, shown(read_result(options.files.at(0)), options));
    return 0;
}

} // namespace tetrace
