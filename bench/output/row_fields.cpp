#include "bench/output/row_fields.h"

#include "bench/output/device_json.h"
#include "bench/output/ray_json.h"
#include "bench/output/self_test_json.h"
#include "bench/rows/row_tracing.h"
#include "core/base/hash.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;

Cell milliseconds(const json& value)
{
    return value.is_null() ? Cell() : Cell(1e3 * value.get<double>());
}

Cell megabytes(const json& value)
{
    return value.is_null() ? Cell() : Cell(1e-6 * value.get<double>());
}

template <int decimals>
Cell percent(const json& value)
{
    return value.is_null() ? Cell()
                           : Cell(fmt::format("{:{}.{}f} %", 100 * value.get<double>(), 3 + decimals, decimals));
}

std::optional<double> above_0(double value)
{
    return value > 0 ? std::optional(value) : std::nullopt;
}

std::optional<std::string> text_or_nothing(const std::string& text)
{
    return text.empty() ? std::nullopt : std::optional(text);
}

std::optional<std::string> reason_or_nothing(const RowRun& row)
{
    return text_or_nothing(reason_of(row));
}

std::string_view status_name(const RowRun& row)
{
    return name_of(status_of(row));
}

/// With facts for which the terminal has no column: the reason of a flawed row, and that a row is noisy.
std::string status_text(const RowFacts& facts)
{
    std::string text(status_name(*facts.row));
    if (status_of(*facts.row) == Status::flawed) text += ": " + reason_of(*facts.row);
    if (facts.figures && facts.figures->kernel_s.noisy()) text += ", noisy";
    return text;
}

json json_of_ray(const std::optional<DifferingRay>& ray)
{
    return ray ? differing_ray_json(*ray) : json();
}

json json_of_ray(const std::optional<WrongRay>& ray)
{
    return ray ? wrong_ray_json(*ray) : json();
}

std::optional<double> bvh_build_s(const RowFacts& facts)
{
    if (facts.setup.build_s > 0) return facts.setup.build_s;
    return facts.row->packed != nullptr ? facts.row->packed->bvh_build_s : std::nullopt;
}

double a_ray(std::uint64_t count, const Visits& visits)
{
    return static_cast<double>(count) / static_cast<double>(visits.rays);
}

/// The row's identity and how it ended.
std::vector<RowField> identity_fields()
{
    return {{.key = "name",
             .value = [](const RowKey& key) { return row_name(key); },
             .schema = "line",
             .required = true,
             .what = "structure/method/layout/scene/rays/math:mode/api:backend: the keys below in one",
             .csv = {"name"},
             .check = {"row"}},
            {.key = "row", .value = kernel_title, .rates = {"row"}, .times = {"row"}},
            {.key = "backend", .value = device_label, .rates = {"backend"}, .times = {"backend"}},
            {.key = "scene", .value = &RowKey::scene, .schema = "line", .required = true, .csv = {"scene"}},
            {.key = "structure",
             .value = [](const RowKey& key) { return name_of(key.kernel.structure); },
             .schema = R"({ "enum": ["cdt", "bvh"] })",
             .required = true,
             .csv = {"structure"}},
            {.key = "method",
             .value = [](const RowKey& key) { return name_of(key.kernel.method); },
             .schema = "line",
             .required = true,
             .csv = {"method"}},
            {.key = "layout",
             .value = [](const RowKey& key) { return name_of(key.kernel.layout); },
             .schema = "line",
             .required = true,
             .csv = {"layout"}},
            {.key = "backend", .value = &RowKey::backend, .schema = "line", .required = true, .csv = {"backend"}},
            {.key = "device",
             .value = [](const RowRun& row) { return row.device.name.empty() ? json() : device_json(row.device); },
             .schema = "device",
             .what = "as in tetrace.devices, without what was measured of it"},
            {.key = "device",
             .value = [](const RowRun& row) { return text_or_nothing(row.device.name); },
             .csv = {"device"}},
            {.key = "type",
             .value = [](const RowRun& row) { return text_or_nothing(device_kind_text(row)); },
             .csv = {"type"}},
            {.key = "device_index",
             .value = [](const RowRun& row) { return row.device.name.empty() ? json() : json(row.key.device); },
             .schema = "count"},
            {.key = "rays",
             .value = [](const RowKey& key) { return name_of(key.rays); },
             .schema = R"({ "enum": ["primary", "shadow", "ao", "diffuse", "random"] })",
             .required = true,
             .what = "their kind",
             .csv = {"rays"}},
            {.key = "ray_order",
             .value = [](const RowKey& key) { return name_of(key.ray_order); },
             .schema = R"({ "enum": ["tiles", "morton", "shuffled"] })"},
            {.key = "ray_hash",
             .value =
                 [](const RowRun& row) {
                     const bool are_given = traced(row) != nullptr && row.key.kernel.task == Task::rays;
                     return are_given ? json(hash_text(hash_of_rays(row))) : json();
                 },
             .schema = "hash",
             .what = "of the rays that are given, view after view: equal hashes are the same rays, bit for bit"},
            {.key = "math",
             .value = [](const RowKey& key) { return name_of(key.kernel.math); },
             .schema = R"({ "enum": ["exact", "fast"] })",
             .required = true,
             .csv = {"math"}},
            {.key = "order",
             .value = [](const RowKey& key) { return name_of(key.order); },
             .schema = R"({ "enum": ["hilbert", "reached", "input"] })",
             .required = true,
             .what = "of the tets in memory",
             .csv = {"order"}},
            {.key = "schedule",
             .value = [](const RowKey& key) { return name_of(key.kernel.schedule); },
             .schema = R"({ "enum": ["tiles", "persistent", "packets"] })",
             .what = "how rays come to work items; results from before this key have it in the row's name",
             .csv = {"schedule"}},
            {.key = "status", .value = status_name, .schema = "status", .required = true, .csv = {"status"}},
            {.key = "reason", .value = reason_or_nothing, .schema = "text", .csv = {"reason"}},
            {.key = "self_test",
             .value = [](const RowRun& row) { return row.self_test ? self_test_json(*row.self_test) : json(); },
             .schema = "self_test",
             .what = "how the device computes in the row's math mode"}};
}

