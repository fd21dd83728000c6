#pragma once

#include "bench/results/result_file.h"

#include <optional>
#include <string>

namespace tetrace {

/// What shows whether the machine kept its speed while a row was timed.
struct RatePulse {
    std::optional<double> ratio;  ///< of calibration during the row's samples to its run's fastest
    std::optional<double> host_s; ///< the run's fastest pulse of the host, of rows on the host; empty where not taken

    /// Whether the rate is noisy because of calibration: noisy_pulse (bench/statistics/statistics.h) or more.
    [[nodiscard]] bool is_noisy() const;
};

[[nodiscard]] RatePulse pulse_of(const ResultHead& head, const ResultRow& row);

/// Why the machine, and not the row, may have changed between two rates: "NOISY" for `compare` and for the page of a
/// folder. Empty if nothing says so. same_machine: with as many threads; of others the comparison is to tell.
/// names: of the two, as in "in A the pulse ...".
[[nodiscard]] std::string disturbance_between(const RatePulse& before, const RatePulse& after, bool same_machine,
                                              const std::string& before_name = "A",
                                              const std::string& after_name = "B");

} // namespace tetrace
