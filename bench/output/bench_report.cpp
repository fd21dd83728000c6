#include "bench/output/bench_report.h"

#include "bench/measuring/budget.h"
#include "bench/measuring/figures.h"
#include "bench/output/axis_lines.h"
#include "bench/output/brief.h"
#include "bench/output/device_json.h"
#include "bench/output/row_fields.h"
#include "bench/output/score.h"
#include "bench/rows/answer_form.h"
#include "bench/rows/sized_scene.h"
#include "bench/statistics/rank_interval.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace tetrace {

namespace {

/// "1024x1024": each size of the run once, in its order.
std::vector<std::string> sizes_of(const BenchResult& result)
{
    std::vector<std::string> sizes;
    for (const nlohmann::json& json : result.scenes) {
        const ResultValue scene(json, "scene");
        const std::string size = size_value(scene.at("width").count(), scene.at("height").count()).text;
        if (std::ranges::find(sizes, size) == sizes.end()) sizes.push_back(size);
    }
    return sizes;
}

std::set<unsigned> threads_of(const BenchResult& result)
{
    std::set<unsigned> counts = {result.threads};
    for (const RowRecord& row : result.rows)
        if (row.key.threads != 0) counts.insert(row.key.threads);
    return counts;
}

std::string timed_sentence(const BenchResult& result)
{
    const Measurement& measurement = result.measurement;
    const bool knows_more = measurement.lowered && result.samples_asked > 0;
    const std::string instead =
        knows_more ? fmt::format(" ({} asked for; --budget {})", result.samples_asked, seconds_text(result.budget_s))
                   : "";
    const std::string in_all =
        measurement.wall_s > 0 ? fmt::format(", {} in all", seconds_text(measurement.wall_s)) : "";
    const char* const few = measurement.samples < min_samples ? " Fewer than 5 samples give no interval." : "";
    std::size_t most = 0;
    for (const RowRecord& row : result.rows)
        most = std::max(most, row.samples_s.size());
    const std::string more =
        measurement.runs == 1 && most > measurement.samples ? fmt::format(", up to {} if they were noisy", most) : "";
    std::string text = fmt::format("medians of {}{} samples per row{}{}, rows interleaved at random{}.",
                                   measurement.runs > 1 ? fmt::format("{} runs of ", measurement.runs) : "",
                                   measurement.samples, instead, more, in_all);
    if (!result.scenes.empty()) {
        const ResultValue scene(result.scenes.front(), "scene");
        std::uint32_t passes = 1, in_flight = 1;
        for (const RowRecord& row : result.rows) {
            passes = std::max(passes, row.passes);
            in_flight = std::max(in_flight, row.key.in_flight);
        }
        text += fmt::format(" A sample is {} views of {} at {} on {} threads, traced together{}{}.",
                            scene.at("views").items().size(), scene.at("camera_set").line(),
                            fmt::join(sizes_of(result), ", "), fmt::join(threads_of(result), ", "),
                            passes > 1 ? fmt::format(", up to {} times in turn", passes) : "",
                            in_flight > 1 ? fmt::format(", up to {} of these launches in flight", in_flight) : "");
    }
    return text + few;
}

/// "rays: 45 % enter the domain, 16 % hit", kind after kind; nothing else says how much of a rate is rays that miss the
/// scene.
std::string share_sentences(const std::string& scene, const std::vector<RowRecord>& rows)
{
    std::string text;
    std::set<RayKind> told;
    for (const RowRecord* row : rows_of(scene, rows)) {
        const Traced* result = traced(*row);
        const RayShares shares = result != nullptr ? ray_shares(*result) : RayShares{};
        if (!traits_of(row->key.kernel.task).finds_hits) continue;
        if (!shares.hit || !told.insert(row->key.rays).second) continue;
        const std::string kind = row->key.rays == RayKind::primary ? "" : fmt::format("{} ", name_of(row->key.rays));
        const std::string enter = shares.enter ? percent_text(*shares.enter) + " enter the domain, " : "";
        text += fmt::format("{}rays: {}{} hit\n", kind, enter, percent_text(*shares.hit));
    }
    return text;
}

/// What the rays of each kind cross in the scene; nearly the same for all its rows of a task that crosses the domain.
std::string crossing_sentences(const std::string& scene, const std::vector<RowRecord>& rows)
{
    std::string text;
    std::set<std::pair<Task, RayKind>> told;
    for (const RowRecord* row : rows_of(scene, rows)) {
        const Traced* result = traced(*row);
        if (result == nullptr) continue;
        const std::string mean = answers_of(row->key.kernel.task).mean(name_of(row->key.rays), result->totals);
        if (!mean.empty() && told.insert({row->key.kernel.task, row->key.rays}).second) text += mean;
    }
    return text;
}

/// How many steps per ray each kind takes in the scene; the same for all its rows of one method.
std::string steps_sentences(const std::string& scene, const std::vector<RowRecord>& rows)
{
    std::string text;
    std::set<RayKind> told;
    for (const RowRecord* row : rows_of(scene, rows)) {
        const Traced* result = traced(*row);
        const MeanSteps mean = result != nullptr ? mean_steps(result->totals) : MeanSteps{};
        if (!traits_of(row->key.kernel.task).finds_hits) continue;
        if (!mean.all || !told.insert(row->key.rays).second) continue;
        text += row->key.rays == RayKind::primary ? "" : fmt::format("{}: ", name_of(row->key.rays));
        text += fmt::format("{:.2f} steps per ray", *mean.all);
        if (mean.hit && mean.miss) text += fmt::format(": {:.2f} per hit, {:.2f} per miss", *mean.hit, *mean.miss);
        text += "\n";
    }
    return text;
}

/// What a ray visits in each BVH, kind after kind.
std::string visits_sentences(const std::string& scene, const std::vector<RowRecord>& rows)
{
    std::string text;
    for (const RowRecord* row : rows_of(scene, rows)) {
        const Traced* result = traced(*row);
        if (result == nullptr || result->visits.rays == 0 || row->key.threads != 0) continue;
        const auto rays = static_cast<double>(result->visits.rays);
        append_item(text, "; ",
                    fmt::format("{}: {:.1f} nodes and {:.1f} triangles per ray", kernel_title(row->key),
                                static_cast<double>(result->visits.nodes) / rays,
                                static_cast<double>(result->visits.triangles) / rays));
    }
    return text;
}

const char* const rate_columns =
    "Mrays/s: throughput, with the views of a sample in flight together. x openmp (x cuda and so on): rate over "
    "that of the same kernel with openmp, on a GPU with cuda, on the same hardware; medians, with {}. x best BVH: "
    "the same over the fastest BVH on the device, named below. x single: rate over that of Embree's single rays. "
    "build paid: the billions of rays, and the seconds of tracing them, after which building the tets has paid off "
    "against the fastest BVH, both builds counted. of copy: what a step loads, times steps, over the bandwidth of "
    "copies, on the row's device, in the level of memory that holds the scene. spread: interquartile range over "
    "median, noisy above 5 %. noisy, too: the pulse, a fixed piece of work repeated through the run, took 1.25 "
    "times its fastest, others used more than a tenth of the processors, or a container's CPU quota stopped it.";

/// What the intervals of ratios are of.
std::string interval_meaning(unsigned runs)
{
    if (runs == 1) return "their 95 % interval of samples in one run (--runs has intervals over runs)";
    return runs < resampled_runs ? fmt::format("the range over {} runs", runs)
                                 : fmt::format("their 95 % interval over {} runs", runs);
}

const char* const time_columns =
    "compile (including building Embree's BVH, or a driver's) and upload happen once; first: wall time of the first "
    "pass, in which devices compile what is left; then, for all views, kernel: device seconds; launch: wall minus "
    "kernel, launching and waiting; download: hits to the host; wall: launch to end. latency: kernel of one view "
    "launched alone; fixed: cost of each launch, by the line through launches of one view and of all, if it is "
    "above the noise; per Mray: what a million rays add, by that line, or with fixed where that is left out. Medians "
    "of the samples, except for download.";

/// The rows that an interrupt left without a rate.
std::string untimed_sentence(const std::vector<RowRecord>& rows)
{
    std::string names;
    for (const RowRecord& row : rows)
        if (has_answers(row) && row.samples_s.empty())
            append_item(names, "; ", fmt::format("{}, {}", row.key.scene, row_label(row.key)));
    return names.empty() ? names : fmt::format(" With fewer than 5 samples, so without a rate: {}.", names);
}

Sheet closing_lines(const BenchResult& result)
{
    Sheet sheet;
    sheet.labelled("Verified", verdict_sentence(result.rows));
    if (is_timed(result)) {
        sheet.labelled("Timed", timed_sentence(result));
        sheet.labelled("Rates", fmt::format(fmt::runtime(rate_columns), interval_meaning(result.measurement.runs)));
        sheet.labelled("Times", time_columns);
    }
    if (result.interrupted) sheet.labelled("Stopped", interrupted_sentence + untimed_sentence(result.rows));
    for (const auto& sentences : {result.missing_devices, result.missing_scenes})
        for (const std::string& sentence : sentences)
            sheet.labelled("Missing", sentence);
    sheet.append(answer_of(result));
    return sheet;
}

nlohmann::json bench_json(const BenchResult& result, nlohmann::json section)
{
    set_measurement(section, result.measurement);
    if (result.measurement.lowered) {
        section["samples_asked"] = result.samples_asked;
        section["budget_s"] = result.budget_s;
    }
    section["threads"] = result.threads;
    section["missing_scenes"] = result.missing_scenes;
    section["missing_devices"] = result.missing_devices;
    section["scenes"] = result.scenes;
    if (const Workload* const workload = workload_of(result.scenes, result.rows)) {
        section["workload"] = workload->name;
        if (is_timed(result)) section["scores"] = scores_json(scores_of(workload, result.rows));
    }
    section["devices"] = nlohmann::json::array();
    for (const RowDevice& device : result.devices)
        section["devices"].push_back(row_device_json(device));
    section["rows"] = section["ratios"] = nlohmann::json::array();
    for (const RowFacts& facts : facts_of(result)) {
        section["rows"].push_back(row_json(facts));
        if (facts.comparison) section["ratios"].push_back(ratio_json(facts));
    }
    return {{"tetrace", std::move(section)}};
}

} // namespace

