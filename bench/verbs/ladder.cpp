#include "bench/verbs/ladder.h"

#include "bench/rows/row_tracing.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "core/base/control_groups.h"
#include "core/base/stopwatch.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <set>

namespace tetrace {

namespace {

constexpr unsigned rounds_of_lone_rays = 10; // min_views: fewer give no interval
constexpr double growth_of_making = 4;       // as there are more tets
constexpr double growth_of_verifying = 2;    // a ray crosses 1.6 times as many tets
constexpr double share_of_samples = 0.7;     // of a scene's budget; rays alone have the rest

/// Cubes along an axis for which half32 takes 1, 4, 16, 64, 256, 1024 and 4096 MB.
constexpr int ladder_lattices[] = {11, 17, 27, 44, 69, 110, 174};

/// Bytes of host memory that a scene of that many tets takes at its most, by /usr/bin/time for lattice:69: its own and
/// its packed forms, and once more what drivers that compute on the host's memory copy.
std::uint64_t host_bytes(std::uint64_t tets, const std::vector<RowKey>& rows)
{
    std::set<std::string> copying;
    for (const RowKey& row : rows)
        if (backend_named(row.backend).devices().at(row.device).kind == DeviceKind::emulated)
            copying.insert(device_label(row));
    return tets * (300 + 200 * copying.size());
}

/// Of a lattice; 0 for other scenes.
std::uint64_t tets_of(const std::string& scene)
{
    const auto n = lattice_resolution(scene);
    return n ? lattice_tets(*n) : 0;
}

/// Seconds of a scene until its rows are verified.
struct Preparation {
    double making_s = 0; ///< and packing and opening
    double verifying_s = 0;

