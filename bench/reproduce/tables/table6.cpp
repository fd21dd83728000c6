#include "bench/reproduce/tables/tables.h"

#include "bench/measuring/comparison.h"
#include "bench/measuring/figures.h"
#include "bench/reproduce/paper.h"
#include "bench/reproduce/speed.h"
#include "bench/rows/rows.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace tetrace {

namespace {

std::string table6_source()
{
    return fmt::format("{}, Table 6", paper::citation);
}

/// The paper's method; through tets for rays, for which the paper has no numbers, also the suite's own.
bool is_compared(const SceneRun& run, const RowRecord& row)
{
    const KernelId& kernel = row.key.kernel;
    if (!is_cdt(row) || kernel.method == Method::maria) return true;
    return is_for_rays(run) && kernel.method == Method::project && kernel.schedule != Schedule::packets;
}

/// On one device in one math mode; a driver's own BVH has only one.
bool run_alike(const RowRecord& a, const RowRecord& b)
{
    const bool has_mode = is_portable(a.key.kernel) && is_portable(b.key.kernel);
    return same_place(a.key, b.key) && (!has_mode || a.key.kernel.math == b.key.kernel.math);
}

bool run_beside(const RowRecord& cdt, const RowRecord& bvh)
{
    return is_embree(bvh.key.kernel.layout) ? on_reference(cdt.key) : run_alike(cdt, bvh);
}

double total_s(const SceneRun& run, std::size_t row)
{
    const auto seconds = view_seconds(run, row);
    return std::accumulate(seconds.begin(), seconds.end(), 0.0);
}

double rays_of(const SceneRun& run, std::size_t row)
{
    return static_cast<double>(run.images[row].size()) * static_cast<double>(run.scene->rays_per_view());
}

std::optional<SetupCost> cost_of(const SceneRun& run, std::size_t row)
{
    return setup_cost(run.rows[row]);
}

/// Whether the row is rated, and no other of the tets is faster on its device.
bool is_fastest_of_tets(const SceneRun& run, std::size_t cdt)
{
    const auto takes_part = [&](std::size_t i) {
        return is_cdt(run.rows[i]) && is_compared(run, run.rows[i]) && !view_seconds(run, i).empty();
    };
    if (!takes_part(cdt)) return false;
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
        if (i == cdt || !takes_part(i) || !run_alike(run.rows[i], run.rows[cdt])) continue;
        const double theirs = total_s(run, i), ours = total_s(run, cdt);
        if (theirs < ours || (theirs == ours && i < cdt)) return false;
    }
    return true;
}

/// "single bvh2": a BVH's row without its device.
std::string rival_name(const RowRecord& row)
{
    return fmt::format("{} {}", name_of(row.key.kernel.method), name_of(row.key.kernel.layout));
}

/// The paper's range for the row's structure, on the paper's GPU; its BVH corresponds to bvh2.
std::optional<std::pair<double, double>> papers_frames(const SceneRun& run, const RowRecord& row)
{
    const auto frames = paper::frames_of(run.build.scene);
    if (!frames || (!is_cdt(row) && row.key.kernel.layout != Layout::bvh2)) return std::nullopt;
    return is_cdt(row) ? std::pair(frames->min_cdt, frames->max_cdt) : std::pair(frames->min_bvh, frames->max_bvh);
}

std::string papers_frames_text(const SceneRun& run, const RowRecord& row)
{
    if (!paper::has_scene(run.build.scene)) return "not its scene";
    if (is_for_rays(run)) return "not its tets";
    if (!is_cdt(row) && row.key.kernel.layout != Layout::bvh2) return "not its BVH";
    const auto frames = papers_frames(run, row);
    return frames ? fmt::format("{} to {}, a GPU", frames->first, frames->second) : "";
}

const std::vector<Column>& frame_columns()
{
    static const std::vector<Column> list = with_labels({{"views", "views", "", 0},
                                                         {"frames_per_s", "median", "frames/s"},
                                                         {"least_frames_per_s", "min", "frames/s"},
                                                         {"most_frames_per_s", "max", "frames/s"},
                                                         {"papers_frames_per_s", "the paper's", "frames/s"},
                                                         {"mrays_per_s", "Mrays/s"},
                                                         {"build_s", "built in", "s"},
                                                         {"pack_s", "packed in", "s", 3},
                                                         {"memory_mb", "memory", "MB", 1},
                                                         {"spread_percent", "spread", "%", 1},
                                                         {"likeness", "like the paper's"},
                                                         {"status", "status"}});
    return list;
}