void set_measurement(nlohmann::json& section, const Measurement& measurement)
{
    section["samples_a_row"] = measurement.samples * measurement.runs;
    if (measurement.runs > 1) section["runs"] = measurement.runs;
    section["samples_lowered"] = measurement.lowered;
    if (measurement.wall_s > 0) section["timed_s"] = measurement.wall_s;
    set_steadiness(section, measurement.load, measurement.pulses);
}

bool is_timed(const BenchResult& result)
{
    return result.measurement.wall_s > 0 ||
           std::ranges::any_of(result.rows, [](const RowRecord& row) { return figures_of(row).has_value(); });
}

std::string scene_headline(const ResultValue& scene)
{
    const auto text_of = [&](const char* key) {
        const auto value = scene.find(key);
        return value ? value->line() : std::string();
    };
    if (scene.find("no_tets"))
        return fmt::format("{}: no tets, {} triangles\n", scene.at("name").line(),
                           with_commas(scene.at("triangles").count()));
    const auto size = scene.find("packed_bytes"), optimised = scene.find("optimised");
    const std::uint64_t divisions = scene.at("divisions").count();
    std::string how = fmt::format("{} {}x{}", scene.at("domain").line(), divisions, divisions);
    if (text_of("tets_kind") == "rays") how += ", for rays";
    if (const auto end = optimised ? optimised->find("end") : std::nullopt; end && end->line() != "finished")
        how += ", unfinished";
    if (const std::string switches = text_of("switches"); !switches.empty()) how += ", -" + switches;
    if (scene.at("from_cache").flag()) how += ", cached";
    const auto bvh = scene.find("bvh_build_s");
    const auto built = scene.find("build_s");
    const std::string name = scene.at("name").line(), pinned = text_of("pinned");
    return fmt::format("{}: {} tets, {} occlusive + {} free faces, {}{} ({}){}\n",
                       pinned.empty() ? name : pinned + size_in(name), with_commas(scene.at("tets").count()),
                       with_commas(scene.at("occlusive_faces").count()), with_commas(scene.at("free_faces").count()),
                       size ? size_text(size->count()) + ", " : "",
                       built ? "built in " + seconds_text(built->number()) : "stored", how,
                       bvh ? fmt::format(", its BVH in {}", seconds_text(bvh->number())) : "");
}

