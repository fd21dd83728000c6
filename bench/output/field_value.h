#pragma once

#include "bench/measuring/comparison.h"
#include "bench/measuring/figures.h"
#include "bench/measuring/row_devices.h"
#include "bench/results/result_file.h"
#include "bench/results/result_value.h"

#include <functional>
#include <nlohmann/json.hpp>
#include <type_traits>

namespace tetrace {

/// What a result says of itself, for its rows.
struct RunOrigin {
    /// section: `tetrace` of a result. Throws Error{invalid_input} as read_result() does.
    explicit RunOrigin(const ResultValue& section) : head(read_head(section)), scenes(read_scenes(section)) {}

    ResultHead head;
    std::vector<ResultScene> scenes;
};

/// The sources of a row's fields: its record, and what is computed from it and from other rows. Refers to the record.
struct RowFacts {
    explicit RowFacts(const RowRecord& record) : row(&record), figures(figures_of(record)) {}

    const RowRecord* row;
    std::optional<Figures> figures;
    // Set only by `bench`, which has all rows and devices.
    std::optional<Comparison> comparison;
    std::optional<Comparison> best_bvh; ///< with the fastest BVH of its contest
    std::optional<PaidBuild> paid_build;
    std::optional<double> ratio_to_single;
    std::optional<CopyShares> copy_shares;
    // Set only by `check`.
    std::optional<std::string> conformity;
    const RunOrigin* origin = nullptr; ///< set only for CSV
};

/// How a field is read from a part of a row, or from a member of that part. If it is a member, or has set(), a result's
/// value can be written back into the part.
template <class Access, class Part>
concept Settable = (std::is_member_object_pointer_v<Access> && std::is_invocable_v<Access, Part&>) ||
                   requires(const Access& access, Part& part, const ResultValue& value)
{
    access.set(part, value);
};

template <class Access, class Part>
void set_field(const Access& access, Part& part, const ResultValue& value)
{
    if constexpr (std::is_member_object_pointer_v<Access>)
        read_into(part.*access, value);
    else
        access.set(part, value);
}

/// A field of a row: how it is read from the row's facts and, of what a record holds, written into a record. It is
/// built from an access to one part of a row: RowKey, RowRecord, RowSetup, Traced, Visits, GpuSummary; or one that is
/// only read: RowFacts, Figures, CopyShares, PaidBuild or Comparison (with the row's reference). The field has no value
/// (null) if the row lacks the part, and if an optional result is empty.
class FieldValue {
public:
    template <class Access>
    FieldValue(Access access)
        : read_([access](const RowFacts& facts) {
              const auto* const part = part_of<Access>(facts);
              return part != nullptr ? json_of(std::invoke(access, *part)) : nlohmann::json();
          })
    {
        if constexpr (is_written<Access>)
            write_ = [access](RowRecord& row, const ResultValue& value) {
                if (auto* const part = part_of<Access>(row)) set_field(access, *part, value);
            };
    }
    [[nodiscard]] nlohmann::json operator()(const RowFacts& facts) const { return read_(facts); }

    /// Whether a record holds the field, so that set() writes it.
    [[nodiscard]] bool is_stored() const { return write_ != nullptr; }
    /// Writes a result's value into the record; of what is computed, nothing.
    void set(RowRecord& row, const ResultValue& value) const
    {
        if (write_) write_(row, value);
    }

private:
    template <class T>
    static nlohmann::json json_of(const std::optional<T>& value)
    {
        return value ? nlohmann::json(*value) : nlohmann::json();
    }
    template <NamedEnum Enum>
    static nlohmann::json json_of(Enum value)
    {
        return name_of(value);
    }
    static nlohmann::json json_of(nlohmann::json value) { return value; }

    template <class Access, class Part>
    static constexpr bool takes = std::is_invocable_v<Access, const Part&>;

    template <class Part>
    static const Part* pointer_to(const std::optional<Part>& part)
    {
        return part ? &*part : nullptr;
    }

