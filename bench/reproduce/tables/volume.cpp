#include "bench/reproduce/tables/volume.h"

#include "bench/measuring/figures.h"
#include "core/base/hash.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr const char* volume_page = "docs/volume.md";

/// Rows that do the same work in the same way, on all devices, the reference's first.
using SameWork = std::vector<const RowRecord*>;

std::vector<SameWork> works_of(const std::vector<RowRecord>& rows)
{
    std::vector<SameWork> works;
    for (const RowRecord& row : rows) {
        const auto known = std::ranges::find_if(works, [&](const SameWork& work) {
            const RowKey& first = work.front()->key;
            return same_work(first, row.key) && first.kernel.schedule == row.key.kernel.schedule;
        });
        (known == works.end() ? works.emplace_back() : *known).push_back(&row);
    }
    return works;
}

std::size_t count_answered(const SameWork& work)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(work, [](const RowRecord* row) { return has_answers(*row); }));
}

/// The first with answers; null if there is none.
const RowRecord* first_answered(const SameWork& work)
{
    const auto row = std::ranges::find_if(work, [](const RowRecord* candidate) { return has_answers(*candidate); });
    return row == work.end() ? nullptr : *row;
}

/// Those whose answers have the hash of the first ones.
std::size_t count_equal(const SameWork& work)
{
    const RowRecord* const first = first_answered(work);
    return static_cast<std::size_t>(std::ranges::count_if(work, [&](const RowRecord* row) {
        return has_answers(*row) && traced(*row)->hit_hash == traced(*first)->hit_hash;
    }));
}

/// The places where rows ran, in their order.
std::vector<const RowRecord*> places_of(const std::vector<RowRecord>& rows)
{
    std::vector<const RowRecord*> places;
    for (const RowRecord& row : rows)
        if (std::ranges::none_of(places, [&](const RowRecord* place) { return same_place(place->key, row.key); }))
            places.push_back(&row);
    return places;
}

PaperCell rate_at(const RowRecord& place, const SameWork& work)
{
    const auto row =
        std::ranges::find_if(work, [&](const RowRecord* candidate) { return same_place(candidate->key, place.key); });
    if (row == work.end()) return {};
    const auto figures = figures_of(**row);
    return figures ? exact_cell(figures->mrays_per_s) : PaperCell();
}

/// Of task tally: the sums are compared after each launch that is read, so a row with answers has right ones.
PaperCell sums_cell(const SameWork& work)
{
    if (!traits_of(work.front()->key.kernel.task).tallies) return {};
    return count_answered(work) == 0 ? PaperCell()
           : std::ranges::any_of(work, [](const RowRecord* row) { return status_of(*row) == Status::wrong; })
               ? PaperCell(std::string("wrong"))
               : PaperCell(std::string("equal"));
}

std::vector<PaperCell> cells_of_work(const SameWork& work, const std::vector<const RowRecord*>& places)
{
    std::vector<PaperCell> cells{work.front()->key.scene, kernel_title(work.front()->key)};
    if (const RowRecord* const first = first_answered(work)) {
        const Traced* const result = traced(*first);
        const Verdicts& verdicts = result->verdicts;
        cells.emplace_back(hash_text(result->hit_hash));
        cells.emplace_back(fmt::format("{} of {}", count_equal(work), count_answered(work)));
        cells.push_back(sums_cell(work));
        cells.push_back(exact_cell(static_cast<double>(result->totals.rays)));
        cells.push_back(known_number(mean_steps(result->totals).all));
        for (const std::uint64_t count : {verdicts.agreed, verdicts.ties, verdicts.wrong, verdicts.lost})
            cells.push_back(exact_cell(static_cast<double>(count)));
    } else
        cells.resize(11);
    for (const RowRecord* place : places)
        cells.push_back(rate_at(*place, work));
    std::string reasons;
    for (const RowRecord* row : work)
        if (traced(*row) == nullptr || status_of(*row) == Status::wrong)
            reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", device_label(row->key), reason_of(*row));
    cells.push_back(known_text(reasons));
    return cells;
}

Claim bits_claim(const std::vector<SameWork>& works)
{
    Claim claim{"same-bits", "each row has the same bits on every device and for any number of threads"};
    std::size_t compared = 0, differing = 0;
    for (const SameWork& work : works) {
        if (count_answered(work) > 1) ++compared;
        const bool is_wrong =
            std::ranges::any_of(work, [](const RowRecord* row) { return status_of(*row) == Status::wrong; });
        if (is_wrong || count_equal(work) != count_answered(work)) ++differing;
    }
    if (differing > 0)
        claim.verdict = ClaimVerdict::does_not_hold;
    else if (compared > 0)
        claim.verdict = ClaimVerdict::holds;
    claim.evidence = fmt::format("{} of {} rows differ; {} ran in several places", differing, works.size(), compared);
    return claim;
}

Claim sums_claim(const std::vector<SameWork>& works)
{
    Claim claim{"exact-sums", "the sums of the tets are those of the verified walks, and add up to the lengths of the "
                              "rays, as integers"};
    std::size_t tallies = 0, wrong = 0;
    for (const SameWork& work : works)
        for (const RowRecord* row : work) {
            if (!traits_of(row->key.kernel.task).tallies) continue;
            tallies += has_answers(*row) ? 1 : 0;
            wrong += status_of(*row) == Status::wrong ? 1 : 0;
        }
    if (wrong > 0)
        claim.verdict = ClaimVerdict::does_not_hold;
    else if (tallies > 0)
        claim.verdict = ClaimVerdict::holds;
    claim.evidence = fmt::format("{} tallies are right, {} are wrong", tallies, wrong);
    return claim;
}

