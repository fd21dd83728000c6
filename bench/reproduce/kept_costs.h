#pragma once

#include "bench/measuring/journal.h"
#include "bench/measuring/row_devices.h"
#include "bench/rows/row_run.h"

#include <map>
#include <string>
#include <vector>

namespace tetrace {

/// The microbenchmarks of a run's devices, kept in its journal, so that a resumed run reports the same bandwidth.
class Yardsticks {
public:
    /// journal: may be null. Throws Error{usage} if one of its microbenchmarks is damaged.
    explicit Yardsticks(Journal* journal);

    /// As measure_devices(); microbenchmarks that are in the journal are taken from there, the others are added to it.
    void measure(std::vector<RowDevice>& devices, const SessionOptions& options);

private:
    Journal* journal_;
    std::map<std::string, Yardstick> known_; ///< by the device's name in tables
};

/// The set-up costs of a run's rows, kept in its journal, so that a resumed run reports the same build times.
class SetupCosts {
public:
    /// journal: may be null. Throws Error{usage} if one of its costs is damaged.
    explicit SetupCosts(Journal* journal);

    /// Gives rows that were just opened the costs that the journal has of them; others are added to it.
    void restore(std::vector<RowRun>& rows);

private:
    Journal* journal_;
    std::map<std::string, SetupCost> known_; ///< by the row's name
};

} // namespace tetrace
