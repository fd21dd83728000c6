#include "bench/output/row_fields.h"

#include "bench/output/device_json.h"
#include "bench/output/field_parts.h"
#include "bench/results/self_test_json.h"
#include "bench/rows/ray_json.h"
#include "core/base/hash.h"
#include "core/base/printable.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

using namespace field_parts;
using nlohmann::json;

json text_or_nothing(const std::string& text)
{
    return text.empty() ? json() : json(text);
}

/// The tasks that rows name.
const std::string& schema_of_task()
{
    static const std::string schema = [] {
        std::vector<std::string> names;
        for (const Task task : values_of<Task>())
            if (traits_of(task).crosses) names.push_back(fmt::format("\"{}\"", name_of(task)));
        return fmt::format("{{ \"enum\": [{}] }}", fmt::join(names, ", "));
    }();
    return schema;
}

/// A name of kernels/kernel_list.inc.
template <class Name>
auto in_kernel(Name KernelId::*member)
{
    return both([=](const RowKey& key) { return json(name_of(key.kernel.*member)); },
                [=](RowKey& key, const ResultValue& value) {
                    const std::string name = value.line();
                    for (const Task task : values_of<Task>())
                        for (const KernelId& kernel : kernels_of(task))
                            if (name == name_of(kernel.*member)) {
                                key.kernel.*member = kernel.*member;
                                return;
                            }
                    value.reject(fmt::format("is '{}', which no kernel of this tetrace has", name));
                });
}

std::uint64_t hash_from(const ResultValue& value)
{
    return std::stoull(value.hash(), nullptr, 16);
}

/// 0 means that the hash is not known.
auto hash_or_nothing(std::uint64_t Traced::*member)
{
    return both([=](const Traced& trace) { return trace.*member == 0 ? json() : json(hash_text(trace.*member)); },
                [=](Traced& trace, const ResultValue& value) { trace.*member = hash_from(value); });
}

/// One where no other number is given.
auto above_one(std::uint32_t RowRecord::*member)
{
    return both([=](const RowRecord& row) { return row.*member > 1 ? json(row.*member) : json(); },
                [=](RowRecord& row, const ResultValue& value) { read_into(row.*member, value); });
}

/// Of a structure that has steps.
auto if_steps(std::uint64_t RayTotals::*member)
{
    return both([=](const Traced& trace) { return trace.totals.steps() > 0 ? json(trace.totals.*member) : json(); },
                [=](Traced& trace, const ResultValue& value) { read_into(trace.totals.*member, value); });
}

/// Of task absorb: without a light none is absorbed.
auto of_absorbed(std::uint64_t RayTotals::*member)
{
    return both([=](const Traced& trace) { return trace.totals.light_units > 0 ? json(trace.totals.*member) : json(); },
                [=](Traced& trace, const ResultValue& value) { read_into(trace.totals.*member, value); });
}

/// Of tasks segments and tally: without a length nothing is reversed.
auto of_segments(std::uint64_t RayTotals::*member)
{
    return both(
        [=](const Traced& trace) { return trace.totals.length_units > 0 ? json(trace.totals.*member) : json(); },
        [=](Traced& trace, const ResultValue& value) { read_into(trace.totals.*member, value); });
}

/// What neither hits nor misses have is of lost rays. After their fields.
auto all_steps()
{
    return both([](const Traced& trace) { return trace.totals.steps() > 0 ? json(trace.totals.steps()) : json(); },
                [](Traced& trace, const ResultValue& value) {
                    const std::uint64_t known = trace.totals.hit_steps + trace.totals.miss_steps;
                    trace.totals.lost_steps = std::max(value.count(), known) - known;
                });
}

json medians_of_runs(const RowRecord& row)
{
    if (row.run_samples.size() < 2 || row.samples_s.empty()) return {};
    json medians;
    for (const auto& run : samples_of_runs(row))
        medians.push_back(quantile(run, 0.5));
    return medians;
}

