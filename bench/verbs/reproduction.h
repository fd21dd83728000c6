#pragma once

#include "bench/output/bench_report.h"
#include "bench/output/report.h"
#include "bench/reproduce/scene_run.h"
#include "bench/reproduce/search_run.h"
#include "bench/reproduce/tables/paper_table.h"
#include "bench/reproduce/tables/tables.h"

#include <vector>

namespace tetrace {

/// All data of the result.
struct Reproduction {
    std::vector<SceneRun> runs;
    std::optional<SearchRun> searches;
    RunProgress progress;

    std::vector<RowDevice> devices;
    std::vector<PaperTable> tables;
    std::vector<PaperFigure> figures;
    std::vector<std::string> missing_scenes, missing_devices; ///< one sentence each
    Steadiness steadiness;
};

/// The options with what is not named: all methods of the paper, and its scenes that are available here, else the
/// embedded one. missing: gets a sentence for each of them that is not. Throws Error{usage} if table6 lacks
/// the methods that it needs.
[[nodiscard]] Options with_defaults(Options options, std::vector<std::string>& missing);

/// Throws Error{usage} if two scenes would have the same name.
void check_labels(const std::vector<SceneBuild>& builds);

/// Makes the tables and figures that were asked for of what was traced.
void make_tables(Reproduction& all, const Options& options);

[[nodiscard]] Report reproduction_report(const Reproduction& all, const Options& options);

/// The page of `reproduce rivals`, `ladder` or `volume`: these tables and figures, and in JSON all that `bench` records
/// too.
[[nodiscard]] Report bench_run_report(const BenchResult& result, const std::vector<PaperTable>& tables,
                                      const std::vector<PaperFigure>& figures, const Options& options);

/// Tells all timed rows what the pulse and the load of the whole run say about their rates. They must have been
/// watched.
void judge_steadiness(Reproduction& all, MachineWatch& watch);

/// The rows of all scenes, then those of searches.
[[nodiscard]] std::vector<RowRecord> all_rows(const Reproduction& all);

/// Whether `reproduce` is asked for the table or figure.
[[nodiscard]] bool wants(const Options& options, PaperTarget target);
/// Whether any of those asked for is of the scenes that --scene names.
[[nodiscard]] bool wants_scenes(const Options& options);

/// The builds that the requested tables need: the scenes as the options say, those of the paper also as near to its
/// counts as known, and the same with tets for rays. A scene without those that
/// are wanted has ours.
[[nodiscard]] std::vector<SceneBuild> scene_builds(const Options& options);

} // namespace tetrace
