#include "bench/reproduce/tables/tables.h"

#include "bench/measuring/figures.h"
#include "bench/reproduce/paper.h"
#include "bench/reproduce/speed.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace tetrace {

namespace {

/// Calls visit(row index) for each of the cdt's rows with a rate.
template <class Visit>
void for_rated(const SceneRun& run, const Visit& visit)
{
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        if (is_cdt(run.rows[i]) && !view_seconds(run, i).empty()) visit(i);
}

std::string figure6_source()
{
    return fmt::format("{}, Figure 6", paper::citation);
}

/// Millions of tets that the rays of an image of the paper's size traverse.
double mtets_an_image(double tets_a_ray)
{
    return 1e-6 * tets_a_ray * paper::image_pixels;
}

/// The time of as many rays as an image of the paper's size has.
double image_ms(const SceneRun& run, double view_s)
{
    return 1e3 * view_s * paper::image_pixels / static_cast<double>(run.scene->rays_per_view());
}

bool has_papers_times(const RowRecord& row)
{
    return row.key.kernel.method == Method::maria && paper_place(row) == paper::Place::cpu;
}

std::vector<PaperCell> figure6_cells(const SceneRun& run, std::size_t i)
{
    const RowRecord& row = run.rows[i];
    const auto steps = view_steps(run, i), seconds = view_seconds(run, i);
    const auto [fewest, most] = std::ranges::minmax_element(steps);
    const auto [shortest, longest] = std::ranges::minmax_element(seconds);
    const auto r = correlation(steps, seconds, run.sampling);
    const auto rays = static_cast<double>(run.scene->rays_per_view());
    const Line line = r ? fit_line(steps, seconds) : Line{};
    const auto beside = [&](double ours, double papers, bool is_papers) {
        return quantity_beside({ours, {}, {}, true}, is_papers ? std::optional(papers) : std::nullopt, run);
    };
    // The paper's image, and times of its method on its CPU.
    const bool has_tets = run.build.scene == paper::figure6_scene, has_times = has_tets && has_papers_times(row);
    auto cells = label_cells({run.build.scene, run.build.build}, row);
    cells.insert(cells.end(),
                 {exact_cell(static_cast<double>(steps.size())), exact_cell(*fewest), exact_cell(*most),
                  beside(mtets_an_image(*fewest), paper::view_a.mtets, has_tets),
                  beside(mtets_an_image(*most), paper::view_b.mtets, has_tets),
                  beside(image_ms(run, *shortest), paper::view_a.ms, has_times),
                  beside(image_ms(run, *longest), paper::view_b.ms, has_times),
                  exact_cell(figures_of(row)->msteps_per_s.value_or(0)), r ? PaperCell(Quantity{*r, {}}) : PaperCell(),
                  r ? exact_cell(1e9 * line.slope / rays) : PaperCell(),
                  r ? exact_cell(image_ms(run, line.intercept)) : PaperCell(),
                  std::string(name_of(run.likeness.kind))});
    return cells;
}

/// The runs that decide the claims: those of the CDT; if a scene has the paper's build, only that one.
RecordedRuns judged_runs(const SceneRuns& runs)
{
    const SceneRuns candidates = runs_of_cdt(runs);
    RecordedRuns judged;
    for (const SceneRun* run : candidates)
        if (run->build.build == papers_build || std::ranges::none_of(candidates, [&](const SceneRun* other) {
                return other->build.scene == run->build.scene && other->build.build == papers_build;
            }))
            judged.push_back(run);
    return judged;
}

std::vector<Claim> claims_of(const RecordedRuns& runs)
{
    std::vector<Claim> claims;
    for (const DeviceKind kind : {DeviceKind::cpu, DeviceKind::gpu})
        for (auto* const claim_of : {proportional_claim, linear_claim, slower_tets_claim})
            claims.push_back(claim_of(runs, kind));
    for (Claim& claim : speed_claims(runs))
        claims.push_back(std::move(claim));
    return claims;
}

/// The kinds of devices that rated rows ran on, in the rows' order.
std::vector<DeviceKind> rated_kinds(const SceneRun& run)
{
    std::vector<DeviceKind> kinds;
    for_rated(run, [&](std::size_t i) {
        const DeviceKind kind = run.rows[i].device.kind;
        if (std::ranges::find(kinds, kind) == kinds.end()) kinds.push_back(kind);
    });
    return kinds;
}

std::vector<std::size_t> rated_rows(const SceneRun& run, DeviceKind kind)
{
    std::vector<std::size_t> rows;
    for_rated(run, [&](std::size_t i) {
        if (run.rows[i].device.kind == kind) rows.push_back(i);
    });
    return rows;
}

/// "maria tet96 opencl"; without the layout where all rows have the same one, and likewise without the device.
std::vector<std::string> distinct_names(const SceneRun& run, const std::vector<std::size_t>& rows)
{
    std::set<std::string_view> layouts;
    std::set<std::string> devices;
    for (const std::size_t i : rows) {
        layouts.insert(name_of(run.rows[i].key.kernel.layout));
        devices.insert(device_label(run.rows[i].key));
    }
    std::vector<std::string> names;
    for (const std::size_t i : rows) {
        const RowKey& key = run.rows[i].key;
        std::string name(name_of(key.kernel.method));
        if (layouts.size() > 1) name.append(" ").append(name_of(key.kernel.layout));
        if (devices.size() > 1) name.append(" ").append(device_label(key));
        names.push_back(std::move(name));
    }
    return names;
}

PaperFigure::Series series_of(const SceneRun& run, std::size_t i, const std::string& name)
{
    PaperFigure::Series series{name, {}};
    const auto steps = view_steps(run, i), seconds = view_seconds(run, i);
    for (std::size_t view = 0; view < steps.size(); ++view)
        series.points.emplace_back(steps[view], image_ms(run, seconds[view]));
    return series;
}

/// The scene's rows on the devices of one kind; none without a kind. Emulated GPUs share no figure with GPUs, and
/// neither shares one with a CPU.
PaperFigure figure_of(const SceneRun& run, std::optional<DeviceKind> kind)
{
    const std::string kind_text(kind ? name_of(*kind) : "");
    PaperFigure figure{
        fmt::format("figure6-{}{}{}", run.build.label, kind ? "-" : "", kind_text),
        fmt::format("Time over tets traversed, one point per view: {}, {} build{}{}", run.build.scene, run.build.build,
                    kind ? ", " : "", kind_text),
        figure6_source(),
        {"tets traversed", "per ray"},
        {"time of an image of 1024 x 1024", "ms"},
        {"Times are medians of a view's samples, in device seconds of the kernel only, scaled to the paper's number "
         "of rays per image; a view's rows are interleaved."}};
    const auto rows = kind ? rated_rows(run, *kind) : std::vector<std::size_t>();
    const auto names = distinct_names(run, rows);
    for (std::size_t i = 0; i < rows.size(); ++i)
        figure.series.push_back(series_of(run, rows[i], names[i]));
    if (kind == DeviceKind::cpu && run.build.scene == paper::figure6_scene && run.likeness.is_compared())
        figure.series.push_back(
            {fmt::format("the paper's views A and B, on its {}", paper::cpu_name),
             {{paper::view_a.tets_a_ray(), paper::view_a.ms}, {paper::view_b.tets_a_ray(), paper::view_b.ms}}});
    return figure;
}

void add_pictures(PaperFigure& figure, const SceneRun& run)
{
    figure.pictures = run.extreme_pictures;
    if (!figure.pictures.empty())
        figure.notes.emplace_back("Pictures: the views with the fewest and the most tets per ray, surface and steps.");
    figure.notes.insert(figure.notes.end(), run.picture_problems.begin(), run.picture_problems.end());
}

} // namespace

