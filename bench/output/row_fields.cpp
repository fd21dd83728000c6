#include "bench/output/row_fields.h"

#include "bench/output/device_json.h"
#include "bench/output/fields/comparison_fields.h"
#include "bench/output/fields/field_parts.h"
#include "bench/rows/ray_json.h"
#include "bench/rows/row_tracing.h"
#include "core/base/hash.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

using namespace field_parts;
using nlohmann::json;

json text_or_nothing(const std::string& text)
{
    return text.empty() ? json() : json(text);
}

/// 0 is no hash, but that of what is not known.
json hash_or_nothing(std::uint64_t hash)
{
    return hash == 0 ? json() : json(hash_text(hash));
}

json reason_or_nothing(const RowRun& row)
{
    return text_or_nothing(reason_of(row));
}

std::string_view status_name(const RowRun& row)
{
    return name_of(status_of(row));
}

json fall_back(const RowRun& row)
{
    return row.packed != nullptr ? text_or_nothing(row.packed->fall_back) : json();
}

/// Rays of the packets that Embree splits the row's packets into, since the processor has no wider ones; nothing where
/// it does not.
json narrower_packets(const RowRun& row)
{
    const unsigned native = row.device.group_width;
    const bool is_split =
        is_embree(row.key.kernel.layout) && native > 0 && native < packet_width(row.key.kernel.method);
    return is_split && traced(row) != nullptr ? json(native) : json();
}

/// With facts for which the terminal has no column: the reason of a flawed row, that its tree is a fall-back or its
/// packets are narrower, and that a row is noisy, which is not ok.
std::string status_text(const RowFacts& facts)
{
    const bool noisy = facts.figures && facts.figures->noisy;
    std::string remarks = fall_back(*facts.row).is_null() ? "" : ", fall-back tree";
    if (const json packets = narrower_packets(*facts.row); !packets.is_null())
        remarks += fmt::format(", in packets of {}", packets.get<unsigned>());
    if (noisy && status_of(*facts.row) == Status::ok) return "noisy" + remarks;
    std::string text(status_name(*facts.row));
    if (status_of(*facts.row) == Status::flawed) text += ": " + reason_of(*facts.row);
    return text + remarks + (noisy ? ", noisy" : "");
}

json compile_and_build_s(const SetupTimes& setup)
{
    const double seconds = setup.compile_s + setup.build_s;
    return seconds > 0 ? json(seconds) : json();
}

std::optional<double> bvh_build_s(const RowFacts& facts)
{
    if (facts.setup.build_s > 0) return facts.setup.build_s;
    return facts.row->packed != nullptr ? facts.row->packed->bvh_build_s : std::nullopt;
}

/// Reads what there is only of answers that were compared with openmp's.
template <class Value>
auto if_compared(Value Traced::*member)
{
    return [=](const Traced& trace) { return trace.compared ? json(trace.*member) : json(); };
}

double a_ray(std::uint64_t count, const Visits& visits)
{
    return static_cast<double>(count) / static_cast<double>(visits.rays);
}

