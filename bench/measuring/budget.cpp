#include "bench/measuring/budget.h"

#include "bench/measuring/sampler.h"
#include "bench/measuring/verify.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "core/base/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr double slack = 0.25;      // of the budget, see the class
constexpr double telling_s = 0.1;   // launch overhead is a small part of a probe that takes this long
constexpr double estimating = 0.03; // of the budget: probes of all rows that take this long together are enough
constexpr double patience = 0.02;   // of what is left of the budget: a probe that takes this long is not repeated
constexpr unsigned coarsest_step = 16;

std::size_t first_view_with_rays(const RowRun& row)
{
    std::size_t view = 0;
    while (view < row.scene->views().size() && ray_count(row, view) == 0)
        ++view;
    return view;
}

/// The view's image, every step-th pixel of every step-th line.
TraceJob coarse_job(TraceJob job, unsigned step)
{
    for (Float3* const part : {&job.view.step_x, &job.view.step_y})
        for (float* const c : {&part->x, &part->y, &part->z})
            *c *= static_cast<float>(step);
    job.width /= step;
    job.height /= step;
    return job;
}

/// Gives the session 1 of step * step of these rays, the first ones; returns their number. lists: the quads of a ray,
/// each in a list of all rays' (kernels/layouts/layout.h).
std::size_t give_first(Session& session, std::span<const Quad> quads, std::size_t lists, unsigned step)
{
    const std::size_t all = quads.size() / lists;
    const std::size_t rays = std::max<std::size_t>(all / (std::size_t{step} * step) / TILE_WIDTH, 1) * TILE_WIDTH;
    std::vector<Quad> first;
    for (std::size_t list = 0; list < quads.size(); list += all)
        first.insert(first.end(), &quads[list], &quads[list] + rays);
    session.set_rays(first);
    return rays;
}

/// The job that traces 1 of step * step of the view's rays; of given rays, the first ones.
TraceJob prepare_probe(RowRun& row, std::size_t view, unsigned step)
{
    const TraceJob job = prepare_view(row, view);
    if (!traits_of(row.key.kernel.task).takes_rays) return coarse_job(job, step);
    const auto& quads =
        row.scene->given_rays().rows(*row.scene, row.key, row.packed != nullptr ? &row.packed->data : nullptr, view);
    row.views_of_rays.clear();
    return given_job(give_first(*row.session, quads, GIVEN_RAY_QUADS, step), job.max_steps, job.any_hit);
}

/// Whether the row is still in the run.
bool is_alive(const RowRun& row)
{
    return row.session != nullptr && traced(row) != nullptr;
}

/// A time as --budget takes it, rounded up: "45s", "7m".
std::string budget_text(double seconds)
{
    return seconds <= 60 ? fmt::format("{:.0f}s", std::max(1.0, std::ceil(seconds)))
                         : fmt::format("{:.0f}m", std::ceil(seconds / 60));
}

} // namespace

Budget::Budget(double seconds, Clock clock, double shares)
    : seconds_(seconds), shares_(shares), clock_(std::move(clock)), start_s_(clock_())
{
}

void Budget::plan(std::vector<RowRun>& rows, unsigned samples, double sample_s, unsigned runs)
{
    plan(
        rows, Entry{.samples = static_cast<double>(samples), .sample_s = sample_s, .runs = static_cast<double>(runs)},
        [](RowRun& row) { return views_of(row, 0); }, false);
}

void Budget::plan_views(std::vector<RowRun>& rows, unsigned samples, double sample_s, std::size_t first)
{
    plan(
        rows, Entry{.samples = static_cast<double>(samples), .sample_s = sample_s},
        [first](RowRun& row) { return views_of(row, first); }, true);
}

void Budget::plan_batches(std::vector<RowRun>& rows, unsigned samples, double sample_s, std::size_t batches,
                          std::span<const Quad> quads)
{
    const auto batches_of = [&](RowRun& row) {
        return Parts{batches, quads.size() / RAY_QUADS, coarsest_step, [&row, quads](unsigned step) {
                         return search_job(give_first(*row.session, quads, RAY_QUADS, step));
                     }};
    };
    plan(rows, Entry{.samples = static_cast<double>(samples), .sample_s = sample_s}, batches_of, true);
}

Budget::Parts Budget::views_of(RowRun& row, std::size_t first)
{
    const std::size_t views = row.scene->views().size(), view = first_view_with_rays(row);
    Parts parts{.count = views - first};
    if (view == views) return parts;
    parts.rays = ray_count(row, view);
    parts.max_step = coarsest_step;
    while (parts.max_step > 1 && std::min(row.scene->width(), row.scene->height()) / parts.max_step < TILE_WIDTH)
        parts.max_step /= 2;
    parts.prepare = [&row, view](unsigned step) { return prepare_probe(row, view, step); };
    return parts;
}

