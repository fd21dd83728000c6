#include "bench/results/result_comparison.h"

#include "bench/options/name_filter.h"
#include "bench/results/work_recipe.h"
#include "bench/rows/sized_scene.h"
#include "bench/statistics/statistics.h"
#include "core/base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tetrace {

namespace {

std::string rays_text(const ResultScene& scene)
{
    const std::string hash = scene.camera_set_hash.empty() ? "" : " " + scene.camera_set_hash;
    return fmt::format("{} views of {}{} at {}x{}", scene.views.size(), scene.camera_set, hash, scene.width,
                       scene.height);
}

/// What decides the answers of a structure: tets and domain decide those of a BVH no more than a layout does. Results
/// before 2026-11-27 have only the hash of the mesh file; that the hits are the same says the rest.
std::string geometry_hash(const ResultScene& scene, bool is_bvh, bool have_mesh_hash)
{
    if (!is_bvh) return scene.hash;
    if (have_mesh_hash) return scene.mesh_hash;
    return scene.source_hash.empty() ? scene.hash : scene.source_hash;
}

/// What differs, and what would do A's work again.
std::string other_work(const ResultScene& a, const ResultScene& b, bool is_bvh)
{
    const bool have_mesh_hash = !a.mesh_hash.empty() && !b.mesh_hash.empty();
    const std::string in_a = geometry_hash(a, is_bvh, have_mesh_hash), in_b = geometry_hash(b, is_bvh, have_mesh_hash);
    std::string difference;
    if (in_a != in_b)
        difference =
            fmt::format("the {} {} has hash {} in A and {} in B", is_bvh ? "mesh of" : "scene", a.name, in_a, in_b);
    else if (rays_text(a) != rays_text(b))
        difference = fmt::format("{} in A, {} in B", rays_text(a), rays_text(b));
    else if (a.views != b.views)
        difference = fmt::format("other views of {} in A than in B", a.camera_set);
    else
        return {};
    const std::string recipe = work_recipe(a, b, in_a == in_b).text();
    return difference + (recipe.empty() ? "" : "; ") + recipe;
}

std::string other_searches(const ResultFile& a, const ResultFile& b)
{
    if (a.search_size == b.search_size) return {};
    return fmt::format("{} searches in A, {} in B", a.search_size, b.search_size);
}

/// On a GPU, views that are traced together take less time than views with a launch each.
std::string launches_of(const ResultFile& file, const ResultRow& row)
{
    if (row.device_kind != DeviceKind::gpu || row.scene.empty()) return {};
    return row.launches == 0 || row.launches == scene_of(file, row).views.size()
               ? "a launch for each view"
               : fmt::format("all views in {} launch{}", row.launches, row.launches == 1 ? "" : "es");
}

std::string other_launches(const std::string& a, const std::string& b)
{
    return a == b ? std::string() : fmt::format("{} in A, {} in B", a, b);
}

/// Merged shards have only the hash of their views.
std::string other_answers(const ResultRow& a, const ResultRow& b)
{
    const bool have_hits = !a.hit_hash.empty() && !b.hit_hash.empty();
    const bool have_views = !a.views_hash.empty() && !b.views_hash.empty();
    const auto hash = have_views && !have_hits ? &ResultRow::views_hash : &ResultRow::hit_hash;
    if ((a.*hash).empty() || (b.*hash).empty()) return fmt::format("no hit hash in {}", (a.*hash).empty() ? "A" : "B");
    return a.*hash == b.*hash ? std::string() : fmt::format("hit hash {} in A and {} in B", a.*hash, b.*hash);
}

} // namespace

const ResultScene& scene_of(const ResultFile& file, const ResultRow& row)
{
    if (const ResultScene* scene = file.find_scene(row.scene)) return *scene;
    throw Error(ErrorKind::invalid_input,
                fmt::format("reading the result '{}': the row {} was timed on the scene '{}', which is not among "
                            "tetrace.scenes",
                            file.path.string(), row.name, row.scene));
}

std::string different_rays(const ResultFile& a, const ResultRow& row_a, const ResultFile& b, const ResultRow& row_b)
{
    if (row_a.scene.empty()) return {};
    return other_work(scene_of(a, row_a), scene_of(b, row_b), row_a.structure == "bvh");
}

