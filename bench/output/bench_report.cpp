#include "bench/output/bench_report.h"

#include "bench/measuring/figures.h"
#include "bench/output/bench_answer.h"
#include "bench/output/bench_tables.h"
#include "bench/output/device_json.h"
#include "bench/output/row_json.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace tetrace {

namespace {

std::string timed_sentence(const BenchResult& result, const Options& options)
{
    const Measurement& measurement = result.measurement;
    const std::string instead = measurement.lowered ? fmt::format(" ({} asked for; --budget {})", options.samples,
                                                                  seconds_text(options.budget_s))
                                                    : "";
    const char* const few = measurement.samples < fewest_samples ? " Fewer than 5 samples give no interval." : "";
    return fmt::format(
        "medians of {} samples a row{}, rows interleaved at random, {} in all. A sample is {} views of {} "
        "at {}x{} on {} threads.{}",
        measurement.samples, instead, seconds_text(measurement.wall_s), selected_views(options).size(),
        name_of(options.camera_set), options.width, options.height, resolved_threads(options), few);
}

/// How many steps a ray of each kind takes in the scene; the same for all its rows of one method.
std::string steps_sentences(const std::string& scene, const std::vector<RowRun>& rows)
{
    std::string text;
    std::set<RayKind> told;
    for (const RowRun* row : rows_of(scene, rows)) {
        const Traced* result = traced(*row);
        const MeanSteps mean = result != nullptr ? mean_steps(result->totals) : MeanSteps{};
        if (!mean.all || !told.insert(row->key.rays).second) continue;
        text += row->key.rays == RayKind::primary ? "" : fmt::format("{}: ", name_of(row->key.rays));
        text += fmt::format("{:.2f} steps a ray", *mean.all);
        if (mean.hit && mean.miss)
            text += fmt::format(": {:.2f} where it hits, {:.2f} where not", *mean.hit, *mean.miss);
        text += "\n";
    }
    return text;
}

/// What a ray visits in each BVH, kind after kind.
std::string visits_sentences(const std::string& scene, const std::vector<RowRun>& rows)
{
    std::string text;
    for (const RowRun* row : rows_of(scene, rows)) {
        const Traced* result = traced(*row);
        if (result == nullptr || result->visits.rays == 0) continue;
        const auto rays = static_cast<double>(result->visits.rays);
        text += fmt::format("{}{}: {:.1f} nodes and {:.1f} triangles a ray", text.empty() ? "" : "; ",
                            kernel_title(row->key), static_cast<double>(result->visits.nodes) / rays,
                            static_cast<double>(result->visits.triangles) / rays);
    }
    return text.empty() ? text : wrapped(text, 110, 0);
}

const char* const rate_columns =
    "x openmp (x cuda and so on): rate over that of the same kernel with openmp, on a GPU with cuda, on the same "
    "hardware; medians, with their 95 % interval. x single: rate over that of Embree's single rays. of copy: what a "
    "step loads, times steps, over the copy bandwidth of the row's device. spread: interquartile range over median, "
    "noisy above 5 %.";

const char* const time_columns =
    "compile (with the building of Embree's BVH, or a driver's) and upload are paid once; first: wall of the first "
    "pass, in which devices compile what they left; then, for all views, kernel: device seconds; launch: wall less "
    "kernel, launching and waiting; download: hits to the host; wall: launch to end. Medians of the samples but for "
    "download.";

std::string closing_lines(const BenchResult& result, const Options& options)
{
    std::string text = labelled("Verified", verdict_sentence(result.run.rows));
    if (result.measurement.wall_s > 0) {
        text += labelled("Timed", timed_sentence(result, options));
        text += labelled("Rates", rate_columns);
        text += labelled("Times", time_columns);
    }
    for (const std::string& sentence : missing_devices(options))
        text += labelled("Missing", sentence);
    for (const std::string& sentence : result.missing_scenes)
        text += labelled("Missing", sentence);
    text += answer_text(result);
    if (options.out) text += labelled("Result", options.out->string());
    return text;
}

/// Of a row whose scene could not be loaded only the beginning of the reason: standard error has had all of it.
std::string failure_text(const RowRun& row, Status status)
{
    std::string reason = reason_of(row);
    if (row.scene == nullptr) reason = reason.substr(0, reason.find('\n'));
    return fmt::format("{}: {}", name_of(status), reason);
}

nlohmann::json bench_json(const BenchResult& result, const Options& options)
{
    nlohmann::json section = result_head(options);
    section["samples_a_row"] = result.measurement.samples;
    section["samples_lowered"] = result.measurement.lowered;
    section["threads"] = resolved_threads(options);
    if (const auto& load = result.measurement.load)
        section["load"] = {{"others", load->others}, {"average", load->average}, {"processors", load->processors}};
    section["missing_scenes"] = result.missing_scenes;
    section["scenes"] = nlohmann::json::array();
    for (const auto& scene : result.run.scenes)
        section["scenes"].push_back(scene_json(*scene, options));
    section["devices"] = nlohmann::json::array();
    for (const RowDevice& device : result.devices)
        section["devices"].push_back(row_device_json(device));
    section["rows"] = section["ratios"] = nlohmann::json::array();
    for (const RowFacts& facts : facts_of(result)) {
        section["rows"].push_back(row_json(facts));
        if (facts.comparison) section["ratios"].push_back(ratio_json(facts));
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
        if (row->packed != nullptr && sizes.empty() && row->key.kernel.structure == Structure::cdt)
            sizes = size_text(row->packed->data.bytes()) + ", ";
    std::string how = fmt::format("{} {}x{}", name_of(loaded.scene.domain.kind), loaded.scene.domain.divisions,
                                  loaded.scene.domain.divisions);
    if (loaded.scene.build.optimised.tets == TetsKind::rays) how += ", for rays";
    if (loaded.scene.build.optimised.end != OptimiserEnd::finished) how += ", unfinished";
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
    std::string text = fmt::format("{} rays, all by exact arithmetic: {} agree, {} ties", with_commas(sum.rays),
                                   with_commas(sum.agreed), with_commas(sum.ties));
    if (sum.ties > 0) text += fmt::format(" (by curves at most {:.1e} from their rays)", sum.largest_tie_distance);
    if (sum.offset > 0)
        text += fmt::format(", {} right for the offset origins that BVHs start from", with_commas(sum.offset));
    return text + fmt::format(", {} settled for us, {} wrong, {} lost.", with_commas(sum.settled),
                              with_commas(sum.wrong), with_commas(sum.lost));
}

std::string failure_lines(const std::vector<RowRun>& rows)
{
    struct Failure {
        const RowRun* first;
        std::string what;
        std::size_t count = 0;
    };
    std::vector<Failure> failures;
    for (const RowRun& row : rows) {
        const Status status = status_of(row);
        if (status == Status::ok || status == Status::flawed) continue;
        const std::string what = failure_text(row, status);
        const auto same = std::ranges::find_if(failures, [&](const Failure& failure) {
            return failure.what == what && failure.first->key.scene == row.key.scene;
        });
        ++(same == failures.end() ? failures.emplace_back(Failure{&row, what}) : *same).count;
    }
    std::string text;
    for (const Failure& failure : failures)
        text += failure.count == 1 ? fmt::format("{}: {}\n", row_name(failure.first->key), failure.what)
                                   : fmt::format("{} rows of {}, such as {}: {}\n", failure.count,
                                                 failure.first->key.scene, row_name(failure.first->key), failure.what);
    return text.empty() ? text : text + "\n";
}

Report bench_report(const BenchResult& result, const Options& options)
{
    Report report{{}, flat_table(result), bench_json(result, options)};
    for (const auto& scene : result.run.scenes)
        report.text += scene_headline(*scene, result.run.rows) + steps_sentences(scene->label(), result.run.rows) +
                       visits_sentences(scene->label(), result.run.rows) + "\n" +
                       rate_table(scene->label(), result).text(2) + "\n";
    if (result.measurement.wall_s > 0)
        report.text += "where the time goes\n\n" + time_table(result).text(2) + "\ndevices\n\n" +
                       device_table(result.devices).text(2) + "\n";
    report.text += failure_lines(result.run.rows) + closing_lines(result, options);
    return report;
}

} // namespace tetrace