/// Its speed, alone and compared with others.
std::vector<RowField> rate_fields()
{
    return {{.group = "rates",
             .key = "mrays_per_s",
             .value = &Figures::mrays_per_s,
             .schema = "positive",
             .required = true,
             .what = "of the median sample, as all rates",
             .csv = {"rate", "Mrays/s"},
             .rates = {"Mrays/s"}},
            {.group = "rates",
             .key = "msteps_per_s",
             .value = &Figures::msteps_per_s,
             .schema = "positive",
             .csv = {"rate", "Msteps/s", 1},
             .rates = {"Msteps/s", "", 1}},
            {.group = "counts",
             .key = "mean_steps",
             .value = [](const Traced& trace) { return mean_steps(trace.totals).all; },
             .schema = "not_negative",
             .csv = {"steps per ray"}},
            {.group = "counts",
             .key = "mean_steps_hit",
             .value = [](const Traced& trace) { return mean_steps(trace.totals).hit; },
             .schema = "not_negative",
             .csv = {"steps per hit"}},
            {.group = "counts",
             .key = "mean_steps_miss",
             .value = [](const Traced& trace) { return mean_steps(trace.totals).miss; },
             .schema = "not_negative",
             .csv = {"steps per miss"}},
            {.key = "comparison",
             .value =
                 [](const Comparison& comparison) {
                     const MedianRatio& rate = comparison.rate;
                     return fmt::format("{:5.2f} [{:.2f}, {:.2f}]", rate.value, rate.low, rate.high);
                 },
             .rates = {"x {reference}"}},
            {.group = ratio_group,
             .key = "row",
             .value = [](const RowFacts& facts) { return facts.comparison ? json(row_name(facts.row->key)) : json(); },
             .schema = "line",
             .required = true},
            {.group = ratio_group,
             .key = "ratio",
             .value = [](const Comparison& comparison) { return comparison.rate.value; },
             .schema = "positive",
             .required = true,
             .what = "the reference's median device seconds over the row's: above 1 the row is faster",
             .csv = {"ratio to reference"}},
            {.group = ratio_group,
             .key = "low",
             .value = [](const Comparison& comparison) { return comparison.rate.low; },
             .schema = "positive",
             .required = true,
             .csv = {.title = "low", .key = "ratio_low"}},
            {.group = ratio_group,
             .key = "high",
             .value = [](const Comparison& comparison) { return comparison.rate.high; },
             .schema = "positive",
             .required = true,
             .csv = {.title = "high", .key = "ratio_high"}},
            {.group = ratio_group,
             .key = "confidence",
             .value = [](const Comparison&) { return ratio_confidence; },
             .schema = R"({ "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1 })",
             .required = true},
            {.group = ratio_group,
             .key = "reference",
             .value = [](const Comparison& comparison) { return row_name(comparison.reference->key); },
             .schema = "line",
             .required = true,
             .csv = {"reference"}},
            {.group = "rates",
             .key = "ratio_to_single",
             .value = &RowFacts::ratio_to_single,
             .schema = "positive",
             .what = "to Embree's single rays on the same scene, same run; of rows on the host",
             .csv = {"ratio to Embree single"},
             .rates = {"x single"}},
            {.group = "rates",
             .key = "estimated_gb_per_s",
             .value = &Figures::gb_per_s,
             .schema = "positive",
             .what = "steps times bytes_per_step",
             .csv = {"estimated", "GB/s", 1}},
            {.group = "rates",
             .key = "bytes_per_step",
             .value =
                 [](const RowFacts& facts) {
                     const bool has_any = facts.figures && facts.figures->gb_per_s;
                     return has_any ? json(bytes_per_step(facts.row->key.kernel)) : json();
                 },
             .schema = "positive"},
            {.group = "rates",
             .key = "bytes_per_step_is",
             .value =
                 [](const Figures& figures) {
                     return figures.gb_per_s ? json("an estimate: what a step loads of its tet's record on average "
                                                    "(docs/spec/devices.md, W7)")
                                             : json();
                 },
             .schema = "line"},
            {.group = "rates",
             .key = "share_of_copy_bandwidth",
             .value = &RowFacts::share_of_copy,
             .schema = "positive",
             .what = "of the row's own device",
             .csv = {"share of copy"},
             .rates = {.title = "of copy", .cell = percent<0>}}};
}