/// Estimates the seconds of a part by tracing more and more of its rays, until there are enough for an estimate. The
/// first launch, in which devices may compile, does not count; its time goes into the row's first pass. enough_s: what
/// a probe takes at most, if it can be made so short.
double Budget::estimated_part_s(RowRun& row, const Parts& parts, double enough_s) const
{
    if (parts.rays == 0) return 0;
    unsigned step = parts.max_step;
    const auto launch = [&] {
        const TraceJob job = parts.prepare(step);
        return std::pair(timed_launch(*row.session, job, clock_).wall_s, static_cast<double>(job.rays()));
    };
    const double patience_s = patience * left_s();
    std::get<Traced>(row.outcome).wall_s += launch().first;
    for (;; step /= 2) {
        // The quickest of three where the first is slow: on a busy machine a thread may wait longer than it works.
        auto [seconds, rays] = launch();
        for (int again = 0; again < 2 && seconds >= enough_s && seconds < patience_s; ++again)
            seconds = std::min(seconds, launch().first);
        if (seconds >= enough_s || step == 1) return seconds / rays * static_cast<double>(parts.rays);
    }
}

/// samples: how many there are of each row, in how many runs, and how long each lasts.
void Budget::plan(std::vector<RowRun>& rows, const Entry& samples, const PartsOf& parts_of, bool part_by_part)
{
    start_s_ = now();
    if (!is_limited()) return;
    const double enough_s = std::min(telling_s, estimating * seconds_ / static_cast<double>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        RowRun& row = rows[i];
        progress_line().show("estimating", static_cast<double>(i) / static_cast<double>(rows.size()), -1,
                             row_label(row.key));
        Entry entry = samples;
        entry.row = &row;
        if (is_alive(row) && !entries_.empty() && left_s() <= 0) {
            row.outcome =
                Skipped{Status::skipped, fmt::format("--budget of {} was spent before this row was estimated; "
                                                     "with more it is measured",
                                                     seconds_text(shares_ * seconds_))};
            row.session.reset();
        }
        Parts parts;
        if (is_alive(row))
            guarded(row, [&] {
                parts = parts_of(row);
                entry.view_s = estimated_part_s(row, parts, enough_s);
            });
        if (!is_alive(row)) continue;
        entry.views = static_cast<double>(parts.count);
        entry.views_left =
            entry.views + 1 + (samples.samples > 0 ? entry.views * entry.runs : 0); // verified, warmed up
        // `reproduce` takes all that were asked for; `bench` may do with fewer.
        if (!part_by_part) entry.samples = std::min(entry.samples, static_cast<double>(min_samples));
        entry.views_per_sample = part_by_part ? 1 : entry.views;
        entry.views_to_judge = entry.views;
        entry.view_rays = static_cast<double>(parts.rays);
        entries_.push_back(entry);
    }
    for (Entry& entry : entries_)
        entry.is_reference = std::ranges::any_of(entries_, [&](const Entry& other) {
            return other.row->scene != nullptr && reference_of(other.row->key) == entry.row->key;
        });
    fit(left_s());
    if (alive() == 1 && needed_s() > left_s())
        say(fmt::format(
            "--budget: even one row would take about {}, and {} of {} is left; it is measured anyway. Other "
            "rows, {} take less",
            seconds_text(needed_s()), seconds_text(std::max(0.0, left_s())), seconds_text(seconds_),
            rows.front().scene == nullptr ? "or fewer --searches," : "fewer --views or a smaller --size"));
}

/// A sample of several passes has one more, which is launched by itself, and up to one more than it needs.
double Budget::Entry::launches_s() const
{
    if (samples == 0 || views == 0) return views_left * view_s;
    const double pass_s = view_s * views_per_sample, parts = views / views_per_sample;
    const double each_s = pass_s < sample_s ? std::min(sample_s + 2 * pass_s, (max_passes + 1) * pass_s) : pass_s;
    const unsigned latencies = latency_passes(static_cast<unsigned>(samples), passes_for(sample_s, pass_s));
    return views_left * view_s + runs * parts * (samples * each_s + (views_per_sample > 1 ? latencies * pass_s : 0));
}

bool Budget::Entry::is_in_group_of(const Entry& other) const
{
    return row->scene == other.row->scene && row->key.rays == other.row->key.rays;
}

double Budget::need_s(const Entry& entry) const
{
    const double judging_s = judged_rays_ == 0 ? 0 : judged_s_ / judged_rays_ * entry.view_rays * entry.views_to_judge;
    return entry.launches_s() + judging_s;
}

void Budget::traced(const RowRun& row, std::size_t views, double seconds)
{
    for (Entry& entry : entries_) {
        if (entry.row != &row) continue;
        entry.views_left = std::max(0.0, entry.views_left - static_cast<double>(views));
        entry.seen_views += static_cast<double>(views);
        entry.seen_s += seconds;
        entry.view_s = entry.seen_s / entry.seen_views;
    }
}

void Budget::restored(const RowRun& row, std::size_t views)
{
    for (Entry& entry : entries_) {
        if (entry.row != &row) continue;
        entry.views_left = std::max(0.0, entry.views_left - static_cast<double>(views));
        entry.views_to_judge = std::min(entry.views_to_judge, entry.views - static_cast<double>(views));
    }
}