/// Runs have equally many samples.
void set_runs(RowRecord& row, const ResultValue& medians)
{
    const std::size_t runs = medians.items().size();
    if (runs > 0 && row.samples_s.size() % runs == 0) row.run_samples.assign(runs, row.samples_s.size() / runs);
}

json with_walk(json ray, const RayWalk& walk)
{
    if (!walk.openmp.empty()) ray["path"] = walk.openmp;
    if (!walk.own.empty()) ray["own_path"] = walk.own;
    if (!walk.command.empty()) ray["command"] = walk.command;
    return ray;
}

/// A ray of a result, which anyone may have written, and its walk.
template <class Ray>
void set_ray(std::optional<Ray>& to, RayWalk& walk, Ray (*read)(const json&), const ResultValue& from)
{
    try {
        to = read(from.json());
    } catch (const std::exception& problem) {
        from.reject(fmt::format("is not a ray: {}", problem.what()));
    }
    read_member(walk.openmp, from, "path");
    read_member(walk.own, from, "own_path");
    read_member(walk.command, from, "command");
}

auto first_different()
{
    return both(
        [](const Traced& trace) {
            const auto& ray = trace.first_different;
            return ray ? with_walk(differing_ray_json(*ray), trace.walk_of_different) : json();
        },
        [](Traced& trace, const ResultValue& value) {
            set_ray(trace.first_different, trace.walk_of_different, differing_ray_from, value);
        });
}

auto first_wrong()
{
    return both(
        [](const Traced& trace) {
            const auto& ray = trace.verdicts.first_wrong;
            return ray ? with_walk(wrong_ray_json(*ray), trace.walk_of_wrong) : json();
        },
        [](Traced& trace, const ResultValue& value) {
            if (value.find("embree")) return; // older results have its answer in place of the exact one
            auto& ray = trace.verdicts.first_wrong;
            set_ray(ray, trace.walk_of_wrong, wrong_ray_from, value);
            ray->reason = printable_text(ray->reason);
        });
}

/// What each repetition of a check showed.
auto repetitions()
{
    return both(
        [](const RowRecord& row) {
            json shown;
            for (const Finding one : row.repeated)
                shown.push_back(name_of(one));
            return shown;
        },
        [](RowRecord& row, const ResultValue& value) { read_into(row.repeated, value); });
}

json reason_or_nothing(const RowRecord& row)
{
    return text_or_nothing(reason_of(row));
}

std::string_view status_name(const RowRecord& row)
{
    return name_of(status_of(row));
}

/// Rays of the packets that Embree splits the row's packets into, since the CPU lacks wider ones; nothing if it does
/// not.
json narrower_packets(const RowRecord& row)
{
    const unsigned native = row.device.group_width;
    const bool is_split =
        is_embree(row.key.kernel.layout) && native > 0 && native < packet_width(row.key.kernel.method);
    return is_split && traced(row) != nullptr ? json(native) : json();
}

/// With facts that are not columns on the terminal: the reason of a flawed row, that its tree is a fall-back or its
/// packets are narrower, and that a row is noisy, which is not ok.
std::string status_text(const RowFacts& facts)
{
    const bool noisy = facts.figures && facts.figures->noisy;
    std::string remarks = facts.row->fall_back.empty() ? "" : ", fall-back tree";
    if (const json packets = narrower_packets(*facts.row); !packets.is_null())
        remarks += fmt::format(", in packets of {}", packets.get<unsigned>());
    if (noisy && status_of(*facts.row) == Status::ok) return "noisy" + remarks;
    std::string text(status_name(*facts.row));
    if (status_of(*facts.row) == Status::flawed) text += ": " + reason_of(*facts.row);
    return text + remarks + (noisy ? ", noisy" : "");
}

/// A GPU's driver builds BVHs as it compiles: when the row is opened.
json compile_and_build_s(const RowRecord& row)
{
    const bool is_built_by_driver = row.key.kernel.layout == Layout::rt;
    const double seconds = row.setup.compile_s + (is_built_by_driver ? row.setup.bvh_build_s.value_or(0) : 0);
    return seconds > 0 ? json(seconds) : json();
}