/// Where its time goes.
std::vector<RowField> time_fields()
{
    return {
        {.key = "bytes",
         .value = [](const RowRun& row) { return row.session ? json(row.session->bytes()) : json(); },
         .csv = {"size", "bytes"}},
        {.group = "times",
         .key = "clock",
         .value = [](const RowFacts& facts) { return traced(*facts.row) ? json(facts.row->backend->clock()) : json(); },
         .schema = "line",
         .required = true},
        {.key = "compile_and_build_s",
         .value = [](const RowFacts& facts) { return above_0(facts.setup.compile_s + facts.setup.build_s); },
         .times = {"compile", "ms", 1, milliseconds}},
        {.group = "times",
         .key = "compile_s",
         .value = [](const RowFacts& facts) { return above_0(facts.setup.compile_s); },
         .schema = "positive",
         .what = "of Embree: its build",
         .csv = {"compile", "s", 6},
         .report = {"compile", "", 1, milliseconds}},
        {.group = "times",
         .key = "compile_cached",
         .value = [](const RowFacts& facts) { return facts.setup.compile_cached ? json(true) : json(); },
         .schema = R"({ "type": "boolean" })",
         .what = "the kernel came from the cache of compiled programs",
         .times = {"cached"}},
        {.group = "times",
         .key = "upload_s",
         .value = [](const RowFacts& facts) { return above_0(facts.setup.upload_s); },
         .schema = "positive",
         .csv = {"upload", "s", 6},
         .times = {"upload", "ms", 1, milliseconds},
         .report = {"upload", "", 1, milliseconds}},
        {.group = "times",
         .key = "pack_s",
         .value = [](const RowRun& row) { return row.packed != nullptr ? json(row.packed->pack_s) : json(); },
         .schema = "not_negative"},
        {.group = "times",
         .key = "bvh_build_s",
         .value = bvh_build_s,
         .schema = "not_negative",
         .what = "of our BVHs, which share one tree; of layout rt the driver's, by the device's clock"},
        {.group = "times",
         .key = "first_kernel_s",
         .value = &Traced::kernel_s,
         .schema = "not_negative",
         .required = true,
         .what = "the first pass over all views, in which devices compile what they left until then"},
        {.group = "times",
         .key = "first_wall_s",
         .value = &Traced::wall_s,
         .schema = "not_negative",
         .required = true,
         .csv = {"first", "s", 6},
         .times = {"first", "ms", 1, milliseconds},
         .report = {"first", "", 1, milliseconds}},
        {.group = "times",
         .key = "samples_s",
         .value = [](const RowRun& row) { return row.samples_s.empty() ? json() : json(row.samples_s); },
         .schema = "durations",
         .what = "kernel alone, all views"},
        {.group = "times",
         .key = "wall_samples_s",
         .value = [](const RowRun& row) { return row.wall_samples_s.empty() ? json() : json(row.wall_samples_s); },
         .schema = "durations",
         .what = "launch to the end of waiting, on the host's clock"},
        {.group = "times",
         .key = "median_s",
         .value = [](const Figures& figures) { return figures.kernel_s.median; },
         .schema = "positive",
         .csv = {"median", "s", 6},
         .times = {"kernel", "ms", 1, milliseconds},
         .report = {"kernel", "", 1, milliseconds}},
        {.group = "times",
         .key = "lower_quartile_s",
         .value = [](const Figures& figures) { return figures.kernel_s.lower_quartile; },
         .schema = "positive"},
        {.group = "times",
         .key = "upper_quartile_s",
         .value = [](const Figures& figures) { return figures.kernel_s.upper_quartile; },
         .schema = "positive"},
        {.group = "times",
         .key = "spread",
         .value = [](const Figures& figures) { return figures.kernel_s.spread(); },
         .schema = "not_negative",
         .what = "interquartile range over median",
         .csv = {"spread", "", 3},
         .rates = {.title = "spread", .cell = percent<1>}},
        {.group = "times",
         .key = "noisy",
         .value = [](const Figures& figures) { return figures.kernel_s.noisy(); },
         .schema = R"({ "type": "boolean" })",
         .what = "spread above 5 %"},
        {.group = "times",
         .key = "overhead_s",
         .value = &Figures::overhead_s,
         .schema = R"({ "type": "number" })",
         .what = "launching and waiting: median of wall less kernel, sample by sample",
         .csv = {"launch overhead", "s", 6},
         .times = {"launch", "ms", 2, milliseconds},
         .report = {"launch", "", 2, milliseconds}},
        {.group = "times",
         .key = "download_s",
         .value = &Traced::download_s,
         .schema = "not_negative",
         .required = true,
         .what = "all views' output copied to the host in the warm pass before the samples, checks left out",
         .csv = {"download", "s", 6},
         .times = {"download", "ms", 1, milliseconds},
         .report = {"download", "", 1, milliseconds}},
        {.group = "times",
         .key = "wall_s",
         .value = &Figures::wall_s,
         .schema = "positive",
         .what = "launch to the end of waiting on the host's clock, median",
         .csv = {"wall", "s", 6},
         .times = {"wall", "ms", 1, milliseconds},
         .report = {"wall", "", 1, milliseconds}},
        {.key = "bytes",
         .value = [](const RowRun& row) { return row.session ? json(row.session->bytes()) : json(); },
         .schema = "count",
         .what = "of the structure and its scene data on the device",
         .times = {"size", "MB", 1, megabytes},
         .report = {"size", "MB", 1, megabytes}},
        {.key = "samples", .value = [](const RowRun& row) { return row.samples_s.size(); }, .csv = {"samples"}},
        {.key = "status", .value = status_text, .rates = {"status"}}};
}