std::vector<PaperCell> frame_cells(const SceneRun& run, std::size_t i)
{
    const RowRecord& row = run.rows[i];
    const auto figures = figures_of(row);
    const auto cost = cost_of(run, i);
    auto cells = label_cells({run.build.scene, run.build.build}, row);
    if (figures) {
        const auto frames = view_frames(run, i);
        const auto [least, most] = std::ranges::minmax_element(frames);
        const auto papers = row.device.kind == DeviceKind::gpu ? papers_frames(run, row) : std::nullopt;
        cells.push_back(exact_cell(static_cast<double>(frames.size())));
        cells.push_back(Quantity{median_of_views(frames, run.sampling), {}});
        const auto beside = [&](double ours, double std::pair<double, double>::*member) {
            return quantity_beside({ours, {}, {}, true}, papers ? std::optional((*papers).*member) : std::nullopt, run);
        };
        cells.push_back(beside(*least, &std::pair<double, double>::first));
        cells.push_back(beside(*most, &std::pair<double, double>::second));
    } else
        cells.resize(cells.size() + 4);
    cells.emplace_back(papers_frames_text(run, row));
    cells.push_back(figures ? exact_cell(figures->mrays_per_s) : PaperCell());
    cells.push_back(cost ? exact_cell(cost->build_s) : PaperCell());
    cells.push_back(cost ? exact_cell(cost->pack_s) : PaperCell());
    cells.push_back(cost ? exact_cell(1e-6 * static_cast<double>(cost->bytes)) : PaperCell());
    cells.push_back(figures ? exact_cell(100 * figures->kernel_s.spread()) : PaperCell());
    cells.emplace_back(std::string(name_of(run.likeness.kind)));
    cells.emplace_back(status_with_reason(row));
    return cells;
}

const std::vector<Column>& pair_columns()
{
    static const std::vector<Column> list = {{"scene", "scene"},
                                             {"build", "build"},
                                             {"method", "method"},
                                             {"layout", "tets"},
                                             {"rival", "BVH"},
                                             {"fastest", "fastest BVH"},
                                             {"device", "device"},
                                             {"type", "type"},
                                             {"ratio", "time BVH / tets"},
                                             {"least_ratio", "min"},
                                             {"most_ratio", "max"},
                                             {"won_percent", "tets faster in", "% of views", 1},
                                             {"break_even_mrays", "builds paid after", "Mrays", 1},
                                             {"ahead", "ahead"}};
    return list;
}

/// Which structure takes less time, and from how many rays on.
std::string ahead_text(const RowPair& pair)
{
    const auto even = break_even(pair);
    if (!even) return "undecided";
    const bool noisy = is_noisy(pair.run->rows[pair.cdt]) || is_noisy(pair.run->rows[pair.bvh]);
    const std::string who = even->ahead == BreakEven::Ahead::first    ? "the " + tets_name(*pair.run)
                            : even->ahead == BreakEven::Ahead::second ? "the BVH"
                                                                      : "neither";
    return fmt::format("{}, {}{}", who, even->rays ? "from there on" : "always", noisy ? " (noisy)" : "");
}

PaperCell break_even_cell(const RowPair& pair)
{
    const auto even = break_even(pair);
    if (!even) return {};
    return even->rays ? exact_cell(1e-6 * *even->rays) : PaperCell("never");
}

bool is_with_best_bvh(const RowPair& pair)
{
    const auto best = best_bvh_pair(*pair.run, pair.cdt);
    return best && best->bvh == pair.bvh;
}

std::vector<PaperCell> pair_cells(const RowPair& pair)
{
    const RowRecord &cdt = pair.run->rows[pair.cdt], &bvh = pair.run->rows[pair.bvh];
    return {pair.run->build.scene,
            pair.run->build.build,
            std::string(name_of(cdt.key.kernel.method)),
            std::string(name_of(cdt.key.kernel.layout)),
            rival_name(bvh),
            is_with_best_bvh(pair) ? "yes" : "no",
            device_label(cdt.key),
            device_kind_text(cdt),
            Quantity{pair.ratio.median, {}},
            exact_cell(pair.ratio.lowest),
            exact_cell(pair.ratio.highest),
            exact_cell(100 * pair.ratio.won),
            break_even_cell(pair),
            ahead_text(pair)};
}

