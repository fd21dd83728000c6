#include "bench/reproduce/speed.h"

#include "bench/measuring/figures.h"
#include "bench/terminal/text.h"
#include "core/pack/kernel_id.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace tetrace {

namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// The rated row that differs from the given one only in its method; none if there is none.
std::size_t find_beside(const RecordedRows& run, const RowRecord& other, Method method)
{
    RowKey wanted = other.key;
    wanted.kernel.method = method;
    for (std::size_t i = 0; i < run.rows.size(); ++i)
        if (run.rows[i].key == wanted && !view_seconds(run, i).empty()) return i;
    return none;
}

/// One row's time over that of another row with the same layout and device.
struct TimeRatio {
    std::string pair, where; ///< "plane / maria"; "bunny tet80 openmp"
    Estimate estimate;
};

/// The ratios of one pair: the places of the smallest and the largest ratio.
std::string range_text(const std::string& pair, const std::vector<TimeRatio>& ratios)
{
    std::vector<TimeRatio> of_pair;
    std::ranges::copy_if(ratios, std::back_inserter(of_pair),
                         [&](const TimeRatio& ratio) { return ratio.pair == pair; });
    const auto [least, most] = std::ranges::minmax_element(
        of_pair, [](const auto& a, const auto& b) { return a.estimate.value < b.estimate.value; });
    const auto text = [](const TimeRatio& ratio) {
        return fmt::format("{} ({})", estimate_text(ratio.estimate), ratio.where);
    };
    return pair + ' ' + (of_pair.size() == 1 ? text(*least) : text(*least) + " to " + text(*most));
}

/// Collects ratios of rows' times, and the text that describes them.
struct Ratios {
    std::vector<TimeRatio> ratios;
    std::string missing;
    bool noisy = false;

    void add(const RecordedRows& run, const RowRecord& other, Method above, Method below)
    {
        const std::size_t a = find_beside(run, other, above), b = find_beside(run, other, below);
        if (a == none || b == none) {
            missing = fmt::format("{} and {} do not both have rates on {} {}.", name_of(a == none ? above : below),
                                  name_of(a == none ? below : above), other.key.scene, device_label(other.key));
            return;
        }
        noisy = noisy || is_noisy(run.rows[a]) || is_noisy(run.rows[b]);
        ratios.push_back(
            {fmt::format("{} / {}", name_of(above), name_of(below)),
             fmt::format("{} {} {}", other.key.scene, name_of(other.key.kernel.layout), device_label(other.key)),
             ratio_of_sums(view_seconds(run, a), view_seconds(run, b), run.sampling)});
    }

    /// "Every ratio is above 1."
    void decide(Claim& claim) const
    {
        decide(claim, [](const std::vector<Estimate>& estimates) { return judge_above(estimates, 1); });
    }

    template <class Judge>
    void decide(Claim& claim, const Judge& judge) const
    {
        claim.evidence = "Times of the same rays: " + text() + ".";
        if (ratios.empty()) {
            claim.evidence = missing.empty() ? "No row that it is about has a rate." : missing;
            return;
        }
        std::vector<Estimate> estimates;
        for (const TimeRatio& ratio : ratios)
            estimates.push_back(ratio.estimate);
        claim.verdict = judge(estimates);
        if (!missing.empty()) { // the available data may refute the claim, but cannot show it
            claim.evidence += ' ' + missing;
            if (claim.verdict == ClaimVerdict::holds) claim.verdict = ClaimVerdict::not_testable;
        }
        withdraw_if_noisy(claim, noisy);
    }

private:
    [[nodiscard]] std::string text() const
    {
        std::vector<std::string> told;
        std::string all;
        for (const TimeRatio& ratio : ratios) {
            if (std::ranges::find(told, ratio.pair) != told.end()) continue;
            told.push_back(ratio.pair);
            append_item(all, "; ", range_text(ratio.pair, ratios));
        }
        return all;
    }
};

/// Rows of the method that have a rate and that the claim is about.
template <class Visit>
void for_rows_of(Method method, const RecordedRuns& runs, const IsMeant& is_meant, const Visit& visit)
{
    for (const RecordedRows* run : runs)
        for (std::size_t i = 0; i < run->rows.size(); ++i)
            if (run->rows[i].key.kernel.method == method && is_meant(run->rows[i]) && !view_seconds(*run, i).empty())
                visit(*run, run->rows[i]);
}

/// How far off a number is, as a share of another.
Estimate relative_to(double reference, const Estimate& number)
{
    const auto share = [&](const std::optional<double>& bound) {
        return bound ? std::optional(*bound / reference - 1) : std::nullopt;
    };
    return {number.value / reference - 1, share(number.low), share(number.high), number.exact};
}

IsMeant of_kind(DeviceKind kind)
{
    return [=](const RowRecord& row) { return row.device.kind == kind; };
}

} // namespace