std::string different_work(const ResultFile& a, const ResultRow& row_a, const ResultFile& b, const ResultRow& row_b)
{
    std::string difference = row_a.scene.empty() ? other_searches(a, b) : different_rays(a, row_a, b, row_b);
    if (difference.empty() && row_a.api() == row_b.api())
        difference = other_launches(launches_of(a, row_a), launches_of(b, row_b));
    return difference.empty() ? other_answers(row_a, row_b) : difference;
}

namespace {

std::string rays_through(const std::string& geometry, const ResultScene& scene)
{
    return fmt::format("{} {} of {}: {}", geometry, rays_text(scene), scene.name, fmt::join(scene.views, ","));
}

} // namespace

std::string rays_of(const ResultFile& file, const ResultRow& row)
{
    if (row.scene.empty()) return file.search_size;
    const ResultScene& scene = scene_of(file, row);
    return rays_through(scene.hash, scene);
}

std::string work_of(const ResultFile& file, const ResultRow& row)
{
    const std::string& hash =
        row.hit_hash.empty() ? row.views_hash : row.hit_hash; // merged shards have only the latter
    if (hash.empty()) return {};
    const bool is_bvh = row.structure == "bvh";
    const std::string rays = is_bvh ? rays_through(geometry_hash(scene_of(file, row), true, false), scene_of(file, row))
                                    : rays_of(file, row);
    return fmt::format("{} {} {} {}", row.name, hash, rays, launches_of(file, row));
}

bool RatePulse::is_noisy() const
{
    return ratio && *ratio >= noisy_pulse;
}

RatePulse pulse_of(const ResultHead& head, const ResultRow& row)
{
    const bool on_host = row.device_kind && *row.device_kind != DeviceKind::gpu;
    return {row.pulse_ratio, on_host ? head.host_pulse_s : std::nullopt};
}

std::string disturbance_between(const RatePulse& before, const RatePulse& after, bool same_machine,
                                const std::string& before_name, const std::string& after_name)
{
    std::string text;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
    for (const auto& [name, one] : {std::pair(before_name, &before), std::pair(after_name, &after)})
        if (one->is_noisy())
            add(fmt::format("in {} calibration during its samples took {:.2f} times its fastest", name, *one->ratio));
    if (!same_machine || !before.host_s || !after.host_s) return text;
    const double change = *after.host_s / *before.host_s, factor = std::max(change, 1 / change);
    if (factor >= noisy_pulse)
        add(fmt::format("the same machine's calibration took {:.2f} times as long in {} as in {}", factor,
                        change > 1 ? after_name : before_name, change > 1 ? before_name : after_name));
    return text;
}

