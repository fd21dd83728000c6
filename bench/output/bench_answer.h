#pragma once

#include "bench/output/bench_report.h"

namespace tetrace {

/// What a run found, in three lines: the fastest row of each scene; CDT compared with BVH, and each API with openmp;
/// whether to trust the rates. Empty if nothing was timed.
[[nodiscard]] Sheet answer_of(const BenchResult& result);

/// What says whether a run's rates are to be trusted.
struct Steadiness {
    std::optional<MachineLoad> load = {}; ///< empty if the system does not tell
    std::vector<Pulse> pulses = {};
    std::size_t timed = 0, noisy = 0, disturbed = 0; ///< rows

    void count(const RowRecord& row);
};

/// Whether to trust them, as a sentence. Precondition: a row was timed.
[[nodiscard]] std::string trust_text(const Steadiness& all);

} // namespace tetrace