/// Reads what only hits that were compared with openmp's have.
auto if_compared(std::uint64_t Traced::*member)
{
    return both([=](const Traced& trace) { return trace.compared ? json(trace.*member) : json(); },
                [=](Traced& trace, const ResultValue& value) { read_into(trace.*member, value); });
}

double a_ray(std::uint64_t count, const Visits& visits)
{
    return static_cast<double>(count) / static_cast<double>(visits.rays);
}

/// The row's identity and how it ended.
std::vector<RowField> identity_fields()
{
    return {
        {row_key::name, [](const RowKey& key) { return row_name(key); },
         recorded("line", required, "structure/method/layout/scene/rays/math:mode/api:backend: the keys below in one"),
         csv("name"), check("row")},
        {"", "row", kernel_title, rates("row"), times("row")},
        {row_key::backend, device_label, rates({.title = "backend", .rank = 0}),
         times({.title = "backend", .rank = 0})},
        {row_key::scene, &RowKey::scene, recorded("line", required), csv("scene")},
        {row_key::structure, in(&RowKey::kernel, &KernelId::structure),
         recorded(R"({ "enum": ["cdt", "bvh"] })", required), csv("structure")},
        {row_key::method, in_kernel(&KernelId::method), recorded("line", required), csv("method")},
        {row_key::layout, in_kernel(&KernelId::layout), recorded("line", required), csv("layout")},
        {row_key::backend, &RowKey::backend, recorded("line", required), csv("backend")},
        {row_key::device,
         both([](const RowRecord& row) { return row.device.name.empty() ? json() : device_json(row.device); },
              [](RowRecord& row, const ResultValue& value) { row.device = device_from(value); }),
         recorded("device", optional, "as in tetrace.devices, without what was measured of it")},
        {row_key::device, [](const RowRecord& row) { return text_or_nothing(row.device.name); }, csv("device")},
        {"", "type", [](const RowRecord& row) { return text_or_nothing(device_kind_text(row)); }, csv("type")},
        {row_key::device_index,
         both([](const RowRecord& row) { return row.device.name.empty() ? json() : json(row.key.device); },
              [](RowRecord& row, const ResultValue& value) { row.key.device = value.count(); }),
         recorded("count")},
        {row_key::threads,
         both([](const RowKey& key) { return key.threads == 0 ? json() : json(key.threads); },
              [](RowKey& key, const ResultValue& value) {
                  if (value.count() == 0 || value.count() > 4096) value.reject("is not a number of threads, 1 to 4096");
                  key.threads = static_cast<unsigned>(value.count());
              }),
         recorded("count", optional, "host threads, if the run has others, too: `tetrace.threads` is the most"),
         csv("threads")},
        {row_key::launches_in_flight,
         both([](const RowKey& key) { return key.in_flight == 1 ? json() : json(key.in_flight); },
              [](RowKey& key, const ResultValue& value) {
                  if (value.count() < 2 || value.count() > max_in_flight)
                      value.reject(fmt::format("is not a number of launches, 2 to {}", max_in_flight));
                  key.in_flight = static_cast<unsigned>(value.count());
              }),
         recorded("count", optional, "of a sample, on the device together, each with an output of its own; if not 1"),
         csv("launches in flight")},
        {row_key::task,
         both(
             [](const RowRecord& row) {
                 const Task task = asked_task(row.key.kernel.task);
                 return task == Task::trace ? json() : json(name_of(task));
             },
             [](RowRecord& row, const ResultValue& value) {
                 read_into(row.key.kernel.task, value);
                 if (!traits_of(row.key.kernel.task).crosses) value.reject("is not a task that rows name");
             }),
         recorded(schema_of_task().c_str(), optional, "left out of rows that trace"), csv("task")},
        {row_key::rays, &RowKey::rays,
         recorded(R"({ "enum": ["primary", "shadow", "ao", "diffuse", "random"] })", required, "their kind"),
         csv("rays")},
        {row_key::ray_order, &RowKey::ray_order, recorded(R"({ "enum": ["tiles", "morton", "shuffled"] })")},
        {"", "ray_hash",
         both([](const RowRecord& row) { return row.ray_hash ? json(hash_text(*row.ray_hash)) : json(); },
              [](RowRecord& row, const ResultValue& value) { row.ray_hash = hash_from(value); }),
         recorded("hash", optional,
                  "of the rays that are given, view after view: equal hashes are the same rays, bit for bit")},
        {row_key::math, in(&RowKey::kernel, &KernelId::math), recorded(R"({ "enum": ["exact", "fast"] })", required),
         csv("math")},
        {row_key::order, &RowKey::order,
         recorded(R"({ "enum": ["chains", "hilbert", "reached", "input"] })", required, "of the tets in memory"),
         csv("order")},
        {row_key::schedule, in(&RowKey::kernel, &KernelId::schedule),
         recorded(R"({ "enum": ["tiles", "persistent", "packets", "native", "pipeline"] })", optional,
                  "how rays come to work items; results from before this key have it in the row's name"),
         csv("schedule")},
        {row_key::status, status_name, recorded("status", required), csv("status")},
        {row_key::reason, reason_or_nothing, recorded("text"), csv("reason")},
        {"", "repeated", repetitions(),
         recorded(R"({ "type": "array", "minItems": 1, "items": { "$ref": "#/$defs/shown" } })", optional,
                  "of `check --repeat`: what each repetition showed")},
        {"", "fall_back", if_any(&RowRecord::fall_back),
         recorded("line", optional, "of our BVHs: why it is not the heuristic's best tree")},
        {"", "narrower_packets", narrower_packets,
         recorded("count", optional,
                  "of Embree's packets: rays of the packets that it splits them into, if the processor has no wider "
                  "ones")},
        {row_key::self_test,
         both([](const RowRecord& row) { return row.self_test ? self_test_json(*row.self_test) : json(); },
              [](RowRecord& row, const ResultValue& value) { row.self_test = self_test_from(value); }),
         recorded("self_test", optional, "how the device computes in the row's math mode")},
    };
}

