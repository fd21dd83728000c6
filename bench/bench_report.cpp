#include "bench/bench_report.h"

#include "bench/figures.h"
#include "bench/row_json.h"
#include "bench/text.h"
#include "core/hash.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

std::string status_text(const RowRun& row, const BenchResult& result)
{
    std::string text(name_of(status_of(row)));
    if (status_of(row) == Status::flawed) text += ": " + reason_of(row);
    const auto figures = figures_of(row);
    if (figures && figures->kernel_s.noisy()) text += ", noisy";
    if (figures && result.measurement.lowered) text += fmt::format(", {} samples", row.samples_s.size());
    return text;
}

std::vector<const RowRun*> rows_of(const std::string& scene, const std::vector<RowRun>& rows)
{
    std::vector<const RowRun*> found;
    for (const RowRun& row : rows)
        if (row.key.scene == scene) found.push_back(&row);
    return found;
}

Table scene_table(const std::string& scene, const BenchResult& result)
{
    Table table({{"row", "row"},
                 {"backend", "backend"},
                 {"mrays", "Mrays/s"},
                 {"msteps", "Msteps/s", {}, 1},
                 {"steps", "steps/ray"},
                 {"ratio", "x single"},
                 {"gb", "GB/s", {}, 1},
                 {"bytes", "MB", {}, 1},
                 {"spread", "spread"},
                 {"status", "status"}});
    for (const RowRun* row : rows_of(scene, result.run.rows)) {
        const auto figures = figures_of(*row);
        const Traced* trace = traced(*row);
        table.add({kernel_title(row->key), row->key.backend, figures ? Cell(figures->mrays_per_s) : Cell(),
                   figures ? cell_of(figures->msteps_per_s) : Cell(),
                   trace ? cell_of(mean_steps(trace->totals).all) : Cell(),
                   cell_of(ratio_to_single(*row, result.run.rows)), figures ? cell_of(figures->gb_per_s) : Cell(),
                   row->session ? Cell(1e-6 * static_cast<double>(row->session->bytes())) : Cell(),
                   figures ? Cell(fmt::format("{:5.1f} %", 100 * figures->kernel_s.spread())) : Cell(),
                   status_text(*row, result)});
    }
    return table;
}

Table flat_table(const BenchResult& result)
{
    Table table({{"name", "name"},
                 {"scene", "scene"},
                 {"structure", "structure"},
                 {"method", "method"},
                 {"layout", "layout"},
                 {"backend", "backend"},
                 {"rays", "rays"},
                 {"math", "math"},
                 {"order", "order"},
                 {"status", "status"},
                 {"reason", "reason"},
                 {"mrays_per_s", "rate", "Mrays/s"},
                 {"msteps_per_s", "rate", "Msteps/s", 1},
                 {"mean_steps", "steps per ray"},
                 {"mean_steps_hit", "steps per hit"},
                 {"mean_steps_miss", "steps per miss"},
                 {"ratio_to_single", "ratio to Embree single"},
                 {"estimated_gb_per_s", "estimated", "GB/s", 1},
                 {"median_s", "median", "s", 6},
                 {"spread", "spread", {}, 3},
                 {"samples", "samples"},
                 {"ray_count", "rays traced"},
                 {"hit_count", "hits"},
                 {"ties", "ties"},
                 {"wrong", "wrong"},
                 {"lost", "lost"},
                 {"hit_hash", "hit hash"}});
    for (const RowRun& row : result.run.rows) {
        const auto figures = figures_of(row);
        const Traced* trace = traced(row);
        const MeanSteps mean = trace ? mean_steps(trace->totals) : MeanSteps{};
        const auto count = [&](std::uint64_t value) { return trace ? Cell(value) : Cell(); };
        const auto text = [](std::string_view value) { return Cell(std::string(value)); };
        const std::string reason = reason_of(row);
        const RayTotals totals = trace ? trace->totals : RayTotals{};
        const Verdicts verdicts = trace ? trace->verdicts : Verdicts{};
        table.add({row_name(row.key),
                   row.key.scene,
                   text(name_of(row.key.kernel.structure)),
                   text(name_of(row.key.kernel.method)),
                   text(name_of(row.key.kernel.layout)),
                   row.key.backend,
                   text(name_of(row.key.rays)),
                   text(name_of(row.key.kernel.math)),
                   text(name_of(row.key.order)),
                   text(name_of(status_of(row))),
                   reason.empty() ? Cell() : Cell(reason),
                   figures ? Cell(figures->mrays_per_s) : Cell(),
                   figures ? cell_of(figures->msteps_per_s) : Cell(),
                   cell_of(mean.all),
                   cell_of(mean.hit),
                   cell_of(mean.miss),
                   cell_of(ratio_to_single(row, result.run.rows)),
                   figures ? cell_of(figures->gb_per_s) : Cell(),
                   figures ? Cell(figures->kernel_s.median) : Cell(),
                   figures ? Cell(figures->kernel_s.spread()) : Cell(),
                   std::uint64_t{row.samples_s.size()},
                   count(totals.rays),
                   count(totals.hits),
                   count(verdicts.ties),
                   count(verdicts.wrong),
                   count(verdicts.lost),
                   trace ? Cell(hash_text(trace->hit_hash)) : Cell()});
    }
    return table;
}