std::string verdict_sentence(const std::vector<RowRecord>& rows)
{
    const Verdicts sum = all_verdicts(rows);
    if (sum.rays == 0) return "nothing.";
    const auto finds_hits = [](const RowRecord& row) { return traits_of(row.key.kernel.task).finds_hits; };
    const char* const how = std::ranges::all_of(rows, finds_hits) ? "with exact arithmetic" : "by the oracle";
    std::string text = fmt::format("{} rays, all {}: {} agree, {} ties", with_commas(sum.rays), how,
                                   with_commas(sum.agreed), with_commas(sum.ties));
    if (sum.ties > 0) text += fmt::format(" (by curves at most {:.1e} from their rays)", sum.max_tie_distance);
    if (sum.offset > 0)
        text += fmt::format(", {} right for the offset origins from which BVHs start", with_commas(sum.offset));
    return text + fmt::format(", {} settled, {} wrong, {} lost.", with_commas(sum.settled), with_commas(sum.wrong),
                              with_commas(sum.lost));
}

Sheet bench_sheet(const BenchResult& result)
{
    Sheet sheet;
    for (const nlohmann::json& scene : result.scenes) {
        const ResultValue value(scene, "scene");
        const std::string name = value.at("name").line();
        sheet.heading(scene_headline(value));
        sheet.line(share_sentences(name, result.rows));
        sheet.line(steps_sentences(name, result.rows));
        sheet.line(crossing_sentences(name, result.rows));
        sheet.prose(visits_sentences(name, result.rows));
        sheet.gap();
        if (const Table table = rate_table(name, result); !table.rows().empty()) {
            sheet.table(table);
            sheet.gap();
        }
    }
    if (const Workload* const workload = workload_of(result.scenes, result.rows); workload && is_timed(result)) {
        sheet.heading(fmt::format("scores: geometric means over {}", workload->name));
        sheet.gap();
        sheet.table(score_table(scores_of(workload, result.rows)));
        sheet.gap();
    }
    const auto add_axis = [&](const std::string& heading, const Table& table) {
        if (table.rows().empty()) return;
        sheet.heading(heading);
        sheet.gap();
        sheet.table(table);
        sheet.gap();
    };
    add_axis("rates by size, and the line through the smallest and the largest", size_table(size_lines(result)));
    add_axis("rates by threads", thread_table(thread_lines(result)));
    if (is_timed(result)) {
        sheet.heading("where the time goes");
        sheet.gap();
        sheet.table(time_table(result));
        sheet.gap();
        sheet.heading("devices");
        sheet.gap();
        sheet.table(device_table(result.devices));
        sheet.gap();
    }
    sheet.append(failure_lines(result.rows));
    sheet.append(closing_lines(result));
    return sheet;
}

Report bench_report(const BenchResult& result, const Options& options, nlohmann::json head)
{
    nlohmann::json json = bench_json(result, std::move(head));
    const RunOrigin origin(ResultValue(json, "the result").at("tetrace"));
    Report report{{}, flat_table(result, origin), std::move(json)};
    if (options.brief) {
        report.sheet.labelled("Machine", machine_sentence(ResultValue(report.json, "result").at("tetrace")));
        report.sheet.gap();
        report.sheet.append(brief_sheet(result));
    } else {
        report.sheet = bench_sheet(result);
    }
    report.markdown = report.sheet.markdown({.columns = options.columns});
    if (options.out) report.sheet.labelled("Result", options.out->string());
    return report;
}

} // namespace tetrace
