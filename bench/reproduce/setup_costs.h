#pragma once

#include "bench/reproduce/journal.h"
#include "bench/rows/row_run.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What a row pays once, before its first ray, and what it occupies from then on. Compiling kernels and copying to the
/// device are left out: they are the API's, not the structure's.
struct SetupCost {
    double build_s = 0;      ///< TetGen, the BVH's builder, Embree, or a GPU's driver
    double pack_s = 0;       ///< from what was built to the bytes that cross; none of Embree
    std::uint64_t bytes = 0; ///< of the session

    [[nodiscard]] double once_s() const { return build_s + pack_s; }
};

/// Of a row whose session is open; empty for another one.
[[nodiscard]] std::optional<SetupCost> setup_cost(const RowRun& row);

/// The set-up costs of a run's rows, kept in its journal: what is repeated from it stands beside the same build times.
class SetupCosts {
public:
    /// journal: may be null. Throws Error{usage} where one of its costs is damaged.
    explicit SetupCosts(Journal* journal);

    /// Row by row as setup_cost() of rows just opened; what the journal has is taken from there, the rest goes into it.
    [[nodiscard]] std::vector<std::optional<SetupCost>> of(const std::vector<RowRun>& rows);

private:
    Journal* journal_;
    std::map<std::string, SetupCost> known_; ///< by the row's name
};

} // namespace tetrace