/// Only its speed; comparison_fields() follow.
std::vector<RowField> rate_fields()
{
    return {
        {row_key::mrays_per_s, &Figures::mrays_per_s,
         recorded("positive", required, "throughput: of the median sample, as all rates, which traces views together"),
         csv("rate", "Mrays/s"), rates({.title = "Mrays/s", .rank = 0})},
        {"rates", "latency_mrays_per_s", &Figures::latency_mrays_per_s,
         recorded("positive", optional, "with a launch for each view, one after the other"),
         csv("latency rate", "Mrays/s")},
        {"rates", "mhits_per_s", &Figures::mhits_per_s,
         recorded("positive", optional, "millions of rays per second that hit: mrays_per_s times counts.hit_share"),
         csv("rate", "Mhits/s"), rates({.title = "Mhits/s", .rank = 6})},
        {row_key::msteps_per_s, &Figures::msteps_per_s, recorded("positive"), csv("rate", "Msteps/s", 1),
         rates({.title = "Msteps/s", .decimals = 1, .rank = 5})},
        {row_key::mean_steps, [](const Traced& trace) { return mean_steps(trace.totals).all; },
         recorded("not_negative"), csv("steps per ray")},
        {row_key::mean_steps_hit, [](const Traced& trace) { return mean_steps(trace.totals).hit; },
         recorded("not_negative"), csv("steps per hit")},
        {row_key::mean_steps_miss, [](const Traced& trace) { return mean_steps(trace.totals).miss; },
         recorded("not_negative"), csv("steps per miss")},
    };
}

