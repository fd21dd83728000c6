#include "bench/measuring/conformity.h"

#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

Conformity compared_conformity(const RowRecord& row, const Traced& result)
{
    if (result.different > 0) return Conformity::wrong;
    if (row.self_test && !row.self_test->is_exact()) return Conformity::not_exact;
    return result.inexact == 0 ? Conformity::bit_exact : Conformity::within_ulps;
}

/// For rows that are not compared with openmp's answer.
Conformity own_conformity(const RowRecord& row)
{
    const KernelId& kernel = row.key.kernel;
    const bool is_reference = is_portable(kernel) && kernel.math == MathMode::exact;
    if (is_reference && row.self_test && !row.self_test->is_exact()) return Conformity::not_exact;
    return is_reference ? Conformity::reference : Conformity::uncompared;
}

/// "contracts" of "contracts; division correctly rounded, denormals kept".
std::string defects(const SelfTest& test)
{
    const std::string text = test.text();
    return text.substr(0, text.find(';'));
}

std::string oracle_text(const RowRecord& row)
{
    const Verdicts& verdicts = traced(row)->verdicts;
    if (verdicts.clean()) return "ok";
    return fmt::format("{}: {}", name_of(status_of(row)), counted(verdicts.wrong + verdicts.lost, "ray", "rays"));
}

} // namespace

Conformity conformity_of(const RowRecord& row)
{
    if (const Traced* result = traced(row))
        return result->compared ? compared_conformity(row, *result) : own_conformity(row);
    switch (status_of(row)) {
    case Status::wrong: return Conformity::wrong;
    case Status::unsupported: return Conformity::unsupported;
    case Status::skipped: return Conformity::skipped;
    default: return Conformity::error;
    }
}

namespace {

std::string text_of_one(const RowRecord& row)
{
    const Conformity conformity = conformity_of(row);
    const Traced* result = traced(row);
    switch (conformity) {
    case Conformity::within_ulps: return fmt::format("within {} ulp", result->max_ulps);
    case Conformity::not_exact: return "not exact: " + defects(*row.self_test);
    case Conformity::wrong: return result != nullptr ? "wrong: " + counted(result->different, "ray", "rays") : "wrong";
    case Conformity::uncompared: return oracle_text(row);
    default: return std::string(name_of(conformity));
    }
}

/// How often a row that differs between repetitions showed its worst.
struct Rate {
    Finding worst;
    std::size_t count, of;
};

std::optional<Rate> rate_of(const RowRecord& row)
{
    const auto& all = row.repeated;
    if (all.empty() || std::ranges::count(all, all.front()) == std::ssize(all)) return std::nullopt;
    const Finding worst = *std::ranges::max_element(all);
    return Rate{worst, static_cast<std::size_t>(std::ranges::count(all, worst)), all.size()};
}

std::uint64_t hash_of_hits(const RowRecord& row)
{
    const Traced* const result = traced(row);
    return result != nullptr ? result->views_hash : 0;
}

} // namespace

std::string conformity_text(const RowRecord& row)
{
    const auto rate = rate_of(row);
    if (!rate) return text_of_one(row);
    const char* const what = rate->worst == Finding::other_answers ? "other answers " : "";
    return fmt::format("{}, {}in {} of {}", text_of_one(row), what, rate->count, rate->of);
}

std::string rate_text(const RowRecord& row)
{
    const auto rate = rate_of(row);
    return rate ? fmt::format("{} in {} of {}", name_of(rate->worst), rate->count, rate->of) : std::string();
}

Finding finding_of(const RowRecord& row, bool flawed_passes)
{
    if (const auto rate = rate_of(row)) return rate->worst;
    const Finding shown = value_named<Finding>(name_of(conformity_of(row))).value();
    return !fails(shown) && fails_check(row, flawed_passes) ? Finding::flawed : shown;
}

namespace {

RowRecord combined_row(const std::vector<const RowRecord*>& repetitions, bool flawed_passes)
{
    std::vector<const RowRecord*> rows;
    std::ranges::copy_if(repetitions, std::back_inserter(rows),
                         [&](const RowRecord* row) { return finding_of(*row, flawed_passes) != Finding::skipped; });
    if (rows.empty()) return *repetitions.front();
    std::vector<Finding> shown;
    for (const RowRecord* row : rows) {
        const Finding own = finding_of(*row, flawed_passes);
        const bool is_other =
            !shown.empty() && !fails(own) && own == shown.front() && hash_of_hits(*row) != hash_of_hits(*rows.front());
        shown.push_back(is_other ? Finding::other_answers : own);
    }
    RowRecord worst = *rows.at(static_cast<std::size_t>(std::ranges::max_element(shown) - shown.begin()));
    worst.repeated = std::move(shown);
    return worst;
}

} // namespace

std::vector<RowRecord> combined_rows(const std::vector<std::vector<RowRecord>>& repetitions, bool flawed_passes)
{
    if (repetitions.size() == 1) return repetitions.front();
    std::vector<RowRecord> combined;
    for (std::size_t i = 0; i < repetitions.front().size(); ++i) {
        std::vector<const RowRecord*> rows;
        for (const auto& repetition : repetitions)
            rows.push_back(&repetition.at(i));
        combined.push_back(combined_row(rows, flawed_passes));
    }
    return combined;
}

bool fails_check(const RowRecord& row, bool flawed_passes)
{
    const Conformity conformity = conformity_of(row);
    const bool is_method_s_own = conformity == Conformity::reference || conformity == Conformity::bit_exact;
    return conformity == Conformity::not_exact || (!is_method_s_own && fails(row, flawed_passes));
}

} // namespace tetrace
