#include "bench/output/report.h"
#include "bench/reproduce/tables/recorded_tables.h"
#include "bench/results/result_file.h"
#include "bench/show/show_report.h"
#include "bench/verbs/commands.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

std::string made_by(const ResultFile& file)
{
    return fmt::format("tetrace {}, {} by {} ({}) on {}, {}", file.head.verb, file.head.date, file.head.version,
                       file.head.commit, file.head.machine, file.head.system);
}

Report shown(const ResultFile& file, const Options& options)
{
    Report report{{}, Table({}), file.json};
    report.sheet.line(made_by(file));
    report.sheet.gap();
    if (file.head.verb == "reproduce") {
        const PaperTables all = read_tables(file.section());
        report.sheet.append(tables_sheet(all));
        report.table = tidy_table(all.tables, all.figures);
    } else {
        RunAgain again = run_again(file);
        report.sheet.append(again.sheet);
        report.table = std::move(again.table);
    }
    check_columns(options, report.sheet.column_keys());
    report.markdown = report.sheet.markdown({.columns = options.columns});
    return report;
}

} // namespace

int show_command(const Options& options)
{
    if (options.out) check_not_an_input(*options.out, options.files);
    check_output(options);
    deliver(options, shown(read_result(options.files.at(0), Repetitions::kept), options));
    return 0;
}

} // namespace tetrace
