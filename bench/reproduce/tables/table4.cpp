#include "bench/reproduce/tables/tables.h"

#include "bench/reproduce/paper.h"
#include "bench/reproduce/speed.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace tetrace {

namespace {

using Count = std::function<std::uint64_t(const ImageRecord&)>;

/// The factor that scales counts to an image of the paper's size.
double scale_of(const SceneRun& run)
{
    return static_cast<double>(paper::image_pixels) / static_cast<double>(run.scene->rays_per_view());
}

/// Per image of the paper's size.
std::vector<double> counts_of(const SceneRun& run, std::size_t row, const Count& count)
{
    const double scale = scale_of(run);
    std::vector<double> counts;
    for (const ImageRecord& image : run.images[row])
        counts.push_back(scale * static_cast<double>(count(image)));
    return counts;
}

std::optional<double> share_of(const FlatWalks& walks)
{
    if (walks.rays == 0) return std::nullopt;
    return 100.0 * static_cast<double>(walks.through_flat) / static_cast<double>(walks.rays);
}

PaperCell share_cell(const std::vector<ImageRecord>& images, FlatWalks ImageRecord::*member)
{
    FlatWalks sum;
    for (const ImageRecord& image : images) {
        sum.rays += (image.*member).rays;
        sum.through_flat += (image.*member).through_flat;
    }
    const auto share = share_of(sum);
    return share ? exact_cell(*share) : PaperCell();
}

/// How the device's hits compare with openmp's: "bit for bit", "within 2 ulp", "12 rays differ".
std::string agreement(const RowRecord& row)
{
    const Traced& result = *traced(row);
    if (!result.compared) return on_reference(row.key) ? "reference" : "not compared";
    if (result.different > 0) return fmt::format("{} rays differ", with_commas(result.different));
    return result.inexact == 0 ? "bit for bit" : fmt::format("within {} ulp", result.max_ulps);
}

const std::vector<Column>& columns()
{
    static const std::vector<Column> list = {{"scene", "scene"},
                                             {"build", "build"},
                                             {"method", "method"},
                                             {"layout", "layout"},
                                             {"device", "device"},
                                             {"views", "views", "", 0},
                                             {"flawed", "wrong or lost", "rays per image", 4},
                                             {"wrong_face", "wrong face", "rays per image", 3},
                                             {"lost", "lost", "rays per image", 3},
                                             {"lost_at_cap", "in a cycle", "rays per image", 3},
                                             {"ties", "ties", "rays per image", 3},
                                             {"flawed_through_flat", "past flat tets", "% of these rays", 1},
                                             {"any_through_flat", "past flat tets", "% of all rays", 1},
                                             {"hits", "hits against openmp's"},
                                             {"likeness", "like the paper's"},
                                             {"status", "status"}};
    return list;
}

std::vector<PaperCell> table4_cells(const SceneRun& run, std::size_t i)
{
    const RowRecord& row = run.rows[i];
    const std::string status(name_of(status_of(row)));
    std::vector<PaperCell> cells = {run.build.scene, run.build.build, std::string(name_of(row.key.kernel.method)),
                                    std::string(name_of(row.key.kernel.layout)), device_label(row.key)};
    if (!is_whole(row)) {
        cells.resize(columns().size());
        cells.back() = fmt::format("{}: {}", status, reason_of(row));
        return cells;
    }
    const auto estimate = [&](const Count& count) { return mean_count(counts_of(run, i, count), run.sampling); };
    cells.push_back(exact_cell(static_cast<double>(run.images[i].size())));
    cells.push_back(
        quantity_beside(estimate(flawed_rays), paper::wrong_rays_of(run.build.scene, row.key.kernel.method), run));
    cells.push_back(Quantity{estimate([](const auto& image) { return image.verdict.verdicts.wrong; }), {}});
    cells.push_back(Quantity{estimate([](const auto& image) { return image.verdict.verdicts.lost; }), {}});
    cells.push_back(Quantity{estimate([](const auto& image) { return image.lost_at_cap; }), {}});
    cells.push_back(Quantity{estimate([](const auto& image) { return image.verdict.verdicts.ties; }), {}});
    cells.push_back(share_cell(run.images[i], &ImageRecord::flawed));
    cells.push_back(share_cell(run.images[i], &ImageRecord::any));
    cells.emplace_back(agreement(row));
    cells.emplace_back(std::string(name_of(run.likeness.kind)));
    cells.emplace_back(status);
    return cells;
}

/// The counts of a method over all its scenes, image by image.
struct MethodCounts {
    std::vector<double> counts;
    std::size_t views = 0;               ///< of the camera set, once for each scene
    Sampling sampling = Sampling::whole; ///< of the worst scene
    std::uint64_t rays = 0, flawed = 0;
    std::string scenes;