Claim lost_claim(const std::vector<SameWork>& works)
{
    Claim claim{"none-lost", "method project loses no ray and gets none wrong"};
    std::uint64_t rays = 0, flawed = 0;
    for (const SameWork& work : works) {
        const RowRecord* const first = first_answered(work);
        if (work.front()->key.kernel.method != Method::project || first == nullptr) continue;
        rays += traced(*first)->totals.rays;
        flawed += traced(*first)->verdicts.lost + traced(*first)->verdicts.wrong;
    }
    if (rays > 0) claim.verdict = flawed == 0 ? ClaimVerdict::holds : ClaimVerdict::does_not_hold;
    claim.evidence = fmt::format("{} of {} rays", flawed, rays);
    return claim;
}

std::vector<PaperCell> cells_of_lines(const std::string& scene, const LineTest& test)
{
    std::vector<PaperCell> cells{scene};
    const auto add = [&](double value) { cells.push_back(exact_cell(value)); };
    add(static_cast<double>(test.lines));
    add(test.mean_length);
    add(test.expected_length);
    add(test.mean_off);
    for (const CellTest& of : {test.tets, test.groups}) {
        add(static_cast<double>(of.cells));
        add(of.off);
        add(100 * static_cast<double>(of.testable) / static_cast<double>(of.cells));
        cells.push_back(known_number(of.testable > 0 ? std::optional(of.worst) : std::nullopt));
    }
    cells.emplace_back(std::string(!test.is_testable() ? "too few lines" : test.passes() ? "passed" : "failed"));
    return cells;
}

} // namespace

PaperTable volume_table(const std::vector<RowRecord>& rows)
{
    PaperTable table{"volume",
                     "all tets of a ray, sums per tet, and light",
                     volume_page,
                     {{"scene", "scene"},
                      {"row", "row"},
                      {"hash", "hash"},
                      {"same", "same on"},
                      {"sums", "sums"},
                      {"rays", "rays", "", 0},
                      {"tets_per_ray", "per ray", "tets", 1},
                      {"agreed", "agreed", "", 0},
                      {"ties", "ties", "", 0},
                      {"wrong", "wrong", "", 0},
                      {"lost", "lost", "", 0}},
                     {"Random lines that cross the domain. The hash is that of all answers; 'same on' counts the "
                      "devices, and numbers of threads, that have it. Rates are Mrays/s of the device's time. All rays "
                      "are verified; those of packets are compared with those of single rays. The methods "
                      "other than maria and project may lose rays.",
                      "Methods may go around an edge on different sides where a ray passes it within rounding; so "
                      "their hashes can differ although both are right."}};
    const auto places = places_of(rows);
    for (const RowRecord* place : places) {
        std::string key = "mrays_per_s_" + device_label(place->key);
        std::ranges::replace_if(
            key, [](char c) { return c == ' ' || c == ',' || c == ':' || c == '-'; }, '_');
        table.columns.push_back({key, device_label(place->key), "Mrays/s", 2});
    }
    table.columns.push_back({"remarks", "remarks"});
    const auto works = works_of(rows);
    for (const SameWork& work : works)
        table.rows.push_back(cells_of_work(work, places));
    table.claims = {bits_claim(works), sums_claim(works), lost_claim(works)};
    return table;
}

PaperTable volume_lines_table(const std::vector<SceneLines>& lines)
{
    PaperTable table{
        "volume-lines",
        "lengths of uniform lines, by integral geometry",
        volume_page,
        {{"scene", "scene"},
         {"lines", "lines", "", 0},
         {"mean_length", "mean", "length", 5},
         {"expected_length", "4 V / S", "length", 5},
         {"mean_off", "off", "sd", 2},
         {"tets", "tets", "", 0},
         {"tets_off", "off", "sd", 2},
         {"tets_testable", "testable", "%", 1},
         {"tets_worst", "worst", "of bound", 3},
         {"groups", "groups", "of tets", 0},
         {"groups_off", "off", "sd", 2},
         {"groups_testable", "testable", "%", 1},
         {"groups_worst", "worst", "of bound", 3},
         {"verdict", "verdict"}},
        {"The domain is tested, each tet by itself, and groups of tets that follow each other in memory. "
         "'off', failed from 6: what the domain's mean is off; for tets and groups, the sum of the squares "
         "of what their means are off, less its expectation; both in standard deviations. "
         "'worst' is the mean that is off most, over its bound: failed from 1. 'testable' tets have that "
         "bound below their expected length, so that a mean of 0 would fail. Too few lines: fewer than "
         "256, or fewer than 256 pairs of those compared have a tet in common. docs/spec/volume.md, S10, "
         "has the statistics. Lengths are in units of the domain."}};
    Claim claim{"uniform-lines",
                "uniform lines have a mean length of 4 V / S in volumes V: the domain, and tets taken together"};
    std::size_t failed = 0, tested = 0;
    for (const auto& [scene, test] : lines) {
        if (test.is_testable()) ++tested;
        if (test.is_testable() && !test.passes()) ++failed;
        table.rows.push_back(cells_of_lines(scene, test));
    }
    if (tested > 0) claim.verdict = failed == 0 ? ClaimVerdict::holds : ClaimVerdict::does_not_hold;
    claim.evidence = fmt::format("{} of {} scenes fail", failed, tested);
    if (tested < lines.size()) claim.evidence += fmt::format("; {} had too few lines", lines.size() - tested);
    table.claims = {std::move(claim)};
    return table;
}

} // namespace tetrace