/// What its rays met, and whether that is right.
std::vector<RowField> answer_fields()
{
    return {
        {.group = "counts",
         .key = "rays",
         .value = [](const Traced& trace) { return trace.totals.rays; },
         .schema = R"({ "type": "integer", "minimum": 1 })",
         .required = true,
         .csv = {.title = "rays traced", .key = "ray_count"}},
        {.group = "counts",
         .key = "hits",
         .value = [](const Traced& trace) { return trace.totals.hits; },
         .schema = "count",
         .required = true,
         .csv = {.title = "hits", .key = "hit_count"}},
        {.group = "counts",
         .key = "misses",
         .value = [](const Traced& trace) { return trace.totals.misses; },
         .schema = "count",
         .required = true},
        {.group = "counts",
         .key = "lost",
         .value = [](const Traced& trace) { return trace.totals.lost; },
         .schema = "count",
         .required = true},
        {.group = "counts",
         .key = "steps",
         .value = [](const Traced& trace) { return trace.totals.steps() > 0 ? json(trace.totals.steps()) : json(); },
         .schema = "count"},
        {.group = "visits", .key = "nodes", .value = &Visits::nodes, .schema = "count", .required = true},
        {.group = "visits", .key = "triangles", .value = &Visits::triangles, .schema = "count", .required = true},
        {.group = "visits",
         .key = "mean_nodes",
         .value = [](const Visits& visits) { return a_ray(visits.nodes, visits); },
         .schema = "not_negative",
         .required = true},
        {.group = "visits",
         .key = "mean_triangles",
         .value = [](const Visits& visits) { return a_ray(visits.triangles, visits); },
         .schema = "not_negative",
         .required = true},
        {.group = "verification",
         .key = "rays",
         .value = [](const Traced& trace) { return trace.verdicts.rays; },
         .schema = R"({ "type": "integer", "minimum": 1 })",
         .required = true,
         .check = {"rays"}},
        {.group = "verification",
         .key = "agreed",
         .value = [](const Traced& trace) { return trace.verdicts.agreed; },
         .schema = "count",
         .required = true,
         .what = "with Embree in robust mode",
         .check = {"agreed"}},
        {.group = "verification",
         .key = "ties",
         .value = [](const Traced& trace) { return trace.verdicts.ties; },
         .schema = "count",
         .required = true,
         .what = "the ray passes within rounding of an edge that explains the other answer",
         .csv = {"ties"},
         .check = {"ties"}},
        {.group = "verification",
         .key = "largest_tie_distance",
         .value =
             [](const Traced& trace) {
                 return trace.verdicts.ties > 0 ? json(trace.verdicts.largest_tie_distance) : json();
             },
         .schema = "not_negative",
         .check = {"largest", "", 12}},
        {.group = "verification",
         .key = "settled",
         .value = [](const Traced& trace) { return trace.verdicts.settled; },
         .schema = "count",
         .required = true,
         .what = "exact arithmetic says that Embree is off",
         .check = {"settled"}},
        {.group = "verification",
         .key = "offset",
         .value = [](const Traced& trace) { return trace.verdicts.offset; },
         .schema = "count",
         .what = "right only for the origin off the surface that a BVH's given ray starts from",
         .check = {"offset"}},
        {.group = "verification",
         .key = "wrong",
         .value = [](const Traced& trace) { return trace.verdicts.wrong; },
         .schema = "count",
         .required = true,
         .what = "exact arithmetic says that the row is, or its t, u and v do not name one point",
         .csv = {"wrong"},
         .check = {"wrong"}},
        {.group = "verification",
         .key = "lost",
         .value = [](const Traced& trace) { return trace.verdicts.lost; },
         .schema = "count",
         .required = true,
         .csv = {"lost"},
         .check = {"lost"}},
        {.group = "verification",
         .key = "compared_with_openmp",
         .value = &Traced::compared,
         .schema = R"({ "type": "boolean" })",
         .required = true},
        {.key = "conformity",
         .value = &RowFacts::conformity,
         .schema = "line",
         .what = "of `check`, as in tetrace.matrix",
         .check = {"conformity"}},
        {.group = "verification",
         .key = "different_from_openmp",
         .value = [](const Traced& trace) { return trace.compared ? json(trace.different) : json(); },
         .schema = "count",
         .check = {"differ"}},
        {.group = "verification",
         .key = "largest_ulps",
         .value = [](const Traced& trace) { return trace.compared ? json(trace.largest_ulps) : json(); },
         .schema = "count",
         .what = "of t, u and v",
         .check = {"ulps"}},
        {.group = "verification",
         .key = "first_different",
         .value = [](const Traced& trace) { return json_of_ray(trace.first_different); },
         .schema = "differing_ray"},
        {.group = "verification",
         .key = "first_wrong",
         .value = [](const Traced& trace) { return json_of_ray(trace.verdicts.first_wrong); },
         .schema = "wrong_ray"},
        {.key = "hit_hash",
         .value = [](const Traced& trace) { return hash_text(trace.hit_hash); },
         .schema = "hash",
         .what = "of all hits, view after view: equal hashes are equal answers, bit for bit",
         .csv = {"hit hash"},
         .check = {"hits"}},
        {.key = "status", .value = status_name, .check = {"status"}},
        {.key = "reason", .value = reason_or_nothing, .check = {"reason"}}};
}

} // namespace

