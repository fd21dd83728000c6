#include "bench/reproduce/tables/tables.h"

#include "bench/measuring/figures.h"
#include "bench/reproduce/paper.h"
#include "bench/reproduce/speed.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

/// Counts of one mesh vary by 0.2 % with the order of its triangles, and more between versions of TetGen.
constexpr double count_tolerance = 0.01;

double megabytes(SceneWork& scene, Layout layout)
{
    return 1e-6 * static_cast<double>(scene.packed(layout, TetOrder::hilbert).data.bytes());
}

std::vector<PaperCell> scene_cells(const SceneRun& run)
{
    SceneWork& scene = *run.scene;
    const Scene& loaded = scene.loaded().scene;
    const TetMeshCounts& counts = scene.counts();
    const auto paper = paper::counts_of(run.build.scene);
    const auto of_paper = [&](std::uint64_t paper::SceneCounts::*member) {
        return paper ? std::optional(static_cast<double>((*paper).*member)) : std::nullopt;
    };
    return {run.build.scene,
            run.build.build,
            fmt::format("{} {}x{}", name_of(loaded.domain.kind), loaded.domain.divisions, loaded.domain.divisions),
            loaded.build.switches.empty() ? PaperCell() : PaperCell("-" + loaded.build.switches),
            exact_cell(static_cast<double>(loaded.mesh.triangles.size()), of_paper(&paper::SceneCounts::triangles)),
            exact_cell(static_cast<double>(counts.tets), of_paper(&paper::SceneCounts::tets)),
            exact_cell(static_cast<double>(counts.occlusive_faces), of_paper(&paper::SceneCounts::occlusive_faces)),
            exact_cell(static_cast<double>(counts.free_faces)),
            exact_cell(megabytes(scene, Layout::tet80)),
            exact_cell(megabytes(scene, Layout::tet96)),
            exact_cell(loaded.build.build_s)};
}

/// Whether we get the paper's counts where its mesh is built in the nearest way.
Claim counts_claim(const SceneRun& run)
{
    const auto paper = paper::counts_of(run.build.scene);
    Claim claim{run.build.scene + "-has-the-papers-counts",
                fmt::format("{} has the paper's tets and occlusive faces", run.build.scene)};
    if (!paper || run.scene == nullptr) {
        claim.evidence = paper ? "The scene could not be loaded." : "The paper's counts are not known to this program.";
        return claim;
    }
    const auto triangles = run.scene->loaded().scene.mesh.triangles.size();
    const TetMeshCounts& counts = run.scene->counts();
    claim.evidence =
        fmt::format("{} tets and {} occlusive faces of {} triangles; the paper has {} and {} of {}.",
                    with_commas(counts.tets), with_commas(counts.occlusive_faces), with_commas(triangles),
                    with_commas(paper->tets), with_commas(paper->occlusive_faces), with_commas(paper->triangles));
    if (triangles != paper->triangles) {
        claim.evidence += " This is another mesh of the same thing.";
        return claim;
    }
    const auto is_equal = [](std::uint64_t ours, std::uint64_t papers) {
        return judge_equal(static_cast<double>(ours), static_cast<double>(papers), count_tolerance) ==
               ClaimVerdict::holds;
    };
    const bool equal = is_equal(counts.tets, paper->tets) && is_equal(counts.occlusive_faces, paper->occlusive_faces);
    claim.verdict = equal ? ClaimVerdict::holds : ClaimVerdict::does_not_hold;
    claim.evidence += fmt::format(" Within {:.0f} % is taken for equal.", 100 * count_tolerance);
    return claim;
}

std::string unknown_counts_note(const std::string& scene)
{
    const auto switches = paper::nearest_switches(scene);
    return fmt::format("{}, paper's build: the paper's counts are not known to this program; switches {}{}.", scene,
                       switches ? fmt::format("-{}", *switches) : "none",
                       switches == paper::nearest_switches("bunny") ? ", as for bunny" : "");
}

std::vector<PaperCell> rate_cells(const SceneRun& run, const RowRun& row)
{
    auto cells = label_cells({run.build.scene, run.build.build}, row);
    if (const auto figures = figures_of(row))
        for (const double number : {mean_steps(traced(row)->totals).all.value_or(0), figures->mrays_per_s,
                                    figures->msteps_per_s.value_or(0), 100 * figures->kernel_s.spread()})
            cells.push_back(exact_cell(number));
    else
        cells.resize(cells.size() + 4);
    cells.emplace_back(status_with_reason(row));
    return cells;
}

std::string source()
{
    return fmt::format("{}, Table 3", paper::citation);
}

} // namespace

PaperTable table3(const SceneRuns& runs)
{
    PaperTable table{"table3",
                     "Scenes and their tetrahedralizations",
                     source(),
                     {{"scene", "scene"},
                      {"build", "build"},
                      {"domain", "domain"},
                      {"switches", "switches"},
                      {"triangles", "triangles", "", 0},
                      {"tets", "tets", "", 0},
                      {"occlusive_faces", "occlusive faces", "", 0},
                      {"free_faces", "free faces", "", 0},
                      {"tet80_mb", "tet80", "MB", 1},
                      {"tet96_mb", "tet96", "MB", 1},
                      {"build_s", "built in", "s", 1}},
                     {"Build: paper's, of the paper's scenes alone, a domain of 3 radii that holds the cameras, uncut, "
                      "and the switches that come nearest to the paper's counts, where those are known; ours, as asked "
                      "for by --domain, --divisions and --switches. A "
                      "face counts once, the domain's boundary as neither.",
                      std::string(paper::rest_is_there)}};
    for (const SceneRun* run : runs) {
        if (run->scene != nullptr)
            table.rows.push_back(scene_cells(*run));
        else
            table.notes.push_back(fmt::format("{}, {} build, could not be had: {}", run->build.scene, run->build.build,
                                              run->rows.empty() ? "" : reason_of(run->rows.front())));
        if (run->build.build != papers_build) continue;
        table.claims.push_back(counts_claim(*run));
        if (!paper::counts_of(run->build.scene)) table.notes.push_back(unknown_counts_note(run->build.scene));
    }
    return table;
}

PaperTable table3_rates(const SceneRuns& runs)
{
    PaperTable table{"table3-rates",
                     "Rates on these tetrahedralizations",
                     source(),
                     {{"scene", "scene"},
                      {"build", "build"},
                      {"method", "method"},
                      {"layout", "layout"},
                      {"device", "device"},
                      {"type", "type"},
                      {"tets_a_ray", "tets", "a ray", 1},
                      {"mrays_per_s", "Mrays/s"},
                      {"msteps_per_s", "Msteps/s", "", 1},
                      {"spread_percent", "spread", "%", 1},
                      {"status", "status"}},
                     {fmt::format("A sample is all views traced once, device seconds of the kernel alone; rates are of "
                                  "the median sample, spread is its interquartile range over the median. The paper has "
                                  "{} to {} Msteps/s on its CPU. {}",
                                  paper::least_cpu_msteps, paper::most_cpu_msteps, paper::rest_is_there)}};
    table.claims = speed_claims({runs.begin(), runs.end()});
    for (const SceneRun* run : runs)
        for (const RowRun& row : run->rows)
            if (is_cdt(row)) table.rows.push_back(rate_cells(*run, row));
    return table;
}

} // namespace tetrace
