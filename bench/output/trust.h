#pragma once

#include "bench/measuring/machine_load.h"
#include "bench/measuring/pulse.h"
#include "bench/options/host_conditions.h"
#include "bench/results/result_value.h"
#include "bench/rows/row_record.h"

#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What says whether a run's rates are to be trusted.
struct Steadiness {
    std::optional<MachineLoad> load = {}; ///< empty if the system does not tell
    std::vector<Pulse> pulses = {};
    HostConditions conditions = {};
    std::size_t timed = 0, noisy = 0, disturbed = 0; ///< rows

    void count(const RowRecord& row);
};

/// Whether to trust them, as a sentence. Precondition: a row was timed.
[[nodiscard]] std::string trust_text(const Steadiness& all);

/// A result's `load`, `pulses` and `conditions`, and how many of its rows and searches were timed, noisy and disturbed.
[[nodiscard]] Steadiness read_steadiness(const ResultValue& section);

} // namespace tetrace