    /// The part that the access takes; null if the row has none.
    template <class Access>
    static auto part_of(const RowFacts& facts)
    {
        const Traced* const result = traced(*facts.row);
        if constexpr (takes<Access, RowFacts>)
            return &facts;
        else if constexpr (takes<Access, RowKey>)
            return &facts.row->key;
        else if constexpr (takes<Access, RowRecord>)
            return facts.row;
        else if constexpr (takes<Access, RowSetup>)
            return &facts.row->setup;
        else if constexpr (takes<Access, Traced>)
            return result;
        else if constexpr (takes<Access, Visits>)
            return result && result->visits.rays > 0 ? &result->visits : nullptr;
        else if constexpr (takes<Access, GpuSummary>)
            return pointer_to(facts.row->gpu);
        else if constexpr (takes<Access, Figures>)
            return pointer_to(facts.figures);
        else if constexpr (takes<Access, CopyShares>)
            return pointer_to(facts.copy_shares);
        else if constexpr (takes<Access, PaidBuild>)
            return pointer_to(facts.paid_build);
        else {
            static_assert(takes<Access, Comparison>, "a field is read from a part of a row");
            return pointer_to(facts.comparison);
        }
    }

    /// Those that a record holds; visits are of all its rays.
    template <class Access>
    static auto part_of(RowRecord& row)
    {
        Traced* const result = std::get_if<Traced>(&row.outcome);
        if constexpr (takes<Access, RowKey>)
            return &row.key;
        else if constexpr (takes<Access, RowRecord>)
            return &row;
        else if constexpr (takes<Access, RowSetup>)
            return &row.setup;
        else if constexpr (takes<Access, Traced>)
            return result;
        else if constexpr (takes<Access, Visits>) {
            if (result != nullptr) result->visits.rays = result->totals.rays;
            return result != nullptr ? &result->visits : nullptr;
        } else if constexpr (takes<Access, GpuSummary>)
            return row.gpu ? &*row.gpu : &row.gpu.emplace();
        else
            return static_cast<const Figures*>(nullptr); // of what is computed
    }

    template <class Access>
    using Written = std::remove_pointer_t<decltype(part_of<Access>(std::declval<RowRecord&>()))>;
    template <class Access>
    static constexpr bool is_written = !std::is_const_v<Written<Access>> && Settable<Access, Written<Access>>;

    std::function<nlohmann::json(const RowFacts&)> read_;
    std::function<void(RowRecord&, const ResultValue&)> write_;
};

/// See in().
template <class Part, class Member, class Inner>
struct InMember {
    Member Part::*member;
    Inner inner;

    auto operator()(const Part& part) const { return std::invoke(inner, part.*member); }
    void set(Part& part, const ResultValue& value) const requires Settable<Inner, Member>
    {
        set_field(inner, part.*member, value);
    }
};
/// What another access reads of a member: in(&Traced::verdicts, &Verdicts::wrong).
template <class Part, class Member, class Inner>
[[nodiscard]] InMember<Part, Member, Inner> in(Member Part::*member, Inner inner)
{
    return {member, inner};
}

/// See if_any().
template <class Part, class Value>
struct MemberIfAny {
    Value Part::*member;

    auto operator()(const Part& part) const
    {
        return part.*member == Value() ? std::nullopt : std::optional(part.*member);
    }
    void set(Part& part, const ResultValue& value) const { read_into(part.*member, value); }
};
/// A member whose value is unknown if it is 0, false, or empty.
template <class Part, class Value>
[[nodiscard]] MemberIfAny<Part, Value> if_any(Value Part::*member)
{
    return {member};
}

/// See both().
template <class Get, class Set>
struct GetAndSet {
    Get get;
    Set put;

    template <class Part>
    auto operator()(const Part& part) const requires std::is_invocable_v<Get, const Part&>
    {
        return get(part);
    }
    template <class Part>
    void set(Part& part, const ResultValue& value) const requires std::is_invocable_v<Set, Part&, const ResultValue&>
    {
        put(part, value);
    }
};
/// What two functions read and write.
template <class Get, class Set>
[[nodiscard]] GetAndSet<Get, Set> both(Get get, Set set)
{
    return {get, set};
}

} // namespace tetrace