    [[nodiscard]] Estimate mean() const { return mean_count(counts, sampling); }
};

MethodCounts method_counts(const std::vector<MethodRow>& rows, Method method, std::size_t population)
{
    MethodCounts sum;
    for (const MethodRow& row : rows) {
        const RowRecord& run = row.run->rows[row.row];
        if (run.key.kernel.method != method) continue;
        const auto counts = counts_of(*row.run, row.row, flawed_rays);
        sum.counts.insert(sum.counts.end(), counts.begin(), counts.end());
        sum.views += population;
        sum.sampling = std::max(sum.sampling, row.run->sampling);
        sum.rays += traced(run)->verdicts.rays;
        sum.flawed += traced(run)->verdicts.wrong + traced(run)->verdicts.lost;
        append_item(sum.scenes, ", ", row.run->build.label);
    }
    return sum;
}

std::string counts_evidence(const MethodCounts& counts, const Estimate& mean)
{
    return fmt::format("{} of {} rays in {} of {} images of {}; an image of the paper's size: {}.",
                       with_commas(counts.flawed), with_commas(counts.rays), with_commas(counts.counts.size()),
                       with_commas(counts.views), counts.scenes, estimate_text(mean));
}

Claim count_claim(const std::vector<MethodRow>& rows, Method method, std::size_t population, bool some)
{
    const std::string name(name_of(method));
    Claim claim{fmt::format("{}-{}", name, some ? "has-wrong-results" : "has-no-wrong-result"),
                fmt::format("{} has {}", name, some ? "wrong results" : "no wrong result"),
                {},
                fmt::format("No row of {} was verified.", name)};
    const MethodCounts counts = method_counts(rows, method, population);
    if (counts.counts.empty()) return claim;
    const Estimate mean = counts.mean();
    claim.verdict = some ? judge_some(mean) : judge_none(mean);
    claim.evidence = counts_evidence(counts, mean);
    if (claim.verdict == ClaimVerdict::not_testable)
        claim.evidence += " None in a sample does not prove that there are none: only all rays of all views do.";
    return claim;
}

Claim min_claim(const std::vector<MethodRow>& rows, std::size_t population)
{
    Claim claim{"maria-has-the-fewest", "maria has fewer wrong results than each older method"};
    std::vector<Estimate> others;
    const auto mean_of = [&](Method method) -> std::optional<Estimate> {
        const MethodCounts counts = method_counts(rows, method, population);
        if (counts.counts.empty()) return std::nullopt;
        const Estimate mean = counts.mean();
        append_item(claim.evidence, "; ", fmt::format("{}: {}", name_of(method), estimate_text(mean)));
        return mean;
    };
    const auto maria = mean_of(Method::maria);
    for (const Method method : older_methods())
        if (const auto mean = mean_of(method)) others.push_back(*mean);
    if (maria) claim.verdict = judge_less(*maria, others);
    if (!claim.evidence.empty()) claim.evidence += " rays per image.";
    if (!maria) claim.evidence += " No row of maria was verified.";
    if (others.empty()) claim.evidence += " No row of an older method was verified.";
    return claim;
}

/// "ms06 comes next": fewer than each other older method.
Claim next_claim(const std::vector<MethodRow>& rows, std::size_t population)
{
    Claim claim{"ms06-comes-next", "ms06 has the fewest wrong results of the older methods"};
    std::optional<Estimate> next;
    std::vector<Estimate> others;
    for (const Method method : older_methods()) {
        const MethodCounts counts = method_counts(rows, method, population);
        if (counts.counts.empty()) continue;
        const Estimate mean = counts.mean();
        append_item(claim.evidence, "; ", fmt::format("{}: {}", name_of(method), estimate_text(mean)));
        if (method == Method::ms06)
            next = mean;
        else
            others.push_back(mean);
    }
    claim.evidence += claim.evidence.empty() ? "No row of an older method was verified." : " rays per image.";
    if (next) claim.verdict = judge_less(*next, others);
    return claim;
}

/// What the numbers of such a sample say about the whole set.
std::string sampling_note(Sampling sampling, std::size_t population)
{
    switch (sampling) {
    case Sampling::whole: return fmt::format("All rays of all {} views: the means are exact.", with_commas(population));
    case Sampling::even:
        return fmt::format("An interval is that of the mean over all rays of the camera set's {} views: percentile "
                           "bootstrap over the views traced, at least {}. If no such ray was seen there is no "
                           "interval: such rays are clustered, and a view left out may have some.",
                           with_commas(population), min_views);
    case Sampling::chosen:
        return fmt::format("The views traced are not spread evenly over the camera set's {}: they say nothing about "
                           "the others, so the means have no interval.",
                           with_commas(population));
    }
    return {};
}

std::vector<std::string> notes_of(const SceneRuns& runs, std::size_t population)
{
    std::vector<std::string> notes = {
        "Every ray is verified with exact arithmetic on the original triangles. Wrong face: not the triangle that "
        "the exact ray, or some curve within rounding error of it, meets first, or t, u and v that do not fit the "
        "point. Ties are hits of such a curve, and do not count as wrong. Lost: no exit face was found; in a cycle: "
        "the walk reached its cap of steps.",
        "The oracle verifies openmp's hits; each device's hits are compared with openmp's ray by ray, and images "
        "with equal hashes are verified once.",
        fmt::format("A tet is flat if its shortest altitude is below {} of its longest edge. Shares are of at most "
                    "{} rays per image, spread over it, and of the first {} steps of each, traced by openmp.",
                    flat_below, FlatTets::rays_looked_at, FlatTets::steps_looked_at),
        fmt::format("The paper's counts are of its GPU ({}), averaged over about 1,300 views whose cameras it does "
                    "not give. They are compared with every device, because exact mode gives all of them the same "
                    "hits; there is no ratio if the mesh is another.",
                    paper::gpu_name),
        "project is not one of the paper's methods: that it never has such a ray is this program's own claim, "
        "proved in docs/spec/project.md, P6."};
    for (std::string& note : likeness_notes(runs))
        notes.push_back(std::move(note));
    const auto loaded = std::ranges::find_if(runs, [](const auto* run) { return run->scene != nullptr; });
    if (loaded != runs.end())
        notes.push_back(sampling_note((*loaded)->sampling, population)); // all have the same views
    for (const SceneRun* run : runs) {
        if (run->scene == nullptr || run->flat == nullptr) continue;
        notes.push_back(fmt::format(
            "{}: {} of {} tets are flat; {} rays per image{}.", run->build.label, with_commas(run->flat->count()),
            with_commas(run->scene->counts().tets), with_commas(run->scene->rays_per_view()),
            run->scene->rays_per_view() == paper::image_pixels ? "" : ", counts scaled to 1024x1024"));
    }
    return notes;
}

} // namespace

