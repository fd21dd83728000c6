#pragma once

#include "bench/measuring/comparison.h"
#include "bench/measuring/figures.h"
#include "bench/measuring/row_devices.h"

#include <functional>
#include <nlohmann/json.hpp>

namespace tetrace {

/// The sources of a row's fields. Refers to the row.
struct RowFacts {
    explicit RowFacts(const RowRun& run)
        : row(&run), setup(run.session ? run.session->setup_times() : SetupTimes{}), figures(figures_of(run))
    {
    }

    const RowRun* row;
    SetupTimes setup; ///< all 0 where the row has no session
    std::optional<Figures> figures;
    // Set only by `bench`, which has all rows and devices.
    std::optional<Comparison> comparison;
    std::optional<Comparison> best_bvh; ///< with the fastest BVH of its arena
    std::optional<PaidBuild> paid_build;
    std::optional<double> ratio_to_single;
    std::optional<CopyShares> copy_shares;
    // Set only by `check`.
    std::optional<std::string> conformity;
};

/// Reads a field. It is built from a function of one part of a row, or from a member of that part: RowFacts, RowKey,
/// RowRun, SetupTimes, Traced, Visits, Figures, CopyShares, PaidBuild or Comparison (with the row's reference). The
/// field has no value (null) where the row lacks the part, and where an optional result is empty.
class FieldValue {
public:
    template <class Read>
    FieldValue(Read read) : read_([read](const RowFacts& facts) { return read_from(read, facts); })
    {
    }
    [[nodiscard]] nlohmann::json operator()(const RowFacts& facts) const { return read_(facts); }

private:
    template <class T>
    static nlohmann::json json_of(const std::optional<T>& value)
    {
        return value ? nlohmann::json(*value) : nlohmann::json();
    }
    static nlohmann::json json_of(nlohmann::json value) { return value; }

    template <class Read>
    static nlohmann::json read_from(const Read& read, const RowFacts& facts)
    {
        const auto read_part = [&](const auto* part) {
            return part != nullptr ? json_of(std::invoke(read, *part)) : nlohmann::json();
        };
        const RowRun& row = *facts.row;
        if constexpr (std::is_invocable_v<Read, const RowFacts&>)
            return read_part(&facts);
        else if constexpr (std::is_invocable_v<Read, const RowKey&>)
            return read_part(&row.key);
        else if constexpr (std::is_invocable_v<Read, const RowRun&>)
            return read_part(&row);
        else if constexpr (std::is_invocable_v<Read, const SetupTimes&>)
            return read_part(&facts.setup);
        else if constexpr (std::is_invocable_v<Read, const Traced&>)
            return read_part(traced(row));
        else if constexpr (std::is_invocable_v<Read, const Visits&>)
            return read_part(traced(row) != nullptr && traced(row)->visits.rays > 0 ? &traced(row)->visits : nullptr);
        else if constexpr (std::is_invocable_v<Read, const Figures&>)
            return read_part(facts.figures ? &*facts.figures : nullptr);
        else if constexpr (std::is_invocable_v<Read, const CopyShares&>)
            return read_part(facts.copy_shares ? &*facts.copy_shares : nullptr);
        else if constexpr (std::is_invocable_v<Read, const PaidBuild&>)
            return read_part(facts.paid_build ? &*facts.paid_build : nullptr);
        else {
            static_assert(std::is_invocable_v<Read, const Comparison&>, "a field is read from a part of a row");
            return read_part(facts.comparison ? &*facts.comparison : nullptr);
        }
    }

    std::function<nlohmann::json(const RowFacts&)> read_;
};

/// Reads what `inner` reads of a member: in(&Traced::verdicts, &Verdicts::wrong).
template <class Part, class Member, class Inner>
[[nodiscard]] auto in(Member Part::*member, Inner inner)
{
    return [=](const Part& part) { return std::invoke(inner, part.*member); };
}

/// Reads the name of an enum's value.
template <class Part, class Enum>
[[nodiscard]] auto named(Enum Part::*member)
{
    return [=](const Part& part) { return name_of(part.*member); };
}

/// Reads a number that is unknown where it is 0.
template <class Part>
[[nodiscard]] auto positive(double Part::*member)
{
    return [=](const Part& part) { return part.*member > 0 ? std::optional(part.*member) : std::nullopt; };
}

/// Reads a text or a list that is unknown where it is empty.
template <class Part, class List>
[[nodiscard]] auto unless_empty(List Part::*member)
{
    return [=](const Part& part) { return (part.*member).empty() ? std::nullopt : std::optional(part.*member); };
}

} // namespace tetrace
