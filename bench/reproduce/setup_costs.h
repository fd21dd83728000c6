#pragma once

#include "bench/reproduce/journal.h"
#include "bench/rows/row_run.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What a row pays once, before its first ray, and the memory that it occupies from then on. Compiling kernels and
/// copying to the device are left out: they are costs of the API, not of the structure.
struct SetupCost {
    double build_s = 0;      ///< TetGen, the BVH's builder, Embree, or a GPU's driver
    double pack_s = 0;       ///< from the built structure to the bytes that are copied; none for Embree
    std::uint64_t bytes = 0; ///< of the session

    [[nodiscard]] double once_s() const { return build_s + pack_s; }
};

/// The set-up cost of a row whose session is open; empty for other rows.
[[nodiscard]] std::optional<SetupCost> setup_cost(const RowRun& row);

/// The set-up costs of a run's rows, kept in its journal, so that a resumed run reports the same build times.
class SetupCosts {
public:
    /// journal: may be null. Throws Error{usage} where one of its costs is damaged.
    explicit SetupCosts(Journal* journal);

    /// Row by row, the setup_cost() of rows just opened. Costs that are in the journal are taken from there; the others
    /// are added to it.
    [[nodiscard]] std::vector<std::optional<SetupCost>> of(const std::vector<RowRun>& rows);

private:
    Journal* journal_;
    std::map<std::string, SetupCost> known_; ///< by the row's name
};

} // namespace tetrace
