#include "bench/measuring/conformity.h"

#include "bench/terminal/text.h"

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

std::string conformity_text(const RowRecord& row)
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

bool fails_check(const RowRecord& row, bool flawed_passes)
{
    const Conformity conformity = conformity_of(row);
    const bool is_method_s_own = conformity == Conformity::reference || conformity == Conformity::bit_exact;
    return conformity == Conformity::not_exact || (!is_method_s_own && fails(row, flawed_passes));
}

} // namespace tetrace
