#include "bench/reproduce/figure6.h"

#include "bench/figures.h"
#include "bench/reproduce/paper.h"
#include "bench/reproduce/speed.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

/// Calls visit(run, row index) for each row with a rate.
template <class Visit>
void for_rated(const SceneRuns& runs, const Visit& visit)
{
    for (const SceneRun* run : runs)
        for (std::size_t i = 0; i < run->rows.size(); ++i)
            if (!view_seconds(*run, i).empty()) visit(*run, i);
}

std::string source()
{
    return fmt::format("{}, Figure 6", paper::citation);
}

std::vector<PaperCell> cells_of(const SceneRun& run, std::size_t i)
{
    const RowRun& row = run.rows[i];
    const auto steps = view_steps(run, i), seconds = view_seconds(run, i);
    const auto [fewest, most] = std::minmax_element(steps.begin(), steps.end());
    const auto [shortest, longest] = std::minmax_element(seconds.begin(), seconds.end());
    const auto r = correlation(steps, seconds);
    const auto rays = static_cast<double>(run.scene->rays_per_view());
    const Line line = r ? fit_line(steps, seconds) : Line{};
    return {run.build.scene,
            std::string(name_of(row.key.kernel.method)),
            std::string(name_of(row.key.kernel.layout)),
            device_label(row.key),
            row.device.type,
            exact_cell(static_cast<double>(steps.size())),
            exact_cell(*fewest, paper::least_tets_a_ray),
            exact_cell(*most, paper::most_tets_a_ray),
            exact_cell(1e3 * *shortest),
            exact_cell(1e3 * *longest),
            exact_cell(figures_of(row)->msteps_per_s.value_or(0)),
            r ? PaperCell(Quantity{*r, {}}) : PaperCell(),
            r ? exact_cell(1e9 * line.slope / rays) : PaperCell(),
            r ? exact_cell(1e3 * line.intercept) : PaperCell()};
}

std::vector<Claim> claims_of(const RecordedRuns& runs)
{
    auto claims = speed_claims(runs);
    claims.insert(claims.begin(), {proportional_claim(runs, "cpu"), proportional_claim(runs, "gpu")});
    return claims;
}

} // namespace

PaperFigure figure6(const SceneRuns& runs)
{
    PaperFigure figure{"figure6",
                       "Time and tets traversed, a point a view",
                       source(),
                       {"tets traversed", "a ray"},
                       {"time of an image", "ms"},
                       {},
                       claims_of({runs.begin(), runs.end()}),
                       {},
                       {"Times are medians of a view's samples, device seconds of the kernel alone; a view's rows are "
                        "interleaved. Pictures: the views with the fewest and the most tets a ray, surface and steps.",
                        "Intervals of r are by Fisher's z, those of ratios of times by percentile bootstrap over the "
                        "views. Emulations of GPUs are in no claim."}};
    for_rated(runs, [&](const SceneRun& run, std::size_t i) {
        PaperFigure::Series series{series_name(run.rows[i]), {}};
        const auto steps = view_steps(run, i), seconds = view_seconds(run, i);
        for (std::size_t view = 0; view < steps.size(); ++view)
            series.points.emplace_back(steps[view], 1e3 * seconds[view]);
        figure.series.push_back(std::move(series));
    });
    for (const SceneRun* run : runs) {
        figure.pictures.insert(figure.pictures.end(), run->extreme_pictures.begin(), run->extreme_pictures.end());
        figure.notes.insert(figure.notes.end(), run->picture_problems.begin(), run->picture_problems.end());
    }
    return figure;
}

PaperTable figure6_table(const SceneRuns& runs)
{
    PaperTable table{"figure6",
                     "Time and tets traversed over the views",
                     source(),
                     {{"scene", "scene"},
                      {"method", "method"},
                      {"layout", "layout"},
                      {"device", "device"},
                      {"type", "type"},
                      {"views", "views", "", 0},
                      {"fewest_tets", "fewest tets", "a ray", 1},
                      {"most_tets", "most tets", "a ray", 1},
                      {"shortest_ms", "shortest", "ms"},
                      {"longest_ms", "longest", "ms"},
                      {"msteps_per_s", "Msteps/s", "", 1},
                      {"correlation", "r", "", 3},
                      {"slope_ns", "slope", "ns a tet and ray"},
                      {"intercept_ms", "intercept", "ms"}},
                     {},
                     {},
                     {fmt::format("The paper: {} to {} tets a ray over its 1,282 views, of cameras that it does not "
                                  "give, and {} to {} Msteps/s on its CPU. {}",
                                  paper::least_tets_a_ray, paper::most_tets_a_ray, paper::least_cpu_msteps,
                                  paper::most_cpu_msteps, paper::rest_is_there)}};
    for_rated(runs, [&](const SceneRun& run, std::size_t i) { table.rows.push_back(cells_of(run, i)); });
    for (const SceneRun* run : runs)
        for (std::size_t i = 0; i < run->rows.size(); ++i)
            if (const RowRun& row = run->rows[i]; view_seconds(*run, i).empty())
                table.notes.push_back(
                    fmt::format("{} has no rate: {}: {}.", series_name(row), name_of(status_of(row)), reason_of(row)));
    return table;
}

std::pair<std::size_t, std::size_t> extreme_views(const SceneRun& run, std::size_t row)
{
    const auto steps = view_steps(run, row);
    const auto [fewest, most] = std::minmax_element(steps.begin(), steps.end());
    return {static_cast<std::size_t>(fewest - steps.begin()), static_cast<std::size_t>(most - steps.begin())};
}

} // namespace tetrace
