#pragma once

#include "bench/measuring/row_devices.h"
#include "bench/reproduce/journal.h"

namespace tetrace {

/// The yardsticks of a run's devices, kept in its journal: what is repeated from it stands beside the same bandwidth.
class Yardsticks {
public:
    /// journal: may be null. Throws Error{usage} where one of its yardsticks is damaged.
    explicit Yardsticks(Journal* journal);

    /// As measure_devices(); a yardstick that the journal has is taken from there, another one goes into it.
    void measure(std::vector<RowDevice>& devices, const SessionOptions& options);

private:
    Journal* journal_;
    std::map<std::string, Yardstick> known_; ///< by the device's name in tables
};

} // namespace tetrace
