#include "bench/reproduce/tables/tables.h"

#include "bench/measuring/figures.h"
#include "bench/reproduce/speed.h"
#include "bench/rows/rows.h"
#include "bench/statistics/power_law.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace tetrace {

namespace {

/// A row's results at one size; empty where a value is unknown or does not apply.
struct Growing {
    double faces = 0;
    std::optional<double> ns_a_ray, steps, nodes, triangles, build_s, memory_mb;
};

/// A row through all sizes at which it ran.
struct GrowthLine {
    const SceneRun* run = nullptr; ///< the first of them
    const RowRun* row = nullptr;   ///< in that run
    std::vector<Growing> points;
    bool noisy = false; ///< at one of the sizes
};

/// The scene's name without its size.
std::string family_of(const SceneRun& run)
{
    return run.build.scene.substr(0, run.build.scene.find('@'));
}

std::string family_of(const GrowthLine& line)
{
    return family_of(*line.run);
}

bool is_for_rays(const GrowthLine& line)
{
    return is_for_rays(*line.run);
}

std::optional<double> a_ray(std::uint64_t count, std::uint64_t rays)
{
    if (count == 0 || rays == 0) return std::nullopt;
    return static_cast<double>(count) / static_cast<double>(rays);
}

Growing growing(const SceneRun& run, std::size_t i)
{
    const RowRun& row = run.rows[i];
    Growing point;
    point.faces = static_cast<double>(run.scene->counts().occlusive_faces);
    if (const auto figures = figures_of(row)) point.ns_a_ray = 1e3 / figures->mrays_per_s;
    if (const Traced* result = traced(row)) {
        if (is_cdt(row)) point.steps = a_ray(result->totals.steps(), result->totals.rays);
        point.nodes = a_ray(result->visits.nodes, result->visits.rays);
        point.triangles = a_ray(result->visits.triangles, result->visits.rays);
    }
    if (i < run.costs.size() && run.costs[i]) {
        point.build_s = run.costs[i]->once_s();
        point.memory_mb = 1e-6 * static_cast<double>(run.costs[i]->bytes);
    }
    return point;
}

bool is_one_kernel(const RowRun& a, const RowRun& b)
{
    RowKey key = a.key;
    key.scene = b.key.scene;
    return key == b.key;
}

/// Lines in the order of rows; points in that of runs.
std::vector<GrowthLine> lines_of(const SceneRuns& runs)
{
    std::vector<GrowthLine> lines;
    for (const SceneRun* run : runs) {
        if (run->scene == nullptr) continue;
        for (std::size_t i = 0; i < run->rows.size(); ++i) {
            const auto same = [&](const GrowthLine& line) {
                return line.run->build.build == run->build.build && family_of(line) == family_of(*run) &&
                       is_one_kernel(*line.row, run->rows[i]);
            };
            auto line = std::ranges::find_if(lines, same);
            if (line == lines.end()) line = lines.insert(line, {run, &run->rows[i], {}, false});
            line->points.push_back(growing(*run, i));
            line->noisy = line->noisy || is_noisy(run->rows[i]);
        }
    }
    return lines;
}

std::vector<PaperCell> size_cells(const SceneRun& run, std::size_t i)
{
    const RowRun& row = run.rows[i];
    auto cells = label_cells({run.build.scene, run.build.build}, row);
    if (run.scene != nullptr) {
        const Growing point = growing(run, i);
        const auto figures = figures_of(row);
        cells.push_back(exact_cell(point.faces));
        cells.push_back(exact_cell(static_cast<double>(run.scene->counts().tets)));
        for (const auto& value : {point.steps, point.nodes, point.triangles})
            cells.push_back(known_number(value));
        cells.push_back(figures ? exact_cell(figures->mrays_per_s) : PaperCell());
        for (const auto& value : {point.ns_a_ray, point.build_s, point.memory_mb})
            cells.push_back(known_number(value));
        cells.push_back(figures ? exact_cell(100 * figures->kernel_s.spread()) : PaperCell());
    } else
        cells.resize(cells.size() + 10);
    cells.emplace_back(status_with_reason(row));
    return cells;
}

/// The exponent of a line's values, over the sizes at which it has them.
std::optional<PowerLaw> law_of(const GrowthLine& line, std::optional<double> Growing::*member)
{
    std::vector<double> faces, values;
    for (const Growing& point : line.points)
        if (const auto& value = point.*member) {
            faces.push_back(point.faces);
            values.push_back(*value);
        }
    return fit_power_law(faces, values);
}

PaperCell exponent_cell(const GrowthLine& line, std::optional<double> Growing::*member)
{
    const auto law = law_of(line, member);
    return law ? PaperCell(Quantity{law->exponent, {}}) : PaperCell();
}

std::vector<PaperCell> exponent_cells(const GrowthLine& line)
{
    const KernelId& kernel = line.row->key.kernel;
    std::vector<PaperCell> cells = {family_of(line),
                                    line.run->build.build,
                                    std::string(name_of(kernel.method)),
                                    std::string(name_of(kernel.layout)),
                                    device_label(line.row->key),
                                    exact_cell(static_cast<double>(line.points.size()))};
    for (const auto member : {&Growing::ns_a_ray, &Growing::steps, &Growing::nodes, &Growing::triangles,
                              &Growing::build_s, &Growing::memory_mb})
        cells.push_back(exponent_cell(line, member));
    return cells;
}

/// "CDT tet80 openmp", "bvh2 openmp"; Embree's rows omit the device.
std::string line_name(const GrowthLine& line)
{
    const KernelId& kernel = line.row->key.kernel;
    if (is_embree(kernel.layout)) return "Embree " + embree_title(name_of(kernel.method), name_of(kernel.layout));
    const std::string name = kernel.structure == Structure::cdt
                                 ? fmt::format("{} {}", tets_name(*line.run), name_of(kernel.layout))
                                 : std::string(name_of(kernel.layout));
    return name + ' ' + device_label(line.row->key);
}

/// The series of a line's values; without points where it has none.
PaperFigure::Series series_of(const GrowthLine& line, const std::string& name, std::optional<double> Growing::*member)
{
    PaperFigure::Series series{name, {}};
    for (const Growing& point : line.points)
        if (const auto& value = point.*member) series.points.emplace_back(point.faces, *value);
    return series;
}

PaperFigure empty_figure(const std::string& id, const std::string& title, const std::string& y, const std::string& unit)
{
    PaperFigure figure{id,
                       title,
                       "not in the paper",
                       {"occlusive faces", "", true},
                       {y, unit, true},
                       {"Both axes are logarithmic: a power law is a straight line, its exponent the slope."}};
    return figure;
}

void add_series(PaperFigure& figure, PaperFigure::Series series)
{
    if (!series.points.empty()) figure.series.push_back(std::move(series));
}

PaperFigure time_figure(const std::vector<GrowthLine>& lines, const std::string& family, DeviceKind kind)
{
    PaperFigure figure =
        empty_figure(fmt::format("growth-{}-time-{}", family, name_of(kind)),
                     fmt::format("Time of a ray as {} is refined, {}", family, name_of(kind)), "time", "ns a ray");
    for (const GrowthLine& line : lines)
        if (family_of(line) == family && line.row->device.kind == kind)
            add_series(figure, series_of(line, line_name(line), &Growing::ns_a_ray));
    return figure;
}

/// What rays visit is the same on every device, so openmp's rows are enough.
PaperFigure visits_figure(const std::vector<GrowthLine>& lines, const std::string& family)
{
    PaperFigure figure = empty_figure(fmt::format("growth-{}-visits", family),
                                      fmt::format("What a ray visits as {} is refined", family), "visits", "a ray");
    std::set<bool> drawn; // whether tets for rays: all layouts have the same
    for (const GrowthLine& line : lines) {
        if (family_of(line) != family || !on_reference(line.row->key)) continue;
        const std::string layout(name_of(line.row->key.kernel.layout));
        if (is_cdt(*line.row) && drawn.insert(is_for_rays(line)).second)
            add_series(figure, series_of(line, is_for_rays(line) ? "tets for rays" : "CDT, tets", &Growing::steps));
        add_series(figure, series_of(line, layout + ", nodes", &Growing::nodes));
        add_series(figure, series_of(line, layout + ", triangles", &Growing::triangles));
    }
    return figure;
}

/// "The BVH's cost depends less on the size of the input" (the paper, Table 6): the exponent of bvh2's time is below
/// that of each layout of maria, on each device of the kind.
Claim size_claim(const std::vector<GrowthLine>& lines, DeviceKind kind)
{
    const char* const device = kind == DeviceKind::gpu ? "GPU" : "CPU";
    Claim claim{fmt::format("growth-bvh-depends-less-on-size-{}", name_of(kind)),
                fmt::format("on a {}, the BVH's time depends less than the CDT's on the size of the input", device)};
    std::vector<ClaimVerdict> verdicts;
    bool noisy = false;
    for (const GrowthLine& bvh : lines) {
        if (bvh.row->key.kernel.layout != Layout::bvh2 || bvh.row->device.kind != kind) continue;
        const auto least = law_of(bvh, &Growing::ns_a_ray);
        std::vector<Estimate> others;
        for (const GrowthLine& cdt : lines)
            if (!is_for_rays(cdt) && family_of(cdt) == family_of(bvh) && is_cdt(*cdt.row) &&
                same_place(cdt.row->key, bvh.row->key))
                if (const auto law = law_of(cdt, &Growing::ns_a_ray)) {
                    others.push_back(law->exponent);
                    noisy = noisy || cdt.noisy;
                    claim.evidence += fmt::format("{}{}: faces^{}", claim.evidence.empty() ? "" : "; ", line_name(cdt),
                                                  estimate_text(law->exponent));
                }
        if (!least || others.empty()) continue;
        noisy = noisy || bvh.noisy;
        claim.evidence += fmt::format("; {}: faces^{}", line_name(bvh), estimate_text(least->exponent));
        verdicts.push_back(judge_less(least->exponent, others));
    }
    if (verdicts.empty()) {
        claim.evidence = fmt::format("No {} has rates of the CDT and of bvh2 in three sizes.", device);
        return claim;
    }
    claim.verdict = verdicts.front();
    for (const ClaimVerdict verdict : verdicts)
        claim.verdict = judge_both(claim.verdict, verdict);
    claim.evidence += ".";
    withdraw_if_noisy(claim, noisy);
    return claim;
}

/// The line of a family whose number is known on the reference; null where there is none.
template <class IsMeant>
const GrowthLine* find_line(const std::vector<GrowthLine>& lines, const std::string& family, const IsMeant& is_meant)
{
    for (const GrowthLine& line : lines)
        if (family_of(line) == family && on_reference(line.row->key) && is_meant(line)) return &line;
    return nullptr;
}

/// Ours, not the paper's: tets a ray in tets for rays grow by a smaller power than nodes a ray in bvh2.
Claim visits_claim(const std::vector<GrowthLine>& lines, const std::string& family)
{
    Claim claim{fmt::format("growth-tets-for-rays-grow-less-than-nodes-{}", family),
                fmt::format("not the paper's: as {} is refined, rays visit tets for rays by a smaller power of its "
                            "faces than nodes of bvh2",
                            family)};
    const auto exponent_of = [&](const GrowthLine* line, std::optional<double> Growing::*member) {
        const auto law = line != nullptr ? law_of(*line, member) : std::nullopt;
        return law ? std::optional(law->exponent) : std::nullopt;
    };
    const auto tets =
        exponent_of(find_line(lines, family, [](const auto& line) { return is_for_rays(line) && is_cdt(*line.row); }),
                    &Growing::steps);
    const auto nodes = exponent_of(
        find_line(lines, family, [](const auto& line) { return line.row->key.kernel.layout == Layout::bvh2; }),
        &Growing::nodes);
    if (!tets || !nodes) {
        claim.evidence = "They were not both traced in three sizes.";
        return claim;
    }
    claim.verdict = judge_less(*tets, {*nodes});
    claim.evidence = fmt::format("Tets: faces^{}; nodes: faces^{}.", estimate_text(*tets), estimate_text(*nodes));
    return claim;
}

std::vector<std::string> families_of(const std::vector<GrowthLine>& lines)
{
    std::vector<std::string> families;
    for (const GrowthLine& line : lines)
        if (std::ranges::find(families, family_of(line)) == families.end()) families.push_back(family_of(line));
    return families;
}

constexpr const char* growth_source = "not in the paper";

} // namespace

