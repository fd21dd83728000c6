#include "bench/reproduce/tables/ladder.h"

#include "bench/measuring/figures.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr const char* ladder_page = "docs/ladder.md";
constexpr double ns_per_s = 1e9;

/// The row's rays are random in all rows.
std::string ladder_title(RowKey key)
{
    key.rays = RayKind::primary;
    return kernel_title(key);
}

bool counts_nodes(const RowRecord& row)
{
    return row.key.kernel.structure == Structure::bvh;
}

/// Empty if the median, or the low end of its interval, is not positive: it is below the noise.
std::optional<Estimate> ns_of(std::vector<double> seconds, double steps)
{
    if (seconds.empty() || steps <= 0) return std::nullopt;
    for (double& value : seconds)
        value *= ns_per_s / steps;
    const Estimate ns = median_of_views(seconds);
    return std::min(ns.value, ns.low.value_or(ns.value)) > 0 ? std::optional(ns) : std::nullopt;
}

/// A row with its two costs, if it has them.
struct Rung {
    const RowRecord* row;
    double rays_steps; ///< steps per ray
    std::optional<Estimate> full_ns, alone_ns;
    std::size_t rounds; ///< of rays alone
};

std::vector<Rung> rungs_of(const std::vector<RowRecord>& rows, const std::vector<StepCosts>& costs)
{
    std::vector<Rung> rungs;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        Rung& rung = rungs.emplace_back(Rung{&rows[i], 0, {}, {}, costs[i].alone_s.size()});
        if (!figures_of(rows[i])) continue;
        rung.rays_steps = costs[i].steps / static_cast<double>(traced(rows[i])->totals.rays);
        rung.full_ns = ns_of(rows[i].samples_s, costs[i].steps);
        rung.alone_ns = ns_of(costs[i].alone_s, 1);
    }
    return rungs;
}

PaperCell estimate_cell(const std::optional<Estimate>& estimate)
{
    return estimate ? PaperCell(Quantity{*estimate, {}}) : PaperCell();
}

std::vector<PaperCell> cells_of_rung(const Rung& rung)
{
    const RowRecord& row = *rung.row;
    const bool has_both = rung.full_ns && rung.alone_ns;
    const std::string reason = reason_of(row), status(name_of(status_of(row)));
    return {row.key.scene,
            ladder_title(row.key),
            device_label(row.key),
            row.setup.bytes ? exact_cell(1e-6 * static_cast<double>(*row.setup.bytes)) : PaperCell(),
            std::string(counts_nodes(row) ? "node" : "tet"),
            rung.rays_steps > 0 ? exact_cell(rung.rays_steps) : PaperCell(),
            estimate_cell(rung.alone_ns),
            exact_cell(static_cast<double>(rung.rounds)),
            estimate_cell(rung.full_ns),
            has_both ? exact_cell(rung.alone_ns->value / rung.full_ns->value) : PaperCell(),
            reason.empty() ? status : status + ": " + reason};
}

std::vector<std::string> ladder_notes()
{
    return {"A step is a tet left, or a node of a BVH visited. Random rays from outside the domain. A ray alone: the "
            "slope of time over steps of launches of one ray each, right after all rays have been through the caches; "
            "on openmp a thread traces 32 such rays, one after the other. In the full device: the time of all rays "
            "over their steps, with how they enter and end. Alone over full: at least as many steps the device "
            "has in flight at a time. All hits are verified."};
}

void add_points(PaperFigure& figure, const std::vector<Rung>& rungs, const std::string& name,
                std::optional<Estimate> Rung::*ns, const std::string& title)
{
    PaperFigure::Series series{title + name, {}};
    for (const Rung& rung : rungs)
        if (rung.row->setup.bytes && rung.*ns && ladder_title(rung.row->key) == title)
            series.points.emplace_back(1e-6 * static_cast<double>(*rung.row->setup.bytes), (rung.*ns)->value);
    std::ranges::sort(series.points);
    if (!series.points.empty()) figure.series.push_back(std::move(series));
}

/// rungs: of one device, at least one.
PaperFigure figure_of(const std::vector<Rung>& rungs)
{
    const RowRecord& first = *rungs.front().row;
    const std::string label = device_label(first.key);
    PaperFigure figure{"ladder-" + label,
                       "what a step costs by size: " + label,
                       ladder_page,
                       {"bytes of the structure", "MB", true},
                       {"device time per step", "ns", true},
                       {"Device: " + first.device.name + "."}};
    std::vector<std::string> titles;
    for (const Rung& rung : rungs)
        if (const std::string title = ladder_title(rung.row->key); std::ranges::find(titles, title) == titles.end())
            titles.push_back(title);
    for (const std::string& title : titles) {
        add_points(figure, rungs, ", alone", &Rung::alone_ns, title);
        add_points(figure, rungs, ", full device", &Rung::full_ns, title);
    }
    if (first.device.cache_bytes > 0)
        figure.notes.push_back("Its largest cache has " + size_text(first.device.cache_bytes) + ".");
    return figure;
}

} // namespace

PaperTable ladder_table(const std::vector<RowRecord>& rows, const std::vector<StepCosts>& costs)
{
    PaperTable table{"ladder",
                     "what a step costs as the scene outgrows the caches",
                     ladder_page,
                     {{"scene", "scene"},
                      {"row", "row"},
                      {"device", "device"},
                      {"megabytes", "size", "MB", 1},
                      {"step", "step"},
                      {"steps_per_ray", "per ray", "", 1},
                      {"alone_ns", "a ray alone", "ns/step", 1},
                      {"rounds", "rounds", "", 0},
                      {"full_ns", "full device", "ns/step", 3},
                      {"in_flight", "alone / full", "", 1},
                      {"status", "status"}},
                     ladder_notes()};
    for (const Rung& rung : rungs_of(rows, costs))
        table.rows.push_back(cells_of_rung(rung));
    return table;
}

std::vector<PaperFigure> ladder_figures(const std::vector<RowRecord>& rows, const std::vector<StepCosts>& costs)
{
    std::vector<std::vector<Rung>> devices;
    for (const Rung& rung : rungs_of(rows, costs)) {
        if (!rung.full_ns && !rung.alone_ns) continue;
        const auto known = std::ranges::find_if(
            devices, [&](const std::vector<Rung>& rungs) { return same_place(rungs.front().row->key, rung.row->key); });
        (known == devices.end() ? devices.emplace_back() : *known).push_back(rung);
    }
    std::vector<PaperFigure> figures;
    for (const auto& rungs : devices)
        figures.push_back(figure_of(rungs));
    return figures;
}

} // namespace tetrace
