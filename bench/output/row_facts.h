#pragma once

#include "bench/measuring/comparison.h"
#include "bench/measuring/figures.h"
#include "bench/measuring/row_devices.h"

namespace tetrace {

/// The sources of a row's fields: its record, and what is computed from it and from other rows. Refers to the record.
struct RowFacts {
    explicit RowFacts(const RowRecord& record) : row(&record), figures(figures_of(record)) {}

    const RowRecord* row;
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

} // namespace tetrace
