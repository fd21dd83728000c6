#pragma once

#include "bench/reproduce/journal.h"
#include "bench/rows/row_run.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

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