RowFacts::RowFacts(const RowRun& run)
    : row(&run), setup(run.session ? run.session->setup_times() : SetupTimes{}), figures(figures_of(run))
{
}

Cell plain_cell(const json& value)
{
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return value.get<double>();
    if (value.is_number()) return value.get<std::uint64_t>();
    return value.is_boolean() && value.get<bool>() ? Cell("yes") : Cell();
}

const std::vector<RowField>& row_fields()
{
    static const std::vector<RowField> all = [] {
        std::vector<RowField> fields;
        for (const auto& part : {identity_fields(), rate_fields(), time_fields(), answer_fields()})
            fields.insert(fields.end(), part.begin(), part.end());
        return fields;
    }();
    return all;
}

std::vector<Column> columns_of(Place place, const std::string& reference)
{
    std::vector<Column> columns;
    for (const RowField& field : row_fields())
        if (const Shown& shown = field.*place; shown.title != nullptr)
            columns.push_back({shown.key != nullptr ? shown.key : field.key,
                               fmt::format(fmt::runtime(shown.title), fmt::arg("reference", reference)), shown.unit,
                               shown.decimals});
    return columns;
}

std::vector<Cell> cells_of(Place place, const RowFacts& facts)
{
    std::vector<Cell> cells;
    for (const RowField& field : row_fields())
        if (const Shown& shown = field.*place; shown.title != nullptr) cells.push_back(shown.cell(field.value(facts)));
    return cells;
}

} // namespace tetrace
