#include "bench/rivals/rival_run.h"

#include "bench/measuring/comparison.h"
#include "bench/measuring/figures.h"
#include "bench/measuring/scene_rows.h"
#include "bench/rivals/rival_claims.h"
#include "bench/rows/physical_device.h"
#include "bench/rows/sized_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

namespace tetrace {

namespace {

constexpr const char* page = "docs/rivals.md";

const char* place_title(DeviceKind place)
{
    switch (place) {
    case DeviceKind::cpu: return "processors";
    case DeviceKind::gpu: return "GPUs";
    case DeviceKind::emulated: return "emulated GPUs";
    }
    return "";
}

PaperCell count_cell(const std::vector<Claim>& claims, ClaimVerdict verdict)
{
    return exact_cell(static_cast<double>(std::ranges::count(claims, verdict, &Claim::verdict)));
}

/// Where the old figures are from, a sentence for each measurement.
std::vector<std::string> old_runs(const std::vector<RivalClaim>& claims)
{
    std::vector<std::string> sentences;
    for (const RivalClaim& claim : claims) {
        const std::string sentence = fmt::format("{}: {}.", claim.old->name, claim.old->what);
        if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(sentence);
    }
    return sentences;
}

template <class Numerator, class Denominator>
PaperCell ratio_cell(const RivalContest& contest, Numerator walk, Denominator rival)
{
    const RowRecord *const first = contest.fastest(walk), *const second = contest.fastest(rival);
    if (first == nullptr || second == nullptr) return {};
    return Quantity{rate_ratio(*first, *second), {}};
}

/// Without the kind of rays, which has a column of its own.
std::string title_of(RowKey key)
{
    key.rays = RayKind::primary;
    return kernel_title(key);
}

PaperCell label_cell(const RowRecord* row)
{
    return row == nullptr ? PaperCell() : PaperCell(fmt::format("{}, {}", title_of(row->key), device_label(row->key)));
}

/// "openmp, embree": the APIs of its rows.
std::string devices_text(const RivalContest& contest)
{
    std::vector<std::string> labels;
    for (const RowRecord* row : contest.rows)
        if (const std::string label = device_label(row->key); std::ranges::find(labels, label) == labels.end())
            labels.push_back(label);
    return fmt::format("{}", fmt::join(labels, ", "));
}

/// The shares of the rays, in percent, by the first row with an answer.
std::array<PaperCell, 2> share_cells(const RivalContest& contest)
{
    for (const RowRecord* row : contest.rows)
        if (const Traced* result = traced(*row); result != nullptr && result->totals.rays > 0) {
            const RayShares shares = ray_shares(*result);
            const auto cell = [](const std::optional<double>& share) {
                return share ? exact_cell(100 * *share) : PaperCell();
            };
            return {cell(shares.enter), cell(shares.hit)};
        }
    return {};
}

PaperCell build_cell(const RowRecord* row)
{
    const auto cost = row == nullptr ? std::nullopt : setup_cost(*row);
    return cost ? exact_cell(cost->once_s()) : PaperCell();
}

/// When the walk's tets have paid: as billions of rays, and as seconds of tracing.
std::array<PaperCell, 2> paid_cells(const RowRecord* walk, const RowRecord* bvh)
{
    if (walk == nullptr || bvh == nullptr) return {};
    const auto paid = paid_build(*walk, compare_rates(*bvh, *walk));
    if (!paid) return {};
    if (paid->when == PaidBuild::When::later) return {exact_cell(1e-9 * paid->rays), exact_cell(paid->tracing_s)};
    const std::string when(name_of(paid->when));
    return {when, when};
}

/// How Embree runs on the CPU; empty without a row of it.
std::string embree_note(const std::vector<RivalContest>& contests)
{
    for (const RivalContest& contest : contests)
        for (const RowRecord* row : contest.rows)
            if (is_embree(row->key.kernel.layout) && !row->device.name.empty())
                return fmt::format("{}; it traces {} rays in lockstep on this processor.", row->device.driver,
                                   row->device.group_width);
    return {};
}

PaperTable scenes_table(const std::vector<RivalContest>& contests)
{
    PaperTable table{
        "rivals-scenes",
        "scenes on which tets win and lose",
        page,
        {{"scene", "scene"},
         {"rays", "rays"},
         {"device", "device"},
         {"enter", "enter the domain", "%", 0},
         {"hit", "hit", "%", 0},
         {"ratio", "fastest walk / fastest BVH"},
         {"packets_over_embree", "packets / Embree's best"},
         {"tet64_over_single", "tet64 / best BVH of one ray at a time"},
         {"walk", "fastest walk"},
         {"bvh", "fastest BVH"},
         {"tets_build_s", "tets built in", "s", 2},
         {"bvh_build_s", "BVH built in", "s", 2},
         {"paid_after", "tets paid off after", "G rays", 3},
         {"paid_after_s", "or", "s of tracing", 1}},
        {"A ratio is of rates: above 1 the walk through tets is faster. Its interval is over the samples of one "
         "run, or over the runs of --runs; runs differ by more than samples. Builds include packing; tets from the "
         "cache keep their original build time. 'Paid off' compares the fastest walk with the fastest BVH."}};
    if (const std::string note = embree_note(contests); !note.empty()) table.notes.push_back(note);
    for (const RivalContest& contest : contests) {
        const RowRecord *const walk = contest.fastest(Walk::any), *const bvh = contest.fastest(Rival::any);
        const auto paid = paid_cells(walk, bvh), shares = share_cells(contest);
        table.rows.push_back({contest.key.scene, std::string(name_of(contest.key.rays)), devices_text(contest),
                              shares[0], shares[1], ratio_cell(contest, Walk::any, Rival::any),
                              ratio_cell(contest, Walk::packets, Rival::embree),
                              ratio_cell(contest, Walk::tet64, Rival::single), label_cell(walk), label_cell(bvh),
                              build_cell(walk), build_cell(bvh), paid[0], paid[1]});
    }
    return table;
}

std::string status_text(const RowRecord& row)
{
    const auto figures = figures_of(row);
    std::string text(name_of(status_of(row)));
    if (figures && figures->noisy) text += ", noisy";
    const std::string reason = reason_of(row);
    return reason.empty() ? text : text + ": " + reason;
}

void add_row(PaperTable& table, const RivalContest& contest, const RowRecord& row, const RowRecord* bvh)
{
    const auto figures = figures_of(row);
    const auto number = [&](double value) { return figures ? exact_cell(value) : PaperCell(); };
    PaperCell over_bvh;
    if (figures && bvh != nullptr) over_bvh = Quantity{rate_ratio(row, *bvh), {}};
    table.rows.push_back({contest.key.scene, std::string(name_of(contest.key.rays)), title_of(row.key),
                          device_label(row.key), number(figures ? figures->mrays_per_s : 0),
                          number(figures ? 100 * figures->kernel_s.spread() : 0), over_bvh, status_text(row)});
}

PaperTable rows_table(const std::vector<RivalContest>& contests)
{
    PaperTable table{"rivals-rows",
                     "every row, and its rate over that of the fastest BVH of its device",
                     page,
                     {{"scene", "scene"},
                      {"rays", "rays"},
                      {"row", "row"},
                      {"device", "device"},
                      {"mrays_per_s", "Mrays/s"},
                      {"spread", "spread", "%", 1},
                      {"over_bvh", "x fastest BVH"},
                      {"status", "status"}},
                     {}};
    for (const RivalContest& contest : contests) {
        const RowRecord* const bvh = contest.fastest(Rival::any);
        for (const RowRecord* row : contest.rows)
            add_row(table, contest, *row, bvh);
    }
    return table;
}

} // namespace

PaperTable claims_table(const std::vector<RivalContest>& contests, const LeftOut& left_out,
                        const std::vector<RivalClaim>& claims)
{
    std::map<DeviceKind, std::vector<Claim>> by_place;
    PaperTable table{
        "rivals",
        "what this repository claims about tets and BVHs, measured again",
        page,
        {{"device", "claims about"}, {"holds", "hold"}, {"fails", "do not hold"}, {"untested", "not testable here"}},
        {}};
    for (Column& column : table.columns)
        column.decimals = 0;
    for (const RivalClaim& claim : claims) {
        table.claims.push_back(to_claim(judge(claim, contests, left_out)));
        by_place[claim.place].push_back(table.claims.back());
    }
    for (const auto& [place, list] : by_place)
        table.rows.push_back({std::string(place_title(place)), count_cell(list, ClaimVerdict::holds),
                              count_cell(list, ClaimVerdict::does_not_hold),
                              count_cell(list, ClaimVerdict::not_testable)});
    table.notes = old_runs(claims);
    return table;
}

std::vector<PaperTable> rival_tables(const std::vector<RowRecord>& rows, const std::vector<ContestScene>& scenes,
                                     const LeftOut& left_out)
{
    const auto contests = rival_contests(rows, scenes);
    return {claims_table(contests, left_out), scenes_table(contests), rows_table(contests)};
}

namespace {

const RivalScene* find_scene(const std::string& label)
{
    const auto found =
        std::ranges::find_if(rival_scenes(), [&](const RivalScene& scene) { return is_scene(label, scene.name); });
    return found == rival_scenes().end() ? nullptr : &*found;
}

bool has_rays(const RivalScene* scene, RayKind rays)
{
    if (scene != nullptr && scene->has_all_rays) return true;
    return rays == RayKind::primary || rays == RayKind::diffuse || rays == RayKind::random;
}

bool is_wanted(const RowKey& key, const Options& options)
{
    const RivalScene* const scene = find_scene(key.scene);
    if (!has_rays(scene, key.rays)) return false;
    const bool is_emulated = backend_named(key.backend).devices().at(key.device).kind == DeviceKind::emulated;
    if (is_emulated && (key.rays != RayKind::primary || (scene != nullptr && !scene->has_all_rays))) return false;
    const bool is_other_tree = is_embree(key.kernel.layout) && key.kernel.layout != Layout::embree;
    if (is_other_tree && options.layouts.empty())
        return key.rays == RayKind::primary && (scene == nullptr || scene->has_all_rays);
    if (key.kernel.method != Method::maria || !options.methods.empty()) return true;
    return !is_emulated && key.rays == RayKind::primary &&
           (key.kernel.layout == Layout::tet80 || !options.layouts.empty());
}

bool is_kept_backend(const Options& options, const Backend& backend)
{
    return options.backends.empty() || std::ranges::find(options.backends, backend.name()) != options.backends.end();
}

/// The same kernel in its form for AVX2; a row of another backend has none.
void add_native(std::vector<RowKey>& rows, RowKey key)
{
    if (!on_reference(key) || key.kernel.schedule != Schedule::tiles) return;
    key.kernel.schedule = Schedule::native;
    if (backend_named(key.backend).has_kernel(key.kernel)) rows.push_back(std::move(key));
}

} // namespace

Options rival_options(Options options, std::vector<std::string>& missing)
{
    if (!options.scenes.empty()) return options;
    for (const RivalScene& scene : rival_scenes()) {
        const std::string name(scene.name), reason = why_not_available(name);
        if (reason.empty())
            options.scenes.push_back(name);
        else
            missing.push_back(fmt::format("{} is left out: {}", name, reason));
    }
    return options;
}

namespace {

std::vector<RowKey> unfiltered_rival_rows(const Options& options)
{
    Options selecting = options;
    selecting.verb = Verb::bench; // whose defaults have packets
    selecting.rays = values_of<RayKind>();
    std::vector<RowKey> rows;
    for (const RowKey& key : unfiltered_rows(selecting, scene_labels(selecting)))
        if (is_wanted(key, options)) {
            rows.push_back(key);
            add_native(rows, key);
        }
    return rows;
}

} // namespace

std::vector<RowKey> rival_rows(const Options& options)
{
    const auto unfiltered = unfiltered_rival_rows(options);
    auto rows = filtered_rows(options, unfiltered);
    require_rows(options, rows, unfiltered);
    return rows;
}

LeftOut left_out(const Options& options, const std::vector<Backend*>& backends)
{
    const bool wants_exact = std::ranges::find(options.math, MathMode::exact) != options.math.end();
    LeftOut left_out;
    left_out.kernels = !options.methods.empty() || !options.layouts.empty() || !options.schedules.empty() ||
                       !options.orders.empty() || (!options.math.empty() && !wants_exact);
    std::vector<Device> gpus;
    std::vector<bool> is_kept;
    for (const Backend* backend : backends)
        for (std::size_t i = 0; i < backend->devices().size(); ++i) {
            const Device& device = backend->devices()[i];
            if (!device.usable || device.kind != DeviceKind::gpu) continue;
            gpus.push_back(device);
            is_kept.push_back(is_kept_backend(options, *backend) && wanted_device(options, *backend, i));
        }
    const auto hardware = physical_devices(gpus);
    for (std::size_t i = 0; i < gpus.size(); ++i)
        for (std::size_t j = 0; j < gpus.size(); ++j)
            if (hardware[i] == hardware[j] && is_kept[i] && !is_kept[j]) left_out.apis = true;
    if (options.filter.empty()) return left_out;
    const auto kept = rival_rows(options);
    for (RowKey& key : unfiltered_rival_rows(options))
        if (std::ranges::find(kept, key) == kept.end()) left_out.filtered.push_back(std::move(key));
    return left_out;
}

} // namespace tetrace
