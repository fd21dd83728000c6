#include "bench/reproduce/tables/tables.h"

#include "bench/measuring/figures.h"
#include "bench/reproduce/paper.h"
#include "bench/reproduce/speed.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace tetrace {

namespace {

std::string capitalised(std::string sentence)
{
    if (!sentence.empty()) sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
    return sentence;
}

std::string milliseconds(double seconds)
{
    return fmt::format("{:.2g} ms", 1e3 * seconds);
}

double mebibytes(SceneWork& scene, Layout layout)
{
    return 0x1p-20 * static_cast<double>(scene.packed(layout, TetOrder::chains).data.bytes());
}

std::vector<PaperCell> scene_cells(const SceneRun& run)
{
    SceneWork& scene = *run.scene;
    const Scene& loaded = scene.loaded().scene;
    const TetMeshCounts& counts = scene.counts();
    const auto paper = paper::figures_of(run.build.scene);
    const auto count_cell = [&](std::uint64_t ours, std::uint64_t paper::SceneFigures::*member) {
        return quantity_beside({static_cast<double>(ours), {}, {}, true},
                               paper ? std::optional(static_cast<double>((*paper).*member)) : std::nullopt, run);
    };
    return {run.build.scene,
            run.build.build,
            std::string(name_of(loaded.build.optimised.tets)),
            fmt::format("{} {}x{}", name_of(loaded.domain.kind), loaded.domain.divisions, loaded.domain.divisions),
            loaded.build.switches.empty() ? PaperCell() : PaperCell("-" + loaded.build.switches),
            std::string(name_of(run.likeness.kind)),
            exact_cell(static_cast<double>(loaded.mesh.triangles.size())),
            count_cell(counts.tets, &paper::SceneFigures::tets),
            count_cell(counts.occlusive_faces, &paper::SceneFigures::occlusive_faces),
            count_cell(counts.free_faces, &paper::SceneFigures::free_faces),
            exact_cell(100.0 * static_cast<double>(counts.reached_tets) / static_cast<double>(counts.tets)),
            exact_cell(mebibytes(scene, Layout::tet80)),
            quantity_beside({mebibytes(scene, Layout::tet96), {}, {}, true},
                            paper ? std::optional(paper->memory_mib) : std::nullopt, run),
            loaded.build.build_s > 0 ? exact_cell(loaded.build.build_s) : PaperCell()};
}

/// Whether we get the paper's counts where its mesh is built in the nearest way.
Claim counts_claim(const SceneRun& run)
{
    Claim claim{run.build.scene + "-has-the-papers-counts",
                fmt::format("{} has the paper's tets, occlusive and free faces", run.build.scene)};
    if (run.scene == nullptr) {
        claim.evidence = "The scene could not be loaded.";
        return claim;
    }
    const auto triangles = run.scene->loaded().scene.mesh.triangles.size();
    const auto papers = paper::nearest_build(run.build.scene).value().triangles;
    claim.evidence = capitalised(run.likeness.reason);
    if (!is_within(static_cast<double>(triangles), static_cast<double>(papers), equal_counts_tolerance)) {
        if (run.likeness.kind != LikenessKind::other_mesh)
            claim.evidence += fmt::format(" This is another mesh of the same object, with {} triangles: the "
                                          "paper's counts are from {}.",
                                          with_commas(triangles), with_commas(papers));
        return claim;
    }
    claim.verdict =
        run.likeness.kind == LikenessKind::papers_counts ? ClaimVerdict::holds : ClaimVerdict::does_not_hold;
    return claim;
}

/// Why the scene's numbers are compared with the paper's, or are not.
std::string likeness_note(const SceneRun& run)
{
    return fmt::format("{}, {} build: {}", run.build.scene, run.build.build, run.likeness.reason);
}

std::string walk_note(const SceneRun& run, const StartWalk& walk)
{
    return fmt::format("{}, {} build: the cameras' start tets were found in {}, by {} walks of {:.1f} steps on "
                       "average from view to view and {} exact locations; locating all exactly takes {}, and finds "
                       "the same tets.",
                       run.build.scene, run.build.build, milliseconds(run.scene->locate_s()),
                       with_commas(walk.counts.walked),
                       static_cast<double>(walk.counts.steps) / std::max(walk.counts.walked, 1u), walk.counts.located,
                       milliseconds(walk.exact_s));
}

/// The rate of the paper's method on its device of the row's kind.
std::optional<double> papers_mrays(const SceneRun& run, const RowRecord& row)
{
    const auto figures = paper::figures_of(run.build.scene);
    const auto place = paper_place(row);
    if (!figures || !place || row.key.kernel.method != Method::maria) return std::nullopt;
    return figures->mrays(*place);
}

std::vector<PaperCell> rate_cells(const SceneRun& run, const RowRecord& row)
{
    auto cells = label_cells({run.build.scene, run.build.build}, row);
    if (const auto figures = figures_of(row)) {
        cells.push_back(exact_cell(mean_steps(traced(row)->totals).all.value_or(0)));
        cells.push_back(quantity_beside({figures->mrays_per_s, {}, {}, true}, papers_mrays(run, row), run));
        cells.push_back(exact_cell(figures->msteps_per_s.value_or(0)));
        cells.push_back(exact_cell(100 * figures->kernel_s.spread()));
    } else
        cells.resize(cells.size() + 4);
    cells.emplace_back(std::string(name_of(run.likeness.kind)));
    cells.emplace_back(status_with_reason(row));
    return cells;
}

std::string table3_source()
{
    return fmt::format("{}, Table 3", paper::citation);
}

} // namespace