std::string timed_sentence(const BenchResult& result, const Options& options)
{
    const Measurement& measurement = result.measurement;
    const std::string instead = measurement.lowered ? fmt::format(" ({} asked for; --budget {})", options.samples,
                                                                  seconds_text(options.budget_s))
                                                    : "";
    return fmt::format(
        "medians of {} samples a row{}, rows interleaved at random, {} in all. A sample is {} views of {} "
        "at {}x{} on {} threads.",
        measurement.samples, instead, seconds_text(measurement.wall_s), selected_views(options).size(),
        name_of(options.camera_set), options.width, options.height, resolved_threads(options));
}

std::string closing_lines(const BenchResult& result, const Options& options)
{
    std::string text = labelled("Verified", verdict_sentence(result.run.rows));
    if (result.measurement.wall_s > 0) {
        text += labelled("Timed", timed_sentence(result, options));
        text +=
            labelled("Columns", fmt::format("x single: rate over that of Embree's single rays. GB/s: steps times the "
                                            "layout's whole record; copying memory reaches {:.1f} GB/s here. spread: "
                                            "interquartile range over median, noisy above {:.0f} %.",
                                            1e-9 * result.copy_bytes_per_s, 100 * noisy_spread));
    }
    for (const std::string& sentence : result.missing_scenes)
        text += labelled("Missing", sentence);
    if (options.out) text += labelled("Result", options.out->string());
    return text;
}

nlohmann::json bench_json(const BenchResult& result, const Options& options)
{
    nlohmann::json section = result_head(options);
    section["samples_a_row"] = result.measurement.samples;
    section["samples_lowered"] = result.measurement.lowered;
    section["threads"] = resolved_threads(options);
    if (result.copy_bytes_per_s > 0) section["copy_bytes_per_s"] = result.copy_bytes_per_s;
    section["missing_scenes"] = result.missing_scenes;
    section["scenes"] = nlohmann::json::array();
    for (const auto& scene : result.run.scenes)
        section["scenes"].push_back(scene_json(*scene, options));
    section["rows"] = nlohmann::json::array();
    for (const RowRun& row : result.run.rows) {
        section["rows"].push_back(row_json(row, result.copy_bytes_per_s));
        if (const auto ratio = ratio_to_single(row, result.run.rows))
            section["rows"].back()["rates"]["ratio_to_single"] = *ratio;
    }
    nlohmann::json json = result.measurement.google_benchmark;
    if (json.is_null()) json = nlohmann::json::object();
    json["tetrace"] = std::move(section);
    return json;
}

} // namespace

std::string scene_headline(const SceneWork& scene, const std::vector<RowRun>& rows)
{
    const LoadedScene& loaded = scene.loaded();
    std::string sizes;
    for (const RowRun* row : rows_of(scene.label(), rows))
        if (row->packed != nullptr && sizes.empty()) sizes = size_text(row->packed->scene.bytes()) + ", ";
    std::string how = fmt::format("{} {}x{}", name_of(loaded.scene.domain.kind), loaded.scene.domain.divisions,
                                  loaded.scene.domain.divisions);
    if (!loaded.scene.build.switches.empty()) how += ", -" + loaded.scene.build.switches;
    if (loaded.from_cache) how += ", cached";
    return fmt::format("{}: {} tets, {} occlusive + {} free faces, {}built in {} ({})\n", scene.label(),
                       with_commas(scene.counts().tets), with_commas(scene.counts().occlusive_faces),
                       with_commas(scene.counts().free_faces), sizes, seconds_text(loaded.scene.build.build_s), how);
}

std::string labelled(const std::string& label, const std::string& text)
{
    constexpr std::size_t width = 110, margin = 10;
    return fmt::format("{:<{}}", label, margin) + wrapped(text, width, margin).substr(margin);
}

std::string verdict_sentence(const std::vector<RowRun>& rows)
{
    const Verdicts sum = all_verdicts(rows);
    if (sum.rays == 0) return "nothing.";
    std::string text = fmt::format("{} rays against Embree in robust mode, disagreements settled exactly: {} "
                                   "agree, {} ties",
                                   with_commas(sum.rays), with_commas(sum.agreed), with_commas(sum.ties));
    if (sum.ties > 0) text += fmt::format(" (at most {:.1e} from an edge)", sum.largest_tie_distance);
    return text + fmt::format(", {} settled for us, {} wrong, {} lost.", with_commas(sum.settled),
                              with_commas(sum.wrong), with_commas(sum.lost));
}

std::string failure_lines(const std::vector<RowRun>& rows)
{
    std::string text;
    for (const RowRun& row : rows) {
        const Status status = status_of(row);
        if (status != Status::ok && status != Status::flawed)
            text += fmt::format("{}: {}: {}\n", row_name(row.key), name_of(status), reason_of(row));
    }
    return text.empty() ? text : text + "\n";
}

Report bench_report(const BenchResult& result, const Options& options)
{
    Report report{{}, flat_table(result), bench_json(result, options)};
    for (const auto& scene : result.run.scenes)
        report.text +=
            scene_headline(*scene, result.run.rows) + "\n" + scene_table(scene->label(), result).text(2) + "\n";
    report.text += failure_lines(result.run.rows) + closing_lines(result, options);
    return report;
}

} // namespace tetrace