/// The row's identity and how it ended.
std::vector<RowField> identity_fields()
{
    return {
        {"", "name", [](const RowKey& key) { return row_name(key); },
         recorded("line", required, "structure/method/layout/scene/rays/math:mode/api:backend: the keys below in one"),
         csv("name"), check("row")},
        {"", "row", kernel_title, rates("row"), times("row")},
        {"", "backend", device_label, rates({.title = "backend", .rank = 0}), times({.title = "backend", .rank = 0})},
        {"", "scene", &RowKey::scene, recorded("line", required), csv("scene")},
        {"", "structure", in(&RowKey::kernel, named(&KernelId::structure)),
         recorded(R"({ "enum": ["cdt", "bvh"] })", required), csv("structure")},
        {"", "method", in(&RowKey::kernel, named(&KernelId::method)), recorded("line", required), csv("method")},
        {"", "layout", in(&RowKey::kernel, named(&KernelId::layout)), recorded("line", required), csv("layout")},
        {"", "backend", &RowKey::backend, recorded("line", required), csv("backend")},
        {"", "device", [](const RowRun& row) { return row.device.name.empty() ? json() : device_json(row.device); },
         recorded("device", optional, "as in tetrace.devices, without what was measured of it")},
        {"", "device", in(&RowRun::device, unless_empty(&Device::name)), csv("device")},
        {"", "type", [](const RowRun& row) { return text_or_nothing(device_kind_text(row)); }, csv("type")},
        {"", "device_index", [](const RowRun& row) { return row.device.name.empty() ? json() : json(row.key.device); },
         recorded("count")},
        {"", "rays", named(&RowKey::rays),
         recorded(R"({ "enum": ["primary", "shadow", "ao", "diffuse", "random"] })", required, "their kind"),
         csv("rays")},
        {"", "ray_order", named(&RowKey::ray_order), recorded(R"({ "enum": ["tiles", "morton", "shuffled"] })")},
        {"", "ray_hash",
         [](const RowRun& row) {
             const bool are_given = row.scene != nullptr && traced(row) != nullptr && row.key.kernel.task == Task::rays;
             return are_given ? json(hash_text(hash_of_rays(row))) : json();
         },
         recorded("hash", optional,
                  "of the rays that are given, view after view: equal hashes are the same rays, bit for bit")},
        {"", "math", in(&RowKey::kernel, named(&KernelId::math)),
         recorded(R"({ "enum": ["exact", "fast"] })", required), csv("math")},
        {"", "order", named(&RowKey::order),
         recorded(R"({ "enum": ["chains", "hilbert", "reached", "input"] })", required, "of the tets in memory"),
         csv("order")},
        {"", "schedule", in(&RowKey::kernel, named(&KernelId::schedule)),
         recorded(R"({ "enum": ["tiles", "persistent", "packets", "native", "pipeline"] })", optional,
                  "how rays come to work items; results from before this key have it in the row's name"),
         csv("schedule")},
        {"", "status", status_name, recorded("status", required), csv("status")},
        {"", "reason", reason_or_nothing, recorded("text"), csv("reason")},
        {"", "fall_back", fall_back,
         recorded("line", optional, "of our BVHs: why it is not the heuristic's best tree")},
        {"", "narrower_packets", narrower_packets,
         recorded("count", optional,
                  "of Embree's packets: rays of the packets that it splits them into, where the processor has no wider "
                  "ones")},
        {"", "self_test", [](const RowRun& row) { return row.self_test ? self_test_json(*row.self_test) : json(); },
         recorded("self_test", optional, "how the device computes in the row's math mode")},
    };
}

/// Its speed alone; comparison_fields() follow.
std::vector<RowField> rate_fields()
{
    return {
        {"rates", "mrays_per_s", &Figures::mrays_per_s,
         recorded("positive", required, "throughput: of the median sample, as all rates, which traces views together"),
         csv("rate", "Mrays/s"), rates({.title = "Mrays/s", .rank = 0})},
        {"rates", "latency_mrays_per_s", &Figures::latency_mrays_per_s,
         recorded("positive", optional, "with a launch for each view, one after the other"),
         csv("latency rate", "Mrays/s")},
        {"rates", "mhits_per_s", &Figures::mhits_per_s,
         recorded("positive", optional, "millions of rays per second that hit: mrays_per_s times counts.hit_share"),
         csv("rate", "Mhits/s"), rates({.title = "Mhits/s", .rank = 6})},
        {"rates", "msteps_per_s", &Figures::msteps_per_s, recorded("positive"), csv("rate", "Msteps/s", 1),
         rates({.title = "Msteps/s", .decimals = 1, .rank = 5})},
        {"counts", "mean_steps", [](const Traced& trace) { return mean_steps(trace.totals).all; },
         recorded("not_negative"), csv("steps per ray")},
        {"counts", "mean_steps_hit", [](const Traced& trace) { return mean_steps(trace.totals).hit; },
         recorded("not_negative"), csv("steps per hit")},
        {"counts", "mean_steps_miss", [](const Traced& trace) { return mean_steps(trace.totals).miss; },
         recorded("not_negative"), csv("steps per miss")},
    };
}