PaperTable table3(const SceneRuns& runs)
{
    PaperTable table{
        "table3",
        "Scenes and their tetrahedralizations",
        table3_source(),
        {{"scene", "scene"},
         {"build", "build"},
         {"tets_kind", "kind"},
         {"domain", "domain"},
         {"switches", "switches"},
         {"likeness", "like the paper's"},
         {"triangles", "triangles", "", 0},
         {"tets", "tets", "", 0},
         {"occlusive_faces", "occlusive faces", "", 0},
         {"free_faces", "free faces", "", 0},
         {"reached_percent", "rays reach", "% of tets", 1},
         {"tet80_mib", "tet80", "MiB", 1},
         {"tet96_mib", "tet96", "MiB", 1},
         {"build_s", "built in", "s", 1}},
        {"Build: paper's, only for the paper's scenes, a domain of 3 radii that contains the cameras, with "
         "undivided sides, and the switches that give counts nearest to the paper's; ours, as set by --domain, "
         "--divisions and --switches; rays, the same with tets optimised so that rays cross few faces, no longer "
         "Delaunay. A face counts once; the domain's boundary counts as neither.",
         "Rays reach: tets connected to the domain's boundary by free faces. Rays from outside load no byte of the "
         "others, which are inside closed objects.",
         "The paper's memory, printed as MB, is 96 bytes per tet in MiB."}};
    for (const SceneRun* run : runs) {
        if (run->scene != nullptr)
            table.rows.push_back(scene_cells(*run));
        else
            table.notes.push_back(fmt::format("{}, {} build, failed: {}", run->build.scene, run->build.build,
                                              run->rows.empty() ? "" : reason_of(run->rows.front())));
        if (!run->likeness.reason.empty()) table.notes.push_back(likeness_note(*run));
        if (run->scene != nullptr)
            if (const std::string& why = run->scene->loaded().scene.build.optimised.reason; !why.empty())
                table.notes.push_back(fmt::format("{}, {} build: the tets are TetGen's, not optimised: {}",
                                                  run->build.scene, run->build.build, why));
        if (run->scene != nullptr && run->scene->start_walk())
            table.notes.push_back(walk_note(*run, *run->scene->start_walk()));
        if (run->build.build == papers_build) table.claims.push_back(counts_claim(*run));
    }
    return table;
}

PaperTable table3_rates(const SceneRuns& runs)
{
    PaperTable table{
        "table3-rates",
        "Rates on these tetrahedralizations",
        table3_source(),
        with_labels({{"tets_a_ray", "tets", "per ray", 1},
                     {"mrays_per_s", "Mrays/s"},
                     {"msteps_per_s", "Msteps/s", "", 1},
                     {"spread_percent", "spread", "%", 1},
                     {"likeness", "like the paper's"},
                     {"status", "status"}}),
        {fmt::format("A sample is all views traced once, each in its own launch, like the paper's frames, in device "
                     "seconds of the kernel only; rates are of the median sample, and spread is the interquartile "
                     "range over the median. The paper's rates are of its method on its CPU ({}) and its GPU ({}), "
                     "with cameras that it does not give; emulated GPUs are not compared with them.",
                     paper::cpu_name, paper::gpu_name),
         "like the paper's: whether mesh and tets are; there is no ratio if the mesh is another. Table 3 has the "
         "reasons."}};
    const SceneRuns judged = runs_of_cdt(runs);
    table.claims = speed_claims({judged.begin(), judged.end()});
    for (const paper::Place place : {paper::Place::cpu, paper::Place::gpu})
        table.claims.push_back(mean_rate_claim(runs, place));
    for (const SceneRun* run : runs)
        for (const RowRecord& row : run->rows)
            if (is_cdt(row)) table.rows.push_back(rate_cells(*run, row));
    return table;
}

} // namespace tetrace