std::vector<PaperFigure> figure6(const SceneRuns& runs)
{
    std::vector<PaperFigure> figures;
    for (const SceneRun* run : runs) {
        const std::size_t first = figures.size();
        for (const DeviceKind kind : rated_kinds(*run))
            figures.push_back(figure_of(*run, kind));
        if (figures.size() == first) figures.push_back(figure_of(*run, {}));
        add_pictures(figures[first], *run);
    }
    return figures;
}

PaperTable figure6_table(const SceneRuns& runs)
{
    PaperTable table{
        "figure6",
        "Time and tets traversed, over the views",
        figure6_source(),
        with_labels({{"views", "views", "", 0},
                     {"fewest_tets", "min tets", "per ray", 1},
                     {"most_tets", "max tets", "per ray", 1},
                     {"fewest_mtets", "min", "Mtets per image"},
                     {"most_mtets", "max", "Mtets per image"},
                     {"shortest_ms", "shortest", "ms per image"},
                     {"longest_ms", "longest", "ms per image"},
                     {"msteps_per_s", "Msteps/s", "", 1},
                     {"correlation", "r", "", 3},
                     {"slope_ns", "slope", "ns per tet and ray"},
                     {"intercept_ms", "intercept", "ms per image"},
                     {"likeness", "like the paper's"}}),
        {"Intervals of r are by Fisher's z, those of ratios of times by percentile bootstrap over the views. Claims "
         "are decided by maria, the paper's method, in the paper's builds if these were traced; emulated GPUs and "
         "tets for rays decide none.",
         fmt::format("An image has 1024 x 1024 rays; counts and times of smaller ones are scaled to that. The paper "
                     "has one scene, {}, in 1,282 views whose cameras it does not give, on its {}: {} ms and {} "
                     "million tets in its view A, {} ms and {} million in B, {:.0f} and {:.0f} Msteps/s.",
                     paper::figure6_scene, paper::cpu_name, paper::view_a.ms, paper::view_a.mtets, paper::view_b.ms,
                     paper::view_b.mtets, paper::view_a.msteps_per_s(), paper::view_b.msteps_per_s())}};
    table.claims = claims_of(judged_runs(runs));
    for (std::string& note : likeness_notes(runs))
        table.notes.push_back(std::move(note));
    for (const SceneRun* run : runs) {
        for_rated(*run, [&](std::size_t i) { table.rows.push_back(figure6_cells(*run, i)); });
        for (const RowRecord& row : run->rows)
            if (is_cdt(row) && is_noisy(row))
                table.notes.push_back(fmt::format("{} is noisy: its times decide nothing.", series_name(row)));
        for (std::size_t i = 0; i < run->rows.size(); ++i)
            if (const RowRecord& row = run->rows[i]; is_cdt(row) && view_seconds(*run, i).empty())
                table.notes.push_back(
                    fmt::format("{} has no rate: {}: {}.", series_name(row), name_of(status_of(row)), reason_of(row)));
    }
    return table;
}

std::pair<std::size_t, std::size_t> extreme_views(const SceneRun& run, std::size_t row)
{
    const auto steps = view_steps(run, row);
    const auto [fewest, most] = std::ranges::minmax_element(steps);
    return {static_cast<std::size_t>(fewest - steps.begin()), static_cast<std::size_t>(most - steps.begin())};
}

} // namespace tetrace