const std::vector<std::uint32_t>& growth_sizes()
{
    static const std::vector<std::uint32_t> sizes = {1'500, 6'000, 25'000, 100'000, 400'000};
    return sizes;
}

std::vector<SceneBuild> growth_builds(const SceneRequest& request, std::vector<std::uint32_t> sizes,
                                      const std::string& build)
{
    std::ranges::sort(sizes);
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    std::vector<SceneBuild> builds;
    for (const std::uint32_t size : sizes) {
        SceneRequest sized = request;
        const std::string scene = fmt::format("{}@{}", request.name, size);
        if (request.name == "cubes")
            sized.build.resolution = size;
        else
            sized.name = scene;
        const std::string label = build == rays_build ? scene + "-rays" : scene;
        builds.push_back({sized, scene, build, label, false, true, false, true, true});
    }
    return builds;
}

PaperTable growth_table(const SceneRuns& runs)
{
    PaperTable table{"growth",
                     "One scene in several sizes: what a ray visits, and what tracing takes",
                     growth_source,
                     with_labels({{"occlusive_faces", "occlusive faces", "", 0},
                                  {"tets", "tets", "", 0},
                                  {"steps", "tets", "a ray", 1},
                                  {"nodes", "nodes", "a ray", 1},
                                  {"triangles", "triangles", "a ray", 1},
                                  {"mrays_per_s", "Mrays/s"},
                                  {"ns_a_ray", "time", "ns a ray", 1},
                                  {"build_s", "built and packed in", "s"},
                                  {"memory_mb", "memory", "MB", 1},
                                  {"spread_percent", "spread", "%", 1},
                                  {"status", "status"}}),
                     {"A size is the number of triangles of banana@N, of cubes@N the cubes along an axis. Times are of "
                      "the median sample of all views, device seconds of the kernel alone. Nodes and triangles are "
                      "counted by openmp's counting build, outside the timing."}};
    for (const SceneRun* run : runs)
        for (std::size_t i = 0; i < run->rows.size(); ++i)
            table.rows.push_back(size_cells(*run, i));
    return table;
}

PaperTable growth_exponents(const SceneRuns& runs)
{
    PaperTable table{
        "growth-exponents",
        "How cost grows with the number of occlusive faces: the exponents of power laws",
        growth_source,
        {{"scene", "scene"},
         {"build", "build"},
         {"method", "method"},
         {"layout", "layout"},
         {"device", "device"},
         {"sizes", "sizes", "", 0},
         {"time", "time of a ray"},
         {"steps", "tets a ray"},
         {"nodes", "nodes a ray"},
         {"triangles", "triangles a ray"},
         {"setup", "build and packing"},
         {"memory", "memory"}},
        {"cost ~ faces^x, x by least squares on logarithms, from 3 sizes on, with Student's 95 % interval: "
         "it tells how well a power fits these sizes, whose deviations it takes as independent. A cost "
         "that grows as a logarithm has a small x, which falls with the sizes."}};
    const auto lines = lines_of(runs);
    for (const GrowthLine& line : lines) {
        table.rows.push_back(exponent_cells(line));
        if (line.noisy)
            table.notes.push_back(fmt::format("{} is noisy: its time decides nothing.", series_name(*line.row)));
    }
    for (const DeviceKind kind : {DeviceKind::gpu, DeviceKind::cpu})
        table.claims.push_back(size_claim(lines, kind));
    for (const std::string& family : families_of(lines))
        if (std::ranges::any_of(lines, [](const GrowthLine& line) { return is_for_rays(line); }))
            table.claims.push_back(visits_claim(lines, family));
    return table;
}

std::vector<PaperFigure> growth_figures(const SceneRuns& runs)
{
    const auto lines = lines_of(runs);
    std::vector<PaperFigure> figures;
    for (const std::string& family : families_of(lines)) {
        for (const DeviceKind kind : {DeviceKind::gpu, DeviceKind::cpu, DeviceKind::emulated})
            figures.push_back(time_figure(lines, family, kind));
        figures.push_back(visits_figure(lines, family));
    }
    std::erase_if(figures, [](const PaperFigure& figure) { return figure.series.empty(); });
    return figures;
}

} // namespace tetrace