std::uint64_t flawed_rays(const ImageRecord& image)
{
    return image.verdict.verdicts.wrong + image.verdict.verdicts.lost;
}

std::vector<MethodRow> method_rows(const SceneRuns& runs)
{
    std::vector<MethodRow> rows;
    for (const SceneRun* run : runs) {
        std::vector<Method> seen;
        for (const bool of_reference : {true, false})
            for (std::size_t i = 0; i < run->rows.size(); ++i) {
                const RowRecord& row = run->rows[i];
                const Method method = row.key.kernel.method;
                const bool usable = is_cdt(row) && is_whole(row) && traced(row)->different == 0 &&
                                    on_reference(row.key) == of_reference;
                if (!usable || std::ranges::find(seen, method) != seen.end()) continue;
                seen.push_back(method);
                rows.push_back({run, i});
            }
    }
    return rows;
}

PaperTable table4(const SceneRuns& runs, std::size_t population)
{
    PaperTable table{"table4", "Rays with a wrong result per image of 1024 x 1024",
                     fmt::format("{}, Table 4", paper::citation), columns(), notes_of(runs, population)};
    for (const SceneRun* run : runs)
        for (std::size_t i = 0; i < run->rows.size(); ++i)
            if (is_cdt(run->rows[i])) table.rows.push_back(table4_cells(*run, i));
    const auto rows = method_rows(runs_of_cdt(runs));
    table.claims.push_back(count_claim(rows, Method::maria, population, false));
    table.claims.push_back(count_claim(rows, Method::project, population, false)); // our method, which has a proof
    for (const Method method : older_methods())
        table.claims.push_back(count_claim(rows, method, population, true));
    table.claims.push_back(min_claim(rows, population));
    table.claims.push_back(next_claim(rows, population));
    return table;
}

PaperFigure table4_views(const SceneRuns& runs)
{
    PaperFigure figure{"table4-views",
                       "Wrong and lost rays, view by view",
                       fmt::format("to {}, Table 4", paper::citation),
                       {"view", "number in the camera set"},
                       {"wrong or lost", "rays per image"},
                       {"Pictures show the view with the most of them, the surface darkened, such rays marked."}};
    for (const MethodRow& row : method_rows(runs)) {
        const RowRecord& run = row.run->rows[row.row];
        PaperFigure::Series series{fmt::format("{} {}", row.run->build.label, name_of(run.key.kernel.method)), {}};
        const auto counts = counts_of(*row.run, row.row, flawed_rays);
        for (std::size_t view = 0; view < counts.size(); ++view)
            series.points.emplace_back(row.run->scene->view_numbers()[view], counts[view]);
        figure.series.push_back(std::move(series));
    }
    for (const SceneRun* run : runs) {
        figure.pictures.insert(figure.pictures.end(), run->flawed_pictures.begin(), run->flawed_pictures.end());
        figure.notes.insert(figure.notes.end(), run->picture_problems.begin(), run->picture_problems.end());
    }
    return figure;
}

} // namespace tetrace
