#pragma once

#include "core/base/enum_names.h"
#include "core/pack/kernel_id.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// Walks through tets of which the fastest is asked for.
enum class Walk {
    half32,  ///< project on half32, one ray at a time
    tet64,   ///< project on tet64, one ray at a time
    maria,   ///< the paper's method, one ray at a time
    packets, ///< project on half32 in packets
    single,  ///< every walk of one ray at a time
    any
};
template <>
inline constexpr auto enum_names<Walk> = names_up_to<Walk::any>("half32", "tet64", "maria", "packets",
                                                                "the fastest walk of one ray at a time",
                                                                "the fastest walk");

/// BVHs that walks are compared with; the fastest of them represents all.
enum class Rival {
    our_single,    ///< our BVHs, which trace one ray at a time, in every form
    embree_single, ///< Embree's single rays
    embree,        ///< Embree's, with every entry point
    single,        ///< every BVH that is traced one ray at a time
    any            ///< every BVH of the device, with every entry point
};
template <>
inline constexpr auto enum_names<Rival> = names_up_to<Rival::any>("our fastest BVH", "Embree's single rays",
                                                                  "Embree's fastest entry point",
                                                                  "the fastest BVH of one ray at a time",
                                                                  "the fastest BVH of the device");

/// Whether a kernel traces one ray at a time: all but our packets, and Embree's packets and streams.
[[nodiscard]] bool is_single_ray(const KernelId& kernel);

[[nodiscard]] bool is_of(const KernelId& kernel, Walk walk);
[[nodiscard]] bool is_of(const KernelId& kernel, Rival rival);
[[nodiscard]] bool is_of(const KernelId& kernel, Layout layout);

// What Row, a template parameter, needs: mrays_of(row), empty without a rate, and kernel_of(row).

/// The row with the highest rate; null if none has a rate.
template <class Row>
[[nodiscard]] const Row* fastest(const std::vector<const Row*>& rows)
{
    const Row* found = nullptr;
    double rate = 0;
    for (const Row* row : rows)
        if (const std::optional<double> mrays = mrays_of(*row); mrays && *mrays > rate) {
            found = row;
            rate = *mrays;
        }
    return found;
}

/// Rows that may be ranked with each other: they traced the same rays of one scene on one device.
template <class Row>
struct Contest {
    std::vector<const Row*> rows; ///< at least one

    /// The rows of a kind: a Walk, a Rival or a Layout.
    template <class Kind>
    [[nodiscard]] std::vector<const Row*> of(Kind kind) const
    {
        std::vector<const Row*> found;
        for (const Row* row : rows)
            if (is_of(kernel_of(*row), kind)) found.push_back(row);
        return found;
    }
    /// Null if none of the kind has a rate.
    template <class Kind>
    [[nodiscard]] const Row* fastest(Kind kind) const
    {
        return tetrace::fastest(of(kind));
    }
    /// How every printed ratio of tets to a BVH calls the BVH: "the fastest BVH, bvh packet16 on embree", or only "bvh
    /// bvh2 on openmp" if the contest has a faster one. No ratio is printed without it, so that none hides which BVH it
    /// is over. label: the BVH's.
    [[nodiscard]] std::string bvh_text(const Row& bvh, const std::string& label) const
    {
        return (fastest(Rival::any) == &bvh ? "the fastest BVH, " : "") + label;
    }
};

/// The contests of rows, in the order of their first ones. same(a, b): whether two rows are of one contest.
template <class Row, class Same>
[[nodiscard]] std::vector<Contest<Row>> contests_of(const std::vector<const Row*>& rows, const Same& same)
{
    std::vector<Contest<Row>> contests;
    for (const Row* row : rows) {
        auto contest = contests.begin();
        while (contest != contests.end() && !same(*contest->rows.front(), *row))
            ++contest;
        if (contest == contests.end()) contest = contests.insert(contest, Contest<Row>());
        contest->rows.push_back(row);
    }
    return contests;
}

} // namespace tetrace
