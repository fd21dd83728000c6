#include "bench/output/row_fields.h"

#include "bench/output/field_parts.h"
#include "bench/statistics/rank_interval.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

using namespace field_parts;
using nlohmann::json;

/// Reads an end of the ratio's interval.
auto end_of_interval(double FactorInterval::*end)
{
    return [=](const Comparison& comparison) {
        return comparison.interval ? std::optional(*comparison.interval.*end) : std::nullopt;
    };
}

std::string ratio_with_interval(const Comparison& comparison)
{
    const std::string interval = interval_text(comparison);
    return fmt::format("{:5.2f}", comparison.ratio) + (interval.empty() ? "" : " " + interval);
}

/// Reads the comparison with the fastest BVH.
template <class Read>
auto of_best_bvh(Read read)
{
    return [=](const RowFacts& facts) { return facts.best_bvh ? json(read(*facts.best_bvh)) : json(); };
}

json bvh_end(const RowFacts& facts, double FactorInterval::*end)
{
    return facts.best_bvh && facts.best_bvh->interval ? json(*facts.best_bvh->interval.*end) : json();
}

/// "0.26 G, 15 s": billions of rays, and the seconds of tracing that they take.
std::string paid_text(const PaidBuild& paid)
{
    if (paid.when != PaidBuild::When::later) return std::string(name_of(paid.when));
    return fmt::format("{:.2g} G, {}", 1e-9 * paid.rays, seconds_text(paid.tracing_s));
}

/// Reads a number that only builds that pay off later have.
auto if_later(double PaidBuild::*number, double factor)
{
    return [=](const PaidBuild& paid) {
        return paid.when == PaidBuild::When::later ? std::optional(factor * paid.*number) : std::nullopt;
    };
}

std::vector<RowField> reference_fields()
{
    return {
        {"", "comparison", &ratio_with_interval, rates("x {reference}")},
        {ratio_group, ratio_key::row,
         [](const RowFacts& facts) { return facts.comparison ? json(row_name(facts.row->key)) : json(); },
         recorded("line", required)},
        {ratio_group, ratio_key::ratio, &Comparison::ratio,
         recorded("positive", required,
                  "the reference's median device seconds over the row's: above 1 the row is faster"),
         csv("ratio to reference")},
        {ratio_group, ratio_key::low, end_of_interval(&FactorInterval::low),
         recorded("positive", optional,
                  "of the interval, of samples or over runs; left out where a row has fewer than 5 samples"),
         csv({.title = "low", .key = "ratio_low"})},
        {ratio_group, ratio_key::high, end_of_interval(&FactorInterval::high), recorded("positive"),
         csv({.title = "high", .key = "ratio_high"})},
        {ratio_group, "confidence",
         [](const Comparison& comparison) {
             const bool has_any = comparison.interval && (comparison.runs == 1 || comparison.runs >= resampled_runs);
             return has_any ? std::optional(ratio_confidence) : std::nullopt;
         },
         recorded(R"({ "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1 })", optional,
                  "left out of 2 to 4 runs, whose interval is the range of their ratios")},
        {ratio_group, "runs",
         [](const Comparison& comparison) { return comparison.runs > 1 ? json(comparison.runs) : json(); },
         recorded(R"({ "type": "integer", "minimum": 2 })", optional,
                  "that the interval spans; left out if it is of the samples of one run")},
        {ratio_group, ratio_key::reference,
         [](const Comparison& comparison) { return row_name(comparison.reference->key); }, recorded("line", required),
         csv("reference")},
    };
}

std::vector<RowField> bvh_fields()
{
    return {
        {"", "best_bvh_comparison", of_best_bvh(&ratio_with_interval),
         rates({.title = "x best BVH", .key = "ratio_to_best_bvh"})},
        {row_key::best_bvh, of_best_bvh([](const Comparison& best) { return row_name(best.reference->key); }),
         recorded(
             "line", optional,
             "the fastest row of a BVH that traced the same rays on the same device: on the host ours under openmp "
             "and Embree's, on a GPU those of all its APIs, on an emulated device its own"),
         csv("best BVH")},
        {row_key::ratio_to_best_bvh, of_best_bvh([](const Comparison& best) { return best.ratio; }),
         recorded("positive", optional, "that BVH's median device seconds over the row's: above 1 the row is faster"),
         csv("ratio to best BVH")},
        {row_key::ratio_to_best_bvh_low, [](const RowFacts& facts) { return bvh_end(facts, &FactorInterval::low); },
         recorded("positive", optional, "of its interval, as in tetrace.ratios"), csv("low")},
        {row_key::ratio_to_best_bvh_high, [](const RowFacts& facts) { return bvh_end(facts, &FactorInterval::high); },
         recorded("positive"), csv("high")},
        {"rates", "ratio_to_single", &RowFacts::ratio_to_single,
         recorded("positive", optional, "to Embree's single rays on the same scene, same run; of rows on the host"),
         csv("ratio to Embree single"), rates({.title = "x single", .rank = 4})},
        {"", "build_paid", &paid_text, rates({.title = "build paid", .rank = 7})},
        {"break_even", "paid", [](const PaidBuild& paid) { return name_of(paid.when); },
         recorded(R"({ "enum": ["at once", "later", "never", "unclear"] })", required,
                  "when building the tets has paid against rates.best_bvh, both builds counted; never: the row is "
                  "slower; unclear: the interval of the ratio contains 1"),
         csv({.title = "build paid", .key = "build_paid"})},
        {"break_even", "grays", if_later(&PaidBuild::rays, 1e-9),
         recorded("positive", optional, "billions of rays after which it has"),
         csv({.title = "break-even", .unit = "Grays", .decimals = 3, .key = "break_even_grays"})},
        {"break_even", "tracing_s", if_later(&PaidBuild::tracing_s, 1),
         recorded("positive", optional, "seconds that the row takes to trace them"),
         csv({.title = "break-even", .unit = "s", .decimals = 3, .key = "break_even_s"})},
    };
}

} // namespace

std::vector<RowField> comparison_fields()
{
    std::vector<RowField> fields = reference_fields();
    for (RowField& field : bvh_fields())
        fields.push_back(std::move(field));
    return fields;
}

} // namespace tetrace