/// "cwbvh opencl:1", or "Embree packet16"; without the device where all have the same one.
std::string curve_name(const RowPair& pair, bool with_device)
{
    const RowRecord& bvh = pair.run->rows[pair.bvh];
    const std::string_view layout = name_of(bvh.key.kernel.layout);
    std::string name = is_embree(bvh.key.kernel.layout)
                           ? "Embree " + embree_title(name_of(bvh.key.kernel.method), layout)
                           : std::string(layout);
    if (with_device) name += ' ' + device_label(pair.run->rows[pair.cdt].key);
    return name;
}

/// Ascending ratios, each over the share of the views with at most that ratio.
PaperFigure::Series curve_of(const RowPair& pair, bool with_device)
{
    PaperFigure::Series series{curve_name(pair, with_device), {}};
    auto ratios = pair.ratio.views;
    std::ranges::sort(ratios);
    for (std::size_t i = 0; i < ratios.size(); ++i)
        series.points.emplace_back(100 * static_cast<double>(i + 1) / static_cast<double>(ratios.size()), ratios[i]);
    return series;
}

PaperFigure ratio_figure(const SceneRun& run, DeviceKind kind, const std::vector<RowPair>& pairs)
{
    PaperFigure figure{
        fmt::format("table6-{}-{}", run.build.label, name_of(kind)),
        fmt::format("Time of a BVH over that of the {}, by view: {}, {} build, {}", tets_name(run), run.build.scene,
                    run.build.build, name_of(kind)),
        table6_source(),
        {"views with at most this ratio", "%"},
        {"time of the BVH over that of the tets", "", true},
        {"Above 1 the tets are faster. A curve has all views of a pair, ascending: it crosses 1 at the share of the "
         "views in which the BVH is faster. The tets are the fastest row of their device."}};
    const RowKey& first = run.rows[pairs.front().cdt].key;
    const bool one_device =
        std::ranges::all_of(pairs, [&](const RowPair& pair) { return same_place(run.rows[pair.cdt].key, first); });
    for (const RowPair& pair : pairs)
        figure.series.push_back(curve_of(pair, !one_device));
    figure.series.push_back({"equal", {{0, 1}, {100, 1}}});
    return figure;
}

} // namespace

std::vector<double> view_frames(const SceneRun& run, std::size_t row)
{
    const double share = static_cast<double>(run.scene->rays_per_view()) / double{paper::image_pixels};
    std::vector<double> frames;
    for (const double seconds : view_seconds(run, row))
        frames.push_back(share / seconds);
    return frames;
}

std::vector<RowPair> row_pairs(const SceneRun& run)
{
    std::vector<RowPair> pairs;
    for (std::size_t cdt = 0; cdt < run.rows.size(); ++cdt) {
        const auto cdt_s = view_seconds(run, cdt);
        if (!is_cdt(run.rows[cdt]) || !is_compared(run, run.rows[cdt]) || cdt_s.empty()) continue;
        for (std::size_t bvh = 0; bvh < run.rows.size(); ++bvh)
            if (!is_cdt(run.rows[bvh]) && run_beside(run.rows[cdt], run.rows[bvh]))
                if (const auto bvh_s = view_seconds(run, bvh); !bvh_s.empty())
                    pairs.push_back({&run, cdt, bvh, paired_ratio(cdt_s, bvh_s, run.sampling)});
    }
    return pairs;
}

std::vector<RowPair> fastest_pairs(const SceneRun& run)
{
    auto pairs = row_pairs(run);
    std::erase_if(pairs, [&](const RowPair& pair) { return !is_fastest_of_tets(run, pair.cdt); });
    return pairs;
}

namespace {

/// The contest of a row; empty if its device is not known.
std::optional<Contest<RowRecord>> contest_of(const SceneRun& run, std::size_t row)
{
    std::vector<const RowRecord*> rows(run.rows.size());
    std::ranges::transform(run.rows, rows.begin(), [](const RowRun& one) { return &one; });
    for (auto& contest : contests_of(rows))
        if (std::ranges::find(contest.rows, rows[row]) != contest.rows.end()) return std::move(contest);
    return std::nullopt;
}

} // namespace

std::optional<RowPair> best_bvh_pair(const SceneRun& run, std::size_t cdt)
{
    if (!figures_of(run.rows[cdt])) return std::nullopt;
    const auto contest = contest_of(run, cdt);
    const RowRecord* const best = contest ? contest->fastest(Rival::any) : nullptr;
    if (best == nullptr) return std::nullopt;
    const auto bvh = static_cast<std::size_t>(static_cast<const RowRun*>(best) - run.rows.data());
    return RowPair{&run, cdt, bvh, paired_ratio(view_seconds(run, cdt), view_seconds(run, bvh), run.sampling)};
}