void Budget::judged(std::span<const RowRun* const> rows, double seconds)
{
    judged_s_ += seconds;
    for (Entry& entry : entries_) {
        if (std::ranges::find(rows, entry.row) == rows.end()) continue;
        judged_rays_ += entry.view_rays;
        entry.views_to_judge = std::max(0.0, entry.views_to_judge - 1);
    }
}

void Budget::view_done()
{
    for (Entry& entry : entries_)
        entry.views = std::max(0.0, entry.views - 1);
    review();
}

void Budget::review()
{
    fit(left_s() + slack * seconds_);
}

void Budget::review_timed()
{
    const double affordable_s = left_s() + slack * seconds_;
    while (needed_s() > affordable_s && skip_slowest_spare()) {
    }
    if (!skip_slowest(affordable_s, false)) skip_slowest(affordable_s, true);
}

void Budget::fit(double affordable_s)
{
    while (needed_s(true) > affordable_s && skip_last_group()) {
    }
    while (needed_s(true) > affordable_s && skip_slowest_reference()) {
    }
    while (needed_s() > affordable_s && (skip_slowest_spare() || skip_last_group())) {
    }
    skip_slowest(affordable_s, false);
}

bool Budget::is_spare(const Entry& entry) const
{
    const auto is_faster = [&](const Entry& other) {
        if (!is_alive(*other.row) || !other.is_in_group_of(entry) ||
            other.row->key.kernel.structure != entry.row->key.kernel.structure)
            return false;
        return need_s(other) < need_s(entry) || (need_s(other) == need_s(entry) && &other < &entry);
    };
    return !entry.is_reference && std::ranges::any_of(entries_, is_faster);
}

/// Whether there was one.
bool Budget::skip_slowest_spare()
{
    Entry* const slow = slowest([this](const Entry& entry) { return is_spare(entry); });
    if (slow != nullptr) skip(*slow);
    return slow != nullptr;
}

/// Of those with a row that is still in the run; never the only one. Whether there was one.
bool Budget::skip_last_group()
{
    const auto is_left = [](const Entry& entry) { return is_alive(*entry.row); };
    const auto first = std::ranges::find_if(entries_, is_left);
    const auto last = std::find_if(entries_.rbegin(), entries_.rend(), is_left);
    if (first == entries_.end() || first->is_in_group_of(*last)) return false;
    for (Entry& entry : entries_)
        if (entry.is_in_group_of(*last) && is_alive(*entry.row)) skip(entry);
    return true;
}

/// With the rows that are compared with it; never the only one. Whether there was one.
bool Budget::skip_slowest_reference()
{
    Entry* const slow = slowest([](const Entry& entry) { return entry.is_reference; });
    const auto is_other = [&](const Entry& entry) {
        return &entry != slow && entry.is_reference && is_alive(*entry.row);
    };
    if (slow == nullptr || std::ranges::none_of(entries_, is_other)) return false;
    const RowKey reference = slow->row->key;
    for (Entry& entry : entries_)
        if (is_alive(*entry.row) && (&entry == slow || reference_of(entry.row->key) == reference)) skip(entry);
    return true;
}

/// Whether the rows fit afterwards. The last row stays.
bool Budget::skip_slowest(double affordable_s, bool among_references)
{
    while (needed_s() > affordable_s) {
        Entry* const entry = slowest([&](const Entry& row) { return row.is_reference == among_references; });
        if (entry == nullptr || alive() == 1) return false;
        skip(*entry);
    }
    return true;
}

/// Null if there is none.
template <class Is>
Budget::Entry* Budget::slowest(const Is& is)
{
    Entry* found = nullptr;
    for (Entry& entry : entries_)
        if (is_alive(*entry.row) && is(entry) && (found == nullptr || need_s(entry) > need_s(*found))) found = &entry;
    return found;
}

void Budget::skip(Entry& entry)
{
    entry.skipped_s = need_s(entry);
    entry.row->session.reset();
    skipped_s_ += *entry.skipped_s;
    for (const Entry& other : entries_)
        if (other.skipped_s && !fails(*other.row, true)) // an answer that is known to be wrong is always reported
            other.row->outcome =
                Skipped{Status::skipped, fmt::format("would take about {}{}{} it is measured",
                                                     seconds_text(*other.skipped_s), with_budget, sufficient())};
}

/// A budget that fits all rows, including the skipped ones: a quarter more than their expected time.
std::string Budget::sufficient() const
{
    return budget_text(1.25 * shares_ * (spent_s() + needed_s() + skipped_s_));
}

double Budget::needed_s(bool by_references_only) const
{
    double sum = 0;
    for (const Entry& entry : entries_)
        if (is_alive(*entry.row) && (entry.is_reference || !by_references_only)) sum += need_s(entry);
    return sum;
}

std::size_t Budget::alive() const
{
    return static_cast<std::size_t>(
        std::ranges::count_if(entries_, [](const Entry& entry) { return is_alive(*entry.row); }));
}

Budget& no_budget()
{
    static Budget budget;
    return budget;
}

} // namespace tetrace