namespace {

bool is_timed(const ResultRow* row)
{
    return row != nullptr && has_answers(row->status) && !row->samples_s.empty();
}

bool has_failed(const ResultRow* row)
{
    return row != nullptr && (row->status == Status::wrong || row->status == Status::error);
}

RowOutcome outcome_of(const ComparedRow& row)
{
    if (is_timed(row.before) && is_timed(row.after)) return RowOutcome::compared;
    if (is_timed(row.before)) return has_failed(row.after) ? RowOutcome::failed : RowOutcome::missing;
    return is_timed(row.after) ? RowOutcome::added : RowOutcome::untimed;
}

std::string why_untimed(const char* label, const ResultRow* row)
{
    if (is_timed(row)) return {};
    if (row == nullptr) return fmt::format("{}: no such row", label);
    if (!row->reason.empty()) return fmt::format("{}: {}: {}", label, name_of(row->status), row->reason);
    return fmt::format("{}: {}", label, has_answers(row->status) ? "no samples" : name_of(row->status));
}

std::string name_without_size(const ResultRow& row)
{
    std::string name = row.name;
    const std::string size = size_in(row.scene);
    if (const std::size_t at = name.find(size); !size.empty() && at != std::string::npos) name.erase(at, size.size());
    return name;
}

std::string name_without_scene(const ResultRow& row)
{
    std::string name = row.name;
    if (const std::size_t at = name.find("/" + row.scene + "/"); at != std::string::npos)
        name.erase(at, row.scene.size() + 1);
    return name;
}

/// The row's name without its API, which it ends with.
std::string name_without_api(const ResultRow& row)
{
    return row.name.substr(0, row.name.find("/api:"));
}

bool share_an_api(const ResultFile& a, const ResultFile& b)
{
    return std::ranges::any_of(a.rows, [&](const ResultRow& row) {
        return std::ranges::find(b.rows, row.backend, &ResultRow::backend) != b.rows.end();
    });
}

/// Whether the names differ only by the size of images, which one of them has, or by the name of the same scene, as of
/// a .tet file.
bool are_of_one_row(const ResultFile& file_a, const ResultRow& a, const ResultFile& file_b, const ResultRow& b)
{
    const ResultScene *const in_a = file_a.find_scene(a.scene), *const in_b = file_b.find_scene(b.scene);
    if (in_a == nullptr || in_b == nullptr) return false; // one that could not be loaded, or a search
    if (in_a->width != in_b->width || in_a->height != in_b->height) return false;
    return name_without_size(a) == name_without_size(b) ||
           (in_a->hash == in_b->hash && name_without_scene(a) == name_without_scene(b));
}

/// The second file's row for rows of the first: of the same name, or else one that has no partner yet.
std::map<const ResultRow*, const ResultRow*> partners_in(const ResultFile& before, const ResultFile& after)
{
    std::map<const ResultRow*, const ResultRow*> partners;
    std::set<const ResultRow*> paired;
    const auto pair = [&](const ResultRow* row, const ResultRow* partner) {
        if (partner != nullptr && paired.insert(partner).second) partners[row] = partner;
    };
    for (const ResultRow* row : before.timed_rows())
        pair(row, after.find_row(row->name));
    const auto pair_others = [&](const auto& are_partners) {
        for (const ResultRow& row : before.rows) {
            if (partners.contains(&row)) continue;
            const auto found = std::ranges::find_if(
                after.rows, [&](const ResultRow& one) { return !paired.contains(&one) && are_partners(row, one); });
            if (found != after.rows.end()) pair(&row, &*found);
        }
    };
    pair_others([&](const ResultRow& row, const ResultRow& one) { return are_of_one_row(before, row, after, one); });
    if (!share_an_api(before, after))
        pair_others(
            [](const ResultRow& row, const ResultRow& one) { return name_without_api(row) == name_without_api(one); });
    return partners;
}

std::vector<ComparedRow> paired_rows(const ResultFile& before, const ResultFile& after, const std::string& filter)
{
    const NameFilter names("--filter", filter);
    const auto kept = [&](const ResultRow& row) { return names.keeps(row.name); };
    const auto partners = partners_in(before, after);
    std::set<const ResultRow*> paired;
    std::vector<ComparedRow> rows;
    for (const auto& [row, partner] : partners)
        paired.insert(partner);
    for (const ResultRow* row : before.timed_rows()) {
        const auto partner = partners.find(row);
        if (kept(*row)) rows.push_back({row, partner == partners.end() ? nullptr : partner->second, {}, {}, {}});
    }
    for (const ResultRow* row : after.timed_rows())
        if (kept(*row) && !paired.contains(row)) rows.push_back({nullptr, row, {}, {}, {}});
    for (ComparedRow& row : rows)
        row.outcome = outcome_of(row);
    return rows;
}

[[noreturn]] void reject_pair(const ResultFile& before, const ResultFile& after, const std::string& why)
{
    throw Error(ErrorKind::invalid_input,
                fmt::format("comparing A, '{}' (of 'tetrace {}'), with B, '{}' (of 'tetrace {}'): {}",
                            before.path.string(), before.head.verb, after.path.string(), after.head.verb, why));
}

/// Takes the rows that did different work out of the comparison. Some are expected: Embree's answers, and those of math
/// mode fast, depend on the processor.
void find_different_work(const ResultFile& before, const ResultFile& after, std::vector<ComparedRow>& rows)
{
    std::map<std::string, std::vector<const ComparedRow*>> reasons;
    bool any_compared = false;
    for (ComparedRow& row : rows) {
        if (row.outcome != RowOutcome::compared) continue;
        row.difference = different_work(before, *row.before, after, *row.after);
        any_compared = any_compared || row.difference.empty();
        if (row.difference.empty()) {
            if (row.before->api() != row.after->api()) row.outcome = RowOutcome::agreed;
            continue;
        }
        row.outcome = RowOutcome::different;
        reasons[row.difference].push_back(&row);
    }
    if (any_compared || reasons.empty()) return;
    std::string text = "no row did the same work in both, so no times are comparable:";
    for (const auto& [reason, of] : reasons)
        text += of.size() == 1 ? fmt::format("\n  {}: {}", of.front()->name(), reason)
                               : fmt::format("\n  {} rows, such as {}: {}", of.size(), of.front()->name(), reason);
    reject_pair(before, after, text);
}

void require_rows(const ResultFile& before, const ResultFile& after, const std::vector<ComparedRow>& rows,
                  const std::string& filter)
{
    if (rows.empty())
        reject_pair(before, after,
                    filter.empty() ? "neither has a row" : fmt::format("--filter '{}' matches no row", filter));
    if (std::ranges::none_of(rows, [](const ComparedRow& row) { return is_timed(row.before); }))
        reject_pair(before, after,
                    "A lacks rows with samples to compare with; 'tetrace bench --out FILE.json' times rows");
    const auto is_common = [](const ComparedRow& row) { return is_timed(row.before) && row.after != nullptr; };
    if (std::ranges::any_of(rows, is_common)) return;
    const std::string recipe = rows_recipe(before, after);
    const auto timed = std::ranges::find_if(rows, [](const ComparedRow& row) { return is_timed(row.before); });
    reject_pair(
        before, after,
        fmt::format("they share no row that A times; A has {} and similar rows, B {}{}{}", timed->name(),
                    after.timed_rows().empty() ? "none" : after.timed_rows().front()->name + " and similar rows",
                    recipe.empty() ? "" : "; ", recipe));
}

} // namespace