/// Its bandwidth.
std::vector<RowField> bandwidth_fields()
{
    return {
        {"rates", "estimated_gb_per_s", &Figures::gb_per_s,
         recorded("positive", optional, "steps times bytes_per_step"), csv("estimated", "GB/s", 1)},
        {row_key::bytes_per_step,
         [](const RowFacts& facts) {
             const bool has_any = facts.figures && facts.figures->gb_per_s;
             return has_any ? json(bytes_per_step(facts.row->key.kernel)) : json();
         },
         recorded("positive")},
        {"rates", "bytes_per_step_is",
         [](const Figures& figures) {
             return figures.gb_per_s ? json("an estimate: what a step loads of its tet's record on average "
                                            "(docs/spec/devices.md, W7)")
                                     : json();
         },
         recorded("line")},
        {"rates", "share_of_copy_bandwidth", &CopyShares::of_memory,
         recorded("positive", optional, "of the memory of the row's own device"), csv("share of copy")},
        {row_key::ceiling_bytes_per_s, &CopyShares::ceiling_bytes_per_s,
         recorded("positive", optional, "copy bandwidth of the level of that memory that holds the row's `bytes`")},
        {"rates", "share_of_ceiling", &CopyShares::of_ceiling, recorded("positive"), csv("share of ceiling"),
         rates({.title = "of copy", .cell = percent<0>, .rank = 3})},
    };
}