void withdraw_if_noisy(Claim& claim, bool noisy)
{
    if (!noisy) return;
    claim.verdict = ClaimVerdict::not_testable;
    claim.evidence +=
        fmt::format(" Rows are noisy (spread above {:.0f} %, or disturbed): measure again on a quieter machine.",
                    100 * noisy_spread);
}

bool is_noisy(const RowRecord& row)
{
    const auto figures = figures_of(row);
    return figures && figures->noisy;
}

const std::vector<Method>& older_methods()
{
    static const std::vector<Method> methods = [] {
        std::vector<Method> found;
        for (const KernelId& kernel : all_kernels())
            if (kernel.structure == Structure::cdt && traits_of(kernel.method).year < traits_of(Method::maria).year &&
                std::ranges::find(found, kernel.method) == found.end())
                found.push_back(kernel.method);
        return found;
    }();
    return methods;
}

std::string status_with_reason(const RowRecord& row)
{
    std::string status(name_of(status_of(row)));
    if (is_noisy(row)) status = status_of(row) == Status::ok ? "noisy" : status + ", noisy";
    const std::string reason = reason_of(row);
    return reason.empty() ? status : status + ": " + reason;
}

std::vector<double> view_seconds(const RecordedRows& run, std::size_t row)
{
    std::vector<double> seconds;
    if (!figures_of(run.rows[row])) return seconds;
    for (const ImageRecord& image : run.images[row])
        seconds.push_back(quantile(image.samples_s, 0.5));
    return seconds;
}

std::vector<double> view_steps(const RecordedRows& run, std::size_t row)
{
    std::vector<double> steps;
    for (const ImageRecord& image : run.images[row]) {
        const RayTotals& totals = image.verdict.totals;
        steps.push_back(static_cast<double>(totals.steps()) / static_cast<double>(totals.rays));
    }
    return steps;
}

std::optional<paper::Place> paper_place(const RowRecord& row)
{
    switch (row.device.kind) {
    case DeviceKind::cpu: return paper::Place::cpu;
    case DeviceKind::gpu: return paper::Place::gpu;
    case DeviceKind::emulated: break;
    }
    return std::nullopt;
}

std::string series_name(const RowRecord& row)
{
    return fmt::format("{} {} {} {}", row.key.scene, name_of(row.key.kernel.method), name_of(row.key.kernel.layout),
                       device_label(row.key));
}

Claim fastest_claim(Claim claim, const RecordedRuns& runs, const IsMeant& is_meant)
{
    if (older_methods().empty()) {
        claim.evidence = "This is the program's only method.";
        return claim;
    }
    Ratios ratios;
    for_rows_of(Method::maria, runs, is_meant, [&](const RecordedRows& run, const RowRecord& row) {
        for (const Method method : older_methods())
            ratios.add(run, row, method, Method::maria);
    });
    ratios.decide(claim);
    return claim;
}

Claim fastest_older_claim(Claim claim, const RecordedRuns& runs, Method method, const IsMeant& is_meant)
{
    Ratios ratios;
    for_rows_of(method, runs, is_meant, [&](const RecordedRows& run, const RowRecord& row) {
        for (const Method other : older_methods())
            if (other != method) ratios.add(run, row, other, method);
    });
    ratios.decide(claim);
    return claim;
}

Claim slower_claim(Claim claim, const RecordedRuns& runs, Method method, double slower, const IsMeant& is_meant)
{
    Ratios ratios;
    for_rows_of(Method::maria, runs, is_meant,
                [&](const RecordedRows& run, const RowRecord& row) { ratios.add(run, row, method, Method::maria); });
    ratios.decide(claim, [&](std::vector<Estimate> estimates) {
        for (Estimate& ratio : estimates)
            ratio = relative_to(1 + slower, ratio);
        return judge_within(estimates, slower_tolerance);
    });
    if (!ratios.ratios.empty())
        claim.evidence += fmt::format(" The paper has {:.2f}; within {:.0f} % is taken for equal.", 1 + slower,
                                      100 * slower_tolerance);
    return claim;
}

Claim overtaking_claim(Claim claim, const RecordedRuns& runs)
{
    Ratios ratios;
    for_rows_of(Method::plucker, runs, of_kind(DeviceKind::gpu), [&](const RecordedRows& run, const RowRecord& row) {
        ratios.add(run, row, Method::stp, Method::plucker);
    });
    ratios.decide(claim);
    if (ratios.ratios.empty() && ratios.missing.empty()) claim.evidence = "No row of a GPU has a rate.";
    return claim;
}

std::vector<Claim> speed_claims(const RecordedRuns& runs)
{
    return {fastest_claim({"maria-is-fastest-on-cpu", "maria is the fastest of the five methods on a CPU"}, runs,
                          of_kind(DeviceKind::cpu)),
            overtaking_claim({"plucker-overtakes-stp-on-gpu", "on a GPU plucker is faster than stp"}, runs)};
}

} // namespace tetrace