std::string ComparedRow::verdict() const
{
    switch (outcome) {
    case RowOutcome::compared: return is_noisy() ? "NOISY" : std::string(name_of(change->verdict));
    case RowOutcome::different: return "DIFFERENT";
    case RowOutcome::failed: return "FAILED";
    case RowOutcome::missing: return "MISSING";
    case RowOutcome::added: return "NEW";
    case RowOutcome::untimed: return "NOT TIMED";
    case RowOutcome::agreed: return "SAME ANSWERS";
    }
    throw Error(ErrorKind::internal, "ComparedRow::verdict: no such outcome");
}

std::string ComparedRow::note() const
{
    if (is_noisy()) return disturbance;
    if (has_too_few_samples())
        return fmt::format("fewer than {} samples, so no interval: {} in A and {} in B", min_samples,
                           before->samples_s.size(), after->samples_s.size());
    if (outcome == RowOutcome::different) return difference;
    if (outcome == RowOutcome::agreed)
        return fmt::format("{} in A and {} in B, whose rates are not compared", before->api(), after->api());
    const std::string a = why_untimed("A", before), b = why_untimed("B", after);
    return a + (a.empty() || b.empty() ? "" : "; ") + b;
}

std::size_t ResultComparison::count(RowOutcome outcome) const
{
    return static_cast<std::size_t>(
        std::ranges::count_if(rows, [&](const ComparedRow& row) { return row.outcome == outcome; }));
}

std::optional<double> ResultComparison::geometric_mean() const
{
    const std::size_t compared = count(RowOutcome::compared);
    if (compared == 0) return std::nullopt;
    double sum = 0;
    for (const ComparedRow& row : rows)
        if (row.change) sum += std::log(row.change->ratio);
    return std::exp(sum / static_cast<double>(compared));
}

double ResultComparison::error() const
{
    double sum = 0;
    for (const ComparedRow& row : rows)
        if (row.change && row.change->interval) sum += row.change->error;
    return std::min(1.0, sum);
}

std::vector<const ComparedRow*> ResultComparison::regressions(bool allow_missing) const
{
    std::vector<const ComparedRow*> found;
    const bool may_lack = allow_missing || !share_an_api(*before, *after);
    for (const ComparedRow& row : rows)
        if (row.outcome == RowOutcome::failed || (row.outcome == RowOutcome::missing && !may_lack) ||
            (row.change && !row.is_noisy() && row.change->is_regression(tolerance)))
            found.push_back(&row);
    return found;
}

ResultComparison compare_results(const ResultFile& before, const ResultFile& after, const std::string& filter,
                                 double tolerance)
{
    ResultComparison comparison{&before, &after, tolerance, paired_rows(before, after, filter)};
    require_rows(before, after, comparison.rows, filter);
    find_different_work(before, after, comparison.rows);
    const std::size_t compared = comparison.count(RowOutcome::compared);
    for (ComparedRow& row : comparison.rows)
        if (row.outcome == RowOutcome::compared)
            row.change = compare_speed(row.before->samples_s, row.after->samples_s, compared, tolerance);
    const ResultHead &a = before.head, &b = after.head;
    const bool same_machine = a.machine == b.machine && a.threads == b.threads;
    for (ComparedRow& row : comparison.rows)
        if (row.change && row.change->interval)
            row.disturbance = disturbance_between(pulse_of(a, *row.before), pulse_of(b, *row.after), same_machine);
    return comparison;
}

} // namespace tetrace