/// Where its time goes.
std::vector<RowField> time_fields()
{
    return {
        {row_key::bytes, &RowSetup::bytes, csv("size", "bytes")},
        {"times", "clock", if_any(&RowRecord::clock), recorded("line", required)},
        {"", "compile_and_build_s", compile_and_build_s, times("compile", "ms", 1, milliseconds)},
        {"times", "compile_s", if_any(&RowSetup::compile_s), recorded("positive", optional, "of Embree: its build"),
         csv("compile", "s", 6), report("compile", "", 1, milliseconds)},
        {"times", "compile_cached", if_any(&RowSetup::compile_cached),
         recorded(R"({ "type": "boolean" })", optional, "the kernel came from the cache of compiled programs"),
         times("cached")},
        {"times", "upload_s", if_any(&RowSetup::upload_s), recorded("positive"), csv("upload", "s", 6),
         times("upload", "ms", 1, milliseconds), report("upload", "", 1, milliseconds)},
        {"times", "pack_s", &RowSetup::pack_s, recorded("not_negative")},
        {"times", "build_s", &RowSetup::build_s,
         recorded("not_negative", optional,
                  "what the row's structure took to build: TetGen and our optimiser, also if the scene came from the "
                  "cache; the builder of our BVHs; Embree, or a GPU's driver")},
        {"times", "bvh_build_s", &RowSetup::bvh_build_s,
         recorded("not_negative", optional,
                  "of our BVHs, which share one tree; of layout rt the driver's, by the device's clock")},
        {"times", "first_kernel_s", &Traced::kernel_s,
         recorded("not_negative", required,
                  "the first pass over all views, in which devices compile what they left until then")},
        {"times", "first_wall_s", &Traced::wall_s, recorded("not_negative", required), csv("first", "s", 6),
         times("first", "ms", 1, milliseconds), report("first", "", 1, milliseconds)},
        {row_key::samples_s, if_any(&RowRecord::samples_s),
         recorded("durations", optional, "kernel alone, all views, per pass")},
        {"times", "runs", both(medians_of_runs, set_runs),
         recorded("durations", optional, "medians of the runs, whose samples follow each other in samples_s"),
         csv("runs", "", 0, [](const json& runs) { return runs.is_null() ? Cell() : Cell(runs.size()); })},
        {row_key::launches, in(&RowRecord::launches, if_any(&LaunchCounts::joined)),
         recorded(R"({ "type": "integer", "minimum": 1 })", optional,
                  "of a pass of a sample: 1, or as few as memory allows"),
         csv("launches")},
        {"times", "latency_launches", in(&RowRecord::launches, if_any(&LaunchCounts::single)),
         recorded(R"({ "type": "integer", "minimum": 1 })", optional,
                  "of a pass of latency_samples_s: views with rays")},
        {"times", "latency_samples_s", if_any(&RowRecord::latency_samples_s),
         recorded("durations", optional,
                  "as samples_s, with a launch for each view; left out if samples_s are the same")},
        {"times", "latency_s", &Figures::latency_s,
         recorded("positive", optional, "of a view that is launched alone: mean of the views, median"),
         csv("latency", "s", 6), times("latency", "ms", 3, milliseconds), report("latency", "", 3, milliseconds)},
        {"times", "fixed_s", &Figures::fixed_s,
         recorded(
             "positive", optional,
             "of each launch, by the line through samples_s and latency_samples_s; left out if it is not above the "
             "noise"),
         csv("fixed", "s", 9), times("fixed", "ms", 3, milliseconds), report("fixed", "", 3, milliseconds)},
        {"times", "s_per_mray", &Figures::s_per_mray,
         recorded("positive", optional,
                  "of a million rays, by the same line; with fixed_s if that is left out; both are left out of rows "
                  "with several launches in flight"),
         csv("per Mray", "s", 9), times("per Mray", "ms", 3, milliseconds), report("per Mray", "", 3, milliseconds)},
        {"times", "passes", above_one(&RowRecord::passes),
         recorded(R"({ "type": "integer", "minimum": 2 })", optional,
                  "of a sample, which traces all views so often; of `reproduce` the most of any view or batch; left "
                  "out where once is long enough"),
         csv("passes")},
        {"times", "wall_samples_s", if_any(&RowRecord::wall_samples_s),
         recorded("durations", optional, "launch to the end of waiting, on the host's clock")},
        {row_key::median_s, in(&Figures::kernel_s, &Statistics::median), recorded("positive"), csv("median", "s", 6),
         times("kernel", "ms", 1, milliseconds), report("kernel", "", 1, milliseconds)},
        {"times", "fastest_s",
         [](const RowRecord& row) {
             return row.samples_s.empty() ? std::nullopt : std::optional(*std::ranges::min_element(row.samples_s));
         },
         recorded("positive", optional, "the fastest sample"), csv("fastest", "s", 6),
         report("fastest", "", 1, milliseconds)},
        {row_key::lower_quartile_s, in(&Figures::kernel_s, &Statistics::lower_quartile), recorded("positive")},
        {row_key::upper_quartile_s, in(&Figures::kernel_s, &Statistics::upper_quartile), recorded("positive")},
        {"times", "spread", in(&Figures::kernel_s, &Statistics::spread),
         recorded("not_negative", optional, "interquartile range over median"), csv("spread", "", 3),
         rates({.title = "spread", .cell = percent<1>, .rank = 2})},
        {row_key::noisy, &Figures::noisy,
         recorded(R"({ "type": "boolean" })", optional, "spread above 5 %, or disturbed"), csv("noisy")},
        {row_key::pulse, &RowRecord::pulse_ratio,
         recorded("positive", optional, "calibration during a sample over its fastest: the median over the samples"),
         csv("pulse", "", 3)},
        {row_key::disturbed, if_any(&RowRecord::disturbance),
         recorded("line", optional, "what else than the spread speaks against the rate")},
        {row_key::overhead_s, &Figures::overhead_s,
         recorded(R"({ "type": "number" })", optional,
                  "launching and waiting: median of wall less kernel, sample by sample"),
         csv("launch overhead", "s", 6), times("launch", "ms", 2, milliseconds), report("launch", "", 2, milliseconds)},
        {"times", "download_s", &Traced::download_s,
         recorded("not_negative", required,
                  "all views' output copied to the host in the warm pass before the samples, checks left out"),
         csv("download", "s", 6), times("download", "ms", 1, milliseconds), report("download", "", 1, milliseconds)},
        {row_key::wall_s, &Figures::wall_s,
         recorded("positive", optional, "launch to the end of waiting on the host's clock, median"),
         csv("wall", "s", 6), times("wall", "ms", 1, milliseconds), report("wall", "", 1, milliseconds)},
        {row_key::bytes, &RowSetup::bytes,
         recorded("count", optional, "of the structure and its scene data on the device"),
         times("size", "MB", 1, megabytes), report("size", "MB", 1, megabytes)},
        {"gpu", "clock_mhz", &GpuSummary::clock_mhz, recorded("positive")},
        {"gpu", "memory_clock_mhz", &GpuSummary::memory_clock_mhz, recorded("positive")},
        {"gpu", "power_w", &GpuSummary::power_w, recorded("not_negative")},
        {"gpu", "temperature_c", &GpuSummary::temperature_c, recorded(R"({ "type": "number" })")},
        {"gpu", "dropped_samples", &GpuSummary::dropped_samples,
         recorded("count", required, "taken again, since the GPU was throttled")},
        {"gpu", "throttled_samples", if_any(&GpuSummary::throttled_samples),
         recorded("count", optional, "kept, since it still was after that; the row is noisy then")},
        {"gpu", "throttled_by", if_any(&GpuSummary::throttled_by), recorded("line")},
        {"", "samples", [](const RowRecord& row) { return row.samples_s.size(); }, csv("samples")},
        {row_key::status, status_text, rates({.title = "status", .rank = 0})},
    };
}