std::vector<RowPair> best_bvh_pairs(const SceneRun& run)
{
    std::vector<RowPair> pairs;
    for (std::size_t cdt = 0; cdt < run.rows.size(); ++cdt)
        if (is_fastest_of_tets(run, cdt))
            if (auto pair = best_bvh_pair(run, cdt)) pairs.push_back(std::move(*pair));
    return pairs;
}

std::string bvh_text(const RowPair& pair)
{
    const RowRecord& bvh = pair.run->rows[pair.bvh];
    return contest_of(*pair.run, pair.bvh)->bvh_text(bvh, row_label(bvh.key));
}

std::optional<BreakEven> break_even(const RowPair& pair)
{
    const SceneRun& run = *pair.run;
    const auto cdt = cost_of(run, pair.cdt), bvh = cost_of(run, pair.bvh);
    if (!cdt || !bvh) return std::nullopt;
    const auto ratio = ratio_of_sums(view_seconds(run, pair.bvh), view_seconds(run, pair.cdt), run.sampling);
    if (ratio.low && *ratio.low <= 1 && *ratio.high >= 1) return std::nullopt;
    return break_even(TotalCost{cdt->once_s(), total_s(run, pair.cdt) / rays_of(run, pair.cdt)},
                      TotalCost{bvh->once_s(), total_s(run, pair.bvh) / rays_of(run, pair.bvh)});
}

PaperTable table6(const SceneRuns& runs)
{
    PaperTable table{
        "table6",
        "Tets and BVHs: frames per second, build time and memory",
        table6_source(),
        frame_columns(),
        {"Frames of 1024x1024 per second, each in its own launch, from the median of a view's samples, in device "
         "seconds of the kernel only: the median over the views with its interval (order statistics), the minimum "
         "and the maximum.",
         "Built in: the time of TetGen for the CDT, plus our optimiser for rays; of the BVH builder, which is "
         "Embree's, for bvh2, bvh4 and cwbvh; of Embree itself for its own rows. TetGen uses one thread, the others "
         "all. Memory: everything that a session holds of the scene.",
         fmt::format("The paper's frames are of its GPU ({}) and its own cameras; there is a ratio only for GPUs, "
                     "and none if the mesh is another.",
                     paper::gpu_name)}};
    for (std::string& note : likeness_notes(runs))
        table.notes.push_back(std::move(note));
    for (const SceneRun* run : runs)
        for (std::size_t i = 0; i < run->rows.size(); ++i)
            if (is_compared(*run, run->rows[i])) table.rows.push_back(frame_cells(*run, i));
    return table;
}

PaperTable table6_pairs(const SceneRuns& runs)
{
    PaperTable table{
        "table6-pairs",
        "Tets against BVHs, paired by view",
        table6_source(),
        pair_columns(),
        {"A ratio is of the same view on the same device; above 1 the tets are faster. The interval is that of the "
         "median over the views (order statistics). Embree's rows are paired with openmp's.",
         "Ahead: which one needs less time, build and rays together. Builds paid after: the number of rays, of "
         "these views, after which the one with the faster rays has made up for a slower build (built and packed as "
         "in table6); never: there is nothing to make up for. Undecided: the interval of the ratio of all views' "
         "times contains 1.",
         "The paper's claims are of bvh2, its kind of BVH, and of the fastest layout of the CDT on each device. "
         "Tets for rays have separate claims, of maria or project, whichever is faster on the device, against the "
         "fastest BVH there: of ours and Embree's on a CPU, of all APIs' on a GPU. Emulated GPUs decide no claim."}};
    table.claims = pair_claims(runs);
    for (const SceneRun* run : runs)
        for (const RowPair& pair : row_pairs(*run))
            table.rows.push_back(pair_cells(pair));
    return table;
}

std::vector<PaperFigure> table6_figures(const SceneRuns& runs)
{
    std::vector<PaperFigure> figures;
    for (const SceneRun* run : runs)
        for (const DeviceKind kind : {DeviceKind::gpu, DeviceKind::cpu, DeviceKind::emulated}) {
            auto pairs = fastest_pairs(*run);
            std::erase_if(pairs, [&](const RowPair& pair) { return run->rows[pair.cdt].device.kind != kind; });
            if (!pairs.empty()) figures.push_back(ratio_figure(*run, kind, pairs));
        }
    return figures;
}

} // namespace tetrace