/// Its bandwidth.
std::vector<RowField> bandwidth_fields()
{
    return {
        {"rates", "estimated_gb_per_s", &Figures::gb_per_s,
         recorded("positive", optional, "steps times bytes_per_step"), csv("estimated", "GB/s", 1)},
        {"rates", "bytes_per_step",
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
        {"rates", "ceiling_bytes_per_s", &CopyShares::ceiling_bytes_per_s,
         recorded("positive", optional, "copy bandwidth of the level of that memory that holds the row's `bytes`")},
        {"rates", "share_of_ceiling", &CopyShares::of_ceiling, recorded("positive"), csv("share of ceiling"),
         rates({.title = "of copy", .cell = percent<0>, .rank = 3})},
    };
}

/// Where its time goes.
std::vector<RowField> time_fields()
{
    return {
        {"", "bytes", [](const RowRun& row) { return row.session ? json(row.session->bytes()) : json(); },
         csv("size", "bytes")},
        {"times", "clock",
         [](const RowFacts& facts) { return traced(*facts.row) ? json(facts.row->backend->clock()) : json(); },
         recorded("line", required)},
        {"", "compile_and_build_s", compile_and_build_s, times("compile", "ms", 1, milliseconds)},
        {"times", "compile_s", positive(&SetupTimes::compile_s), recorded("positive", optional, "of Embree: its build"),
         csv("compile", "s", 6), report("compile", "", 1, milliseconds)},
        {"times", "compile_cached",
         [](const RowFacts& facts) { return facts.setup.compile_cached ? json(true) : json(); },
         recorded(R"({ "type": "boolean" })", optional, "the kernel came from the cache of compiled programs"),
         times("cached")},
        {"times", "upload_s", positive(&SetupTimes::upload_s), recorded("positive"), csv("upload", "s", 6),
         times("upload", "ms", 1, milliseconds), report("upload", "", 1, milliseconds)},
        {"times", "pack_s", [](const RowRun& row) { return row.packed != nullptr ? json(row.packed->pack_s) : json(); },
         recorded("not_negative")},
        {"times", "build_s",
         [](const RowRun& row) {
             const auto cost = setup_cost(row);
             return cost ? json(cost->build_s) : json();
         },
         recorded("not_negative", optional,
                  "what the row's structure took to build: TetGen and our optimiser, also if the scene came from the "
                  "cache; the builder of our BVHs; Embree, or a GPU's driver")},
        {"times", "bvh_build_s", bvh_build_s,
         recorded("not_negative", optional,
                  "of our BVHs, which share one tree; of layout rt the driver's, by the device's clock")},
        {"times", "first_kernel_s", &Traced::kernel_s,
         recorded("not_negative", required,
                  "the first pass over all views, in which devices compile what they left until then")},
        {"times", "first_wall_s", &Traced::wall_s, recorded("not_negative", required), csv("first", "s", 6),
         times("first", "ms", 1, milliseconds), report("first", "", 1, milliseconds)},
        {"times", "samples_s", unless_empty(&RowRun::samples_s),
         recorded("durations", optional, "kernel alone, all views, per pass")},
        {"times", "runs",
         [](const RowRun& row) {
             if (row.run_samples.size() < 2 || row.samples_s.empty()) return json();
             json medians;
             for (const auto& run : samples_of_runs(row))
                 medians.push_back(quantile(run, 0.5));
             return medians;
         },
         recorded("durations", optional, "medians of the runs, whose samples follow each other in samples_s"),
         csv("runs", "", 0, [](const json& runs) { return runs.is_null() ? Cell() : Cell(runs.size()); })},
        {"times", "launches",
         [](const RowRun& row) { return row.launches.joined > 0 ? json(row.launches.joined) : json(); },
         recorded(R"({ "type": "integer", "minimum": 1 })", optional,
                  "of a pass of a sample: 1, or as few as memory allows"),
         csv("launches")},
        {"times", "latency_launches",
         [](const RowRun& row) { return row.launches.single > 0 ? json(row.launches.single) : json(); },
         recorded(R"({ "type": "integer", "minimum": 1 })", optional,
                  "of a pass of latency_samples_s: views with rays")},
        {"times", "latency_samples_s", unless_empty(&RowRun::latency_samples_s),
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
         recorded("positive", optional, "of a million rays, by the same line; with fixed_s if that is left out"),
         csv("per Mray", "s", 9)},
        {"times", "passes", [](const RowRun& row) { return row.passes > 1 ? json(row.passes) : json(); },
         recorded(R"({ "type": "integer", "minimum": 2 })", optional,
                  "of a sample, which traces all views so often; of `reproduce` the most of any view or batch; left "
                  "out where once is long enough"),
         csv("passes")},
        {"times", "wall_samples_s", unless_empty(&RowRun::wall_samples_s),
         recorded("durations", optional, "launch to the end of waiting, on the host's clock")},
        {"times", "median_s", in(&Figures::kernel_s, &Statistics::median), recorded("positive"), csv("median", "s", 6),
         times("kernel", "ms", 1, milliseconds), report("kernel", "", 1, milliseconds)},
        {"times", "lower_quartile_s", in(&Figures::kernel_s, &Statistics::lower_quartile), recorded("positive")},
        {"times", "upper_quartile_s", in(&Figures::kernel_s, &Statistics::upper_quartile), recorded("positive")},
        {"times", "spread", in(&Figures::kernel_s, &Statistics::spread),
         recorded("not_negative", optional, "interquartile range over median"), csv("spread", "", 3),
         rates({.title = "spread", .cell = percent<1>, .rank = 2})},
        {"times", "noisy", &Figures::noisy,
         recorded(R"({ "type": "boolean" })", optional, "spread above 5 %, or disturbed"), csv("noisy")},
        {"times", "pulse", &RowRun::pulse_ratio,
         recorded("positive", optional, "the pulse beside a sample over its fastest: the median over the samples"),
         csv("pulse", "", 3)},
        {"times", "disturbed", unless_empty(&RowRun::disturbance),
         recorded("line", optional, "what else than the spread speaks against the rate")},
        {"times", "overhead_s", &Figures::overhead_s,
         recorded(R"({ "type": "number" })", optional,
                  "launching and waiting: median of wall less kernel, sample by sample"),
         csv("launch overhead", "s", 6), times("launch", "ms", 2, milliseconds), report("launch", "", 2, milliseconds)},
        {"times", "download_s", &Traced::download_s,
         recorded("not_negative", required,
                  "all views' output copied to the host in the warm pass before the samples, checks left out"),
         csv("download", "s", 6), times("download", "ms", 1, milliseconds), report("download", "", 1, milliseconds)},
        {"times", "wall_s", &Figures::wall_s,
         recorded("positive", optional, "launch to the end of waiting on the host's clock, median"),
         csv("wall", "s", 6), times("wall", "ms", 1, milliseconds), report("wall", "", 1, milliseconds)},
        {"", "bytes", [](const RowRun& row) { return row.session ? json(row.session->bytes()) : json(); },
         recorded("count", optional, "of the structure and its scene data on the device"),
         times("size", "MB", 1, megabytes), report("size", "MB", 1, megabytes)},
        {"", "gpu", [](const RowRun& row) { return row.gpu ? gpu_json(*row.gpu) : json(); },
         recorded("gpu", optional, "what it told during the samples: medians")},
        {"", "samples", [](const RowRun& row) { return row.samples_s.size(); }, csv("samples")},
        {"", "status", status_text, rates({.title = "status", .rank = 0})},
    };
}

/// What its rays met, and whether that is right.
std::vector<RowField> answer_fields()
{
    return {
        {"counts", "rays", in(&Traced::totals, &RayTotals::rays),
         recorded(R"({ "type": "integer", "minimum": 1 })", required),
         csv({.title = "rays traced", .key = "ray_count"})},
        {"counts", "hits", in(&Traced::totals, &RayTotals::hits), recorded("count", required),
         csv({.title = "hits", .key = "hit_count"})},
        {"counts", "entering", &Traced::entering,
         recorded("count", optional, "rays that enter the domain's box, counted from the rays themselves on the host")},
        {"counts", "enter_share", [](const Traced& trace) { return ray_shares(trace).enter; },
         recorded("share", optional, "of the rays: entering over rays"), csv("enter share", "", 3)},
        {"counts", "hit_share", [](const Traced& trace) { return ray_shares(trace).hit; },
         recorded("share", optional, "of the rays: hits over rays"), csv("hit share", "", 3)},
        {"counts", "misses", in(&Traced::totals, &RayTotals::misses), recorded("count", required)},
        {"counts", "lost", in(&Traced::totals, &RayTotals::lost), recorded("count", required)},
        {"counts", "steps",
         [](const Traced& trace) { return trace.totals.steps() > 0 ? json(trace.totals.steps()) : json(); },
         recorded("count")},
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
        {"verification", "ties", in(&Traced::verdicts, &Verdicts::ties),
         recorded("count", required, "another answer, which a curve within rounding of the ray gives: its witness"),
         csv("ties"), check("ties")},
        {"verification", "largest_tie_distance",
         [](const Traced& trace) { return trace.verdicts.ties > 0 ? json(trace.verdicts.max_tie_distance) : json(); },
         recorded("not_negative"), check("largest", "", 12)},
        {"verification", "settled", in(&Traced::verdicts, &Verdicts::settled),
         recorded("count", required, "with the exact ray, although some do"), check("settled")},
        {"verification", "offset", in(&Traced::verdicts, &Verdicts::offset),
         recorded("count", optional, "right only for the origin off the surface that a BVH's given ray starts from"),
         check("offset")},
        {"verification", "wrong", in(&Traced::verdicts, &Verdicts::wrong),
         recorded("count", required,
                  "exact arithmetic says that the row is, or its t, u and v are not those of its point"),
         csv("wrong"), check("wrong")},
        {"verification", "lost", in(&Traced::verdicts, &Verdicts::lost), recorded("count", required), csv("lost"),
         check("lost")},
        {"verification", "compared_with_openmp", &Traced::compared, recorded(R"({ "type": "boolean" })", required)},
        {"", "conformity", &RowFacts::conformity, recorded("line", optional, "of `check`, as in tetrace.matrix"),
         check("conformity")},
        {"verification", "different_from_openmp", if_compared(&Traced::different), recorded("count"), check("differ")},
        {"verification", "largest_ulps", if_compared(&Traced::max_ulps), recorded("count", optional, "of t, u and v"),
         check("ulps")},
        {"verification", "first_different",
         [](const Traced& trace) {
             return trace.first_different ? differing_ray_json(*trace.first_different) : json();
         },
         recorded("differing_ray")},
        {"verification", "first_wrong",
         in(&Traced::verdicts,
            [](const Verdicts& verdicts) {
                return verdicts.first_wrong ? wrong_ray_json(*verdicts.first_wrong) : json();
            }),
         recorded("wrong_ray")},
        {"", "hit_hash", [](const Traced& trace) { return hash_or_nothing(trace.hit_hash); },
         recorded("hash", optional, "of all hits, view after view: equal hashes are equal answers, bit for bit"),
         csv("hit hash"), check("hits")},
        {"", "views_hash", [](const Traced& trace) { return hash_or_nothing(trace.views_hash); },
         recorded("hash", optional,
                  "of the hashes of the views' hits, view after view: as hit_hash, and known of merged shards too")},
        {"", "status", status_name, check("status")},
        {"", "reason", reason_or_nothing, check("reason")},
    };
}

} // namespace

const std::vector<RowField>& row_fields()
{
    static const std::vector<RowField> all = [] {
        std::vector<RowField> fields;
        for (const auto& part : {identity_fields(), rate_fields(), comparison_fields(), bandwidth_fields(),
                                 time_fields(), answer_fields()})
            fields.insert(fields.end(), part.begin(), part.end());
        return fields;
    }();
    return all;
}

} // namespace tetrace