/// What its rays met, and whether that is right.
std::vector<RowField> answer_fields()
{
    return {
        {row_key::ray_count, in(&Traced::totals, &RayTotals::rays),
         recorded(R"({ "type": "integer", "minimum": 1 })", required),
         csv({.title = "rays traced", .key = "ray_count"})},
        {row_key::hits, in(&Traced::totals, &RayTotals::hits), recorded("count", required),
         csv({.title = "hits", .key = "hit_count"})},
        {row_key::entering, &Traced::entering,
         recorded("count", optional, "rays that enter the domain's box, counted from the rays themselves on the host")},
        {"counts", "enter_share", [](const Traced& trace) { return ray_shares(trace).enter; },
         recorded("share", optional, "of the rays: entering over rays"), csv("enter share", "", 3)},
        {"counts", "hit_share", [](const Traced& trace) { return ray_shares(trace).hit; },
         recorded("share", optional, "of the rays: hits over rays"), csv("hit share", "", 3)},
        {"counts", "reversed", of_segments(&RayTotals::reversed),
         recorded("count", optional,
                  "of tasks segments and tally: faces that come before one met earlier, within rounding"),
         csv("reversed")},
        {"counts", "length_units", of_segments(&RayTotals::length_units),
         recorded("count", optional,
                  "of tasks segments and tally: the rays' length inside the tets, in units of 2^-28"),
         csv("length units")},
        {"counts", "absorbed", of_absorbed(&RayTotals::absorbed),
         recorded("count", optional, "of task absorb: rays that end where too little light passes"), csv("absorbed")},
        {"counts", "light_units", of_absorbed(&RayTotals::light_units),
         recorded("count", optional, "of task absorb: the light that reaches the rays' beginnings, in units of 2^-32"),
         csv("light units")},
        {"counts", "misses", in(&Traced::totals, &RayTotals::misses), recorded("count", required)},
        {"counts", "lost", in(&Traced::totals, &RayTotals::lost), recorded("count", required)},
        {row_key::hit_steps, if_steps(&RayTotals::hit_steps), recorded("count", optional, "of the rays that hit")},
        {"counts", "miss_steps", if_steps(&RayTotals::miss_steps), recorded("count", optional, "of those that miss")},
        {row_key::steps, all_steps(), recorded("count", optional, "lost rays included")},
        {"visits", "nodes", &Visits::nodes, recorded("count", required)},
        {"visits", "triangles", &Visits::triangles, recorded("count", required)},
        {"visits", "mean_nodes", [](const Visits& visits) { return a_ray(visits.nodes, visits); },
         recorded("not_negative", required)},
        {"visits", "mean_triangles", [](const Visits& visits) { return a_ray(visits.triangles, visits); },
         recorded("not_negative", required)},
        {"verification", "rays", in(&Traced::verdicts, &Verdicts::rays),
         recorded(R"({ "type": "integer", "minimum": 1 })", required), check("rays")},
        {"verification", "agreed", in(&Traced::verdicts, &Verdicts::agreed),
         recorded("count", required, "with the exact ray, and no edge or other triangle lies within rounding of it"),
         check("agreed")},
        {row_key::ties, in(&Traced::verdicts, &Verdicts::ties),
         recorded("count", required, "another answer, which a curve within rounding of the ray gives: its witness"),
         csv("ties"), check("ties")},
        {"verification", "largest_tie_distance",
         both(
             [](const Traced& trace) {
                 return trace.verdicts.ties > 0 ? json(trace.verdicts.max_tie_distance) : json();
             },
             [](Traced& trace, const ResultValue& value) { read_into(trace.verdicts.max_tie_distance, value); }),
         recorded("not_negative"), check("largest", "", 12)},
        {"verification", "settled", in(&Traced::verdicts, &Verdicts::settled),
         recorded("count", required, "with the exact ray, although some do"), check("settled")},
        {"verification", "offset", in(&Traced::verdicts, &Verdicts::offset),
         recorded("count", optional, "right only for the origin off the surface that a BVH's given ray starts from"),
         check("offset")},
        {row_key::wrong, in(&Traced::verdicts, &Verdicts::wrong),
         recorded("count", required,
                  "exact arithmetic says that the row is, or its t, u and v are not those of its point"),
         csv("wrong"), check("wrong")},
        {row_key::lost, in(&Traced::verdicts, &Verdicts::lost), recorded("count", required), csv("lost"),
         check("lost")},
        {row_key::compared_with_openmp, &Traced::compared, recorded(R"({ "type": "boolean" })", required)},
        {row_key::conformity, &RowFacts::conformity, recorded("line", optional, "of `check`, as in tetrace.matrix"),
         check("conformity")},
        {"verification", "lost_at_device_cap", if_any(&Traced::lost_at_device_cap),
         recorded("count", optional, "lost after as many steps as the device's loops are known to take")},
        {row_key::different_from_openmp, if_compared(&Traced::different), recorded("count"), check("differ")},
        {"verification", "inexact", if_compared(&Traced::inexact),
         recorded("count", optional, "rays of which some bit differs from openmp's, allowed or not")},
        {"verification", "largest_ulps", if_compared(&Traced::max_ulps), recorded("count", optional, "of t, u and v"),
         check("ulps")},
        {row_key::first_different, first_different(), recorded("differing_ray")},
        {row_key::first_wrong, first_wrong(), recorded("wrong_ray")},
        {row_key::hit_hash, hash_or_nothing(&Traced::hit_hash),
         recorded("hash", optional, "of all hits, view after view: equal hashes are equal answers, bit for bit"),
         csv("hit hash"), check("hits")},
        {row_key::views_hash, hash_or_nothing(&Traced::views_hash),
         recorded("hash", optional,
                  "of the hashes of the views' hits, view after view: as hit_hash, and known of merged shards too")},
        {row_key::status, status_name, check("status")},
        {row_key::reason, reason_or_nothing, check("reason")},
    };
}

} // namespace

const std::vector<RowField>& row_fields()
{
    static const std::vector<RowField> all = [] {
        std::vector<RowField> fields;
        for (const auto& part : {identity_fields(), rate_fields(), comparison_fields(), bandwidth_fields(),
                                 time_fields(), answer_fields(), origin_fields()})
            fields.insert(fields.end(), part.begin(), part.end());
        return fields;
    }();
    return all;
}

} // namespace tetrace