    [[nodiscard]] double next_s() const { return growth_of_making * making_s + growth_of_verifying * verifying_s; }
};

/// Why a scene is not measured; empty if it is. expected_s: until its rows are verified.
std::string why_left_out(const std::string& scene, const std::vector<RowKey>& rows, double expected_s, double left_s)
{
    const std::uint64_t needed = host_bytes(tets_of(scene), rows), there = available_memory_bytes();
    if (needed > there)
        return fmt::format("{} is left out: making and packing it takes about {}, and {} of this machine's memory are "
                           "available",
                           scene, size_text(needed), size_text(there));
    if (expected_s > left_s)
        return fmt::format("{} is left out: making and verifying it takes about {}, and --budget leaves {}", scene,
                           seconds_text(expected_s), seconds_text(std::max(0.0, left_s)));
    return {};
}

/// Rays alone, of every row that is timed. Rows of one structure share what their rays visit.
std::vector<StepCosts> measure_lone_rays(std::vector<RowRun>& rows, const Budget& budget)
{
    std::vector<StepCosts> costs(rows.size());
    std::map<Layout, std::vector<double>> nodes; // by layout; empty for tets
    for (std::size_t i = 0; i < rows.size(); ++i) {
        RowRun& row = rows[i];
        if (is_interrupted() || !is_timed(row)) continue;
        progress_line().show("rays alone", static_cast<double>(i) / static_cast<double>(rows.size()), -1,
                             row.key.scene + ", " + row_label(row.key));
        const Layout layout = row.key.kernel.layout;
        if (!nodes.contains(layout)) nodes[layout] = visited_nodes(row, 0);
        measure_steps(row, costs[i], nodes[layout], rounds_of_lone_rays, budget);
    }
    progress_line().clear();
    return costs;
}

/// The host's calibration is the same work throughout; a GPU's is a scene's own. scene: empty if they name it already.
void append(std::vector<Pulse>& to, std::vector<Pulse> more, const std::string& scene)
{
    for (Pulse& pulse : more) {
        if (pulse.of != "host" && !scene.empty()) pulse.of += ", " + scene;
        const auto known = std::ranges::find(to, pulse.of, &Pulse::of);
        if (known == to.end())
            to.push_back(std::move(pulse));
        else
            std::ranges::move(pulse.readings, std::back_inserter(known->readings));
    }
}

} // namespace

void append(BenchResult& to, KeptPart part, const std::string& scene)
{
    std::ranges::move(part.rows, std::back_inserter(to.rows));
    for (const nlohmann::json& record : part.scenes)
        if (std::ranges::none_of(to.scenes,
                                 [&](const nlohmann::json& known) { return known["name"] == record["name"]; }))
            to.scenes.push_back(record);
    Measurement measured = std::move(part.measurement).value();
    measured.wall_s += to.measurement.wall_s;
    measured.lowered |= to.measurement.lowered;
    std::vector<Pulse> pulses = std::move(to.measurement.pulses);
    append(pulses, std::move(measured.pulses), scene);
    measured.pulses = std::move(pulses);
    to.measurement = std::move(measured);
}

namespace {

/// A scene of the ladder, measured.
struct Rung {
    KeptPart part;
    std::vector<StepCosts> costs; ///< of its rows
    Preparation preparation;
};

/// What the journal keeps of it in addition to its part.
nlohmann::json extra_of(const Rung& scene)
{
    nlohmann::json costs = nlohmann::json::array();
    for (const StepCosts& one : scene.costs)
        costs.push_back({{"steps", one.steps}, {"alone_s", one.alone_s}});
    return {{"costs", std::move(costs)},
            {"making_s", scene.preparation.making_s},
            {"verifying_s", scene.preparation.verifying_s}};
}

std::optional<Rung> kept_rung(const KeptParts& kept, const std::string& name, const std::vector<RowKey>& rows)
{
    Rung scene;
    auto part = kept.find(name, rows, [&](const nlohmann::json& extra) {
        if (extra.at("costs").size() != rows.size()) throw std::domain_error("rows lack their rays alone");
        for (const nlohmann::json& one : extra.at("costs"))
            scene.costs.push_back({one.at("steps"), one.at("alone_s")});
        scene.preparation = {extra.at("making_s"), extra.at("verifying_s")};
    });
    if (!part) return std::nullopt;
    scene.part = *std::move(part);
    return scene;
}

/// budget_s: of this scene.
Rung run_scene(const std::vector<RowKey>& rows, const Options& options, const Clock& clock, double budget_s)
{
    const Stopwatch stopwatch;
    MachineWatch watch = watch_of(host_pulse(resolved_threads(options)), nullptr, clock);
    const Budget whole(budget_s);
    Budget budget(share_of_samples * budget_s);
    const Recording shared{nullptr, nullptr, &watch, &budget};
    SceneRows run = open_and_verify(rows, options, {}, shared);
    const Preparation preparation{stopwatch.seconds() - budget.spent_s(), budget.spent_s()};
    Measurement measured = measure_rows(run.rows, options, {}, shared);
    std::vector<StepCosts> costs = measure_lone_rays(run.rows, whole);
    return {{records_of(run.rows), scene_records(run, options), std::move(measured)}, std::move(costs), preparation};
}

std::vector<RowKey> rows_of_scene(const std::vector<RowKey>& rows, const std::string& scene)
{
    std::vector<RowKey> found;
    std::ranges::copy_if(rows, std::back_inserter(found),
                         [&](const RowKey& row) { return row.scene == scene_label(scene); });
    return found;
}

} // namespace

Options ladder_options(Options options)
{
    if (options.scenes.empty())
        for (const int n : ladder_lattices)
            options.scenes.push_back(fmt::format("lattice:{}", n));
    if (options.layouts.empty()) options.layouts = {Layout::half32, Layout::tet64, Layout::bvh2};
    options.exact_samples = true; // further ones of noisy rows would take the time of rays alone
    if (options.methods.empty()) options.methods = {Method::project, Method::single};
    return options;
}

Ladder run_ladder(const Options& options, const std::vector<RowKey>& rows, KeptParts& kept)
{
    Ladder ladder;
    const Clock clock = host_clock();
    Preparation last;
    for (std::size_t i = 0; i < options.scenes.size() && !is_interrupted(); ++i) {
        Options of_scene = options;
        of_scene.scenes = {options.scenes[i]};
        const auto of_rows = rows_of_scene(rows, options.scenes[i]);
        if (of_rows.empty()) continue; // --filter
        const std::string label = scene_label(options.scenes[i]);
        const auto add = [&](Rung scene) {
            last = scene.preparation;
            std::ranges::move(scene.costs, std::back_inserter(ladder.costs));
            append(ladder.result, std::move(scene.part), label);
        };
        if (auto known = kept_rung(kept, label, of_rows)) {
            add(*std::move(known));
            continue;
        }
        const double left_s = options.budget_s - clock();
        const std::string reason =
            i == 0 ? std::string() : why_left_out(options.scenes[i], of_rows, last.next_s(), left_s);
        if (!reason.empty()) {
            say(reason);
            ladder.result.missing_scenes.push_back(reason);
            continue;
        }
        Rung scene =
            run_scene(of_rows, of_scene, kept.clock(), left_s / static_cast<double>(options.scenes.size() - i));
        if (!is_interrupted()) kept.keep(label, scene.part, extra_of(scene));
        add(std::move(scene));
    }
    complete(ladder.result, options);
    return ladder;
}

} // namespace tetrace
