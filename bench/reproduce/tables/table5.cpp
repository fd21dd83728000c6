#include "bench/reproduce/tables/tables.h"

#include "bench/measuring/figures.h"
#include "bench/reproduce/paper.h"
#include "bench/reproduce/speed.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>
#include <tuple>

namespace tetrace {

namespace {

const std::vector<Column>& search_columns()
{
    static const std::vector<Column> list = {{"method", "method"},
                                             {"layout", "layout"},
                                             {"device", "device"},
                                             {"type", "type"},
                                             {"threads", "host threads", "", 0},
                                             {"searches", "searches", "", 0},
                                             {"msearches_per_s", "Msearches/s", "", 1},
                                             {"ns_a_search", "time", "ns per search"},
                                             {"all_ms", "all of the paper's", "ms", 0},
                                             {"spread_percent", "spread", "%", 1},
                                             {"copy_percent", "of copy", "%", 1},
                                             {"wrong", "wrong", "per million", 3},
                                             {"lost", "lost", "per million", 3},
                                             {"ties", "ties", "per million", 3},
                                             {"faces", "faces against openmp's"},
                                             {"status", "status"}};
    return list;
}

std::string face_agreement(const RowRecord& row)
{
    const Traced& result = *traced(row);
    if (is_reference(row.key)) return "reference";
    return result.different == 0 ? "the same" : fmt::format("{} differ", with_commas(result.different));
}

PaperCell threads_cell(const SearchRun& run, const RowKey& key)
{
    if (!on_reference(key)) return {};
    return exact_cell(key.threads == 0 ? run.threads : key.threads);
}

/// Share of the device's copy bandwidth, which is measured with all of its threads.
PaperCell copy_cell(const SearchRun& run, const RowRecord& row, double searches_per_s,
                    const std::vector<RowDevice>& devices)
{
    const auto place = device_of(row, devices);
    const bool on_all_threads = row.key.threads == 0 || row.key.threads == run.threads;
    if (!on_all_threads || !place || !devices[*place].yardstick) return {};
    return exact_cell(100 * bytes_per_search * searches_per_s / devices[*place].yardstick->copy_bytes_per_s);
}

/// The paper's time of one thread of its CPU, or of its GPU.
std::optional<double> papers_ms(const RowRecord& row)
{
    const auto place = paper_place(row);
    if (!place || (*place == paper::Place::cpu && row.key.threads != 1)) return std::nullopt;
    return paper::search_ms(row.key.kernel.method, *place);
}

std::vector<PaperCell> rate_cells(const SearchRun& run, const RowRecord& row, const std::vector<RowDevice>& devices)
{
    const auto figures = figures_of(row);
    if (!figures) return std::vector<PaperCell>(5);
    return {exact_cell(figures->mrays_per_s), exact_cell(1e3 / figures->mrays_per_s),
            exact_cell(1e-3 * paper::searches / figures->mrays_per_s, papers_ms(row)),
            exact_cell(100 * figures->kernel_s.spread()), copy_cell(run, row, 1e6 * figures->mrays_per_s, devices)};
}

std::vector<PaperCell> count_cells(const RowRecord& row)
{
    if (!is_whole(row)) return std::vector<PaperCell>(4);
    const Verdicts& verdicts = traced(row)->verdicts;
    const auto a_million = [&](std::uint64_t count) {
        return exact_cell(1e6 * static_cast<double>(count) / static_cast<double>(verdicts.rays));
    };
    return {a_million(verdicts.wrong), a_million(verdicts.lost), a_million(verdicts.ties), face_agreement(row)};
}

std::vector<PaperCell> cells_of(const SearchRun& run, const RowRecord& row, const std::vector<RowDevice>& devices)
{
    auto cells = label_cells({}, row);
    cells.push_back(threads_cell(run, row.key));
    cells.push_back(is_whole(row) ? exact_cell(static_cast<double>(traced(row)->totals.rays)) : PaperCell());
    for (const auto& part : {rate_cells(run, row, devices), count_cells(row)})
        cells.insert(cells.end(), part.begin(), part.end());
    cells.emplace_back(status_with_reason(row));
    return cells;
}

Claim exact_claim(const SearchRun& run)
{
    Claim claim{
        "table5-maria-exact", "maria has no wrong results except ties", {}, "No row of maria completed all searches."};
    std::uint64_t rows = 0, searches = 0, wrong = 0, lost = 0, ties = 0;
    for (const RowRecord& row : run.rows) {
        if (row.key.kernel.method != Method::maria || !is_whole(row) || traced(row)->different > 0) continue;
        const Verdicts& verdicts = traced(row)->verdicts;
        rows += 1, searches += verdicts.rays, wrong += verdicts.wrong, lost += verdicts.lost, ties += verdicts.ties;
    }
    if (rows == 0) return claim;
    const bool is_whole_set = run.size.count() >= SearchSize{}.count();
    claim.verdict = judge_none({static_cast<double>(wrong + lost), {}, {}, is_whole_set});
    claim.evidence =
        fmt::format("{} searches by {}: {} wrong, {} lost, {} ties.", with_commas(searches),
                    counted(rows, "row", "rows"), with_commas(wrong), with_commas(lost), with_commas(ties));
    if (claim.verdict == ClaimVerdict::not_testable)
        claim.evidence += fmt::format(" Fewer searches per row than the paper's {} decide nothing.",
                                      with_commas(SearchSize{}.count()));
    return claim;
}

bool on_one_thread(const RowRecord& row)
{
    return row.key.threads == 1;
}

bool on_gpu(const RowRecord& row)
{
    return paper_place(row) == paper::Place::gpu;
}

std::vector<Claim> claims_of(const SearchRun& run)
{
    const RecordedRuns runs = {&run};
    std::vector<Claim> claims = {
        fastest_claim({"table5-maria-fastest-cpu",
                       "maria is the fastest of the five methods on a CPU, one thread, exit search only"},
                      runs, on_one_thread),
        fastest_claim(
            {"table5-maria-fastest-gpu", "maria is the fastest of the five methods on a GPU, exit search only"}, runs,
            on_gpu),
        overtaking_claim({"table5-plucker-overtakes-stp-gpu", "on a GPU plucker is faster than stp, exit search only"},
                         runs)};
    for (const auto& [place, is_meant, where, id] :
         {std::tuple{paper::Place::cpu, IsMeant(on_one_thread), "a CPU, one thread", "cpu"},
          std::tuple{paper::Place::gpu, IsMeant(on_gpu), "a GPU", "gpu"}}) {
        const auto [method, slower] = paper::fastest_older(place);
        claims.push_back(fastest_older_claim(
            {fmt::format("table5-{}-is-the-fastest-older-{}", name_of(method), id),
             fmt::format("on {}, {} is the fastest of the older methods, exit search only", where, name_of(method))},
            runs, method, is_meant));
        claims.push_back(
            slower_claim({fmt::format("table5-{}-is-{:.0f}-percent-slower-{}", name_of(method), 100 * slower, id),
                          fmt::format("on {}, {} is {:.0f} % slower than maria, exit search only", where,
                                      name_of(method), 100 * slower)},
                         runs, method, slower, is_meant));
    }
    claims.push_back(exact_claim(run));
    return claims;
}

std::string face_text(std::uint32_t face)
{
    return face == NO_EXIT ? "no face" : fmt::format("face {}", face);
}

/// Which search to look at if a row's faces are not the exact ones, or not openmp's; empty if all are.
std::string first_flaw(const RowRecord& row)
{
    const Traced* result = traced(row);
    if (result == nullptr) return {};
    const std::string name = row_name(row.key);
    if (const auto& ray = result->first_different)
        return fmt::format("{} first differs on ray {} of tet {}: {}, but openmp finds {}.", name, ray->x, ray->view,
                           face_text(ray->ours.face_id), face_text(ray->openmp.face_id));
    if (const auto& ray = result->verdicts.first_wrong; ray && is_reference(row.key))
        return fmt::format("{} is first wrong on ray {} of tet {}: {}, but the exact face is {}.", name, ray->x,
                           ray->view, face_text(ray->ours.face_id), face_text(ray->reference_face));
    return {};
}

std::vector<std::string> notes_of(const SearchRun& run)
{
    std::vector<std::string> notes = {
        fmt::format("{} random tets, {} random rays through each, entering by a known face: the same on every "
                    "device, from a counter-based generator, on a grid of 2^-16, so that integers decide the exit "
                    "face exactly. Every face found is compared with the exact one and with openmp's, outside the "
                    "timing. Tie: another face, and the ray passes all edges that exclude it within the rounding "
                    "bound; wrong: another face; lost: none.",
                    with_commas(run.size.tets), with_commas(run.size.rays)),
        fmt::format("A sample is all searches once, {} tets per launch, in device seconds of the kernel only; rates "
                    "are of the median sample, and spread is the interquartile range over the median. Intervals of "
                    "ratios are by percentile bootstrap over these batches.",
                    with_commas(run.batch_tets)),
        fmt::format("A search moves {} bytes, its ray and its face (its tet stays in the caches). 'of copy' is this "
                    "traffic as a share of the device's copy bandwidth. On fast devices the table measures memory.",
                    bytes_per_search),
        fmt::format(
            "All of the paper's: the time of its {} searches, scaled from those done. The paper has them on one "
            "thread of its CPU ({}) and on its GPU ({}); its tets and rays are random too, from distributions that "
            "it does not give.",
            with_commas(static_cast<std::uint64_t>(paper::searches)), paper::cpu_name, paper::gpu_name)};
    for (const RowRecord& row : run.rows)
        if (const std::string flaw = first_flaw(row); !flaw.empty()) notes.push_back(flaw);
    return notes;
}

} // namespace

PaperTable table5(const SearchRun& run, const std::vector<RowDevice>& devices)
{
    PaperTable table{"table5", "Exit search only, on random tets and rays", fmt::format("{}, Table 5", paper::citation),
                     search_columns(), notes_of(run)};
    table.claims = claims_of(run);
    for (const RowRecord& row : run.rows)
        table.rows.push_back(cells_of(run, row, devices));
    return table;
}

} // namespace tetrace
