#pragma once

#include "bench/measuring/row_devices.h"
#include "bench/measuring/journal.h"

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

} // namespace tetrace
