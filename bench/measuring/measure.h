#pragma once

#include "bench/measuring/row_recorder.h"
#include "bench/options/benchmark_flags.h"

#include <optional>
#include <vector>

namespace tetrace {

/// Result of the timed part; the samples are in the rows.
struct Measurement {
    unsigned samples = 0; ///< per row and run; noisy rows may have more
    unsigned runs = 1;
    bool lowered = false; ///< fewer than asked for, because of the budget
    double wall_s = 0;
    std::optional<MachineLoad> load; ///< while warming up and timing; empty if the system does not tell
    std::vector<Pulse> pulses;       ///< of the host and of each GPU
};

/// Number of samples that fit the budget: the number asked for, or fewer, but at least 5 where at least 5 were asked
/// for. sweep_s: expected seconds for one sample of every row. left_s: of the budget.
[[nodiscard]] unsigned affordable_samples(unsigned asked, double sweep_s, double left_s);

/// Takes samples of every row that is ok or flawed, with Google Benchmark, interleaved at random, after an untimed pass
/// of each: those on GPUs with each other, then those on the host, so that no GPU rests while a processor works. One
/// sample traces all selected views, in one launch or in as few as memory allows (joined_views()), again and again for
/// --sample-time; its seconds are the device's, per pass. Unless --samples is given, a row that is noisy then gets up
/// to three times as many samples, while the budget lasts. The hits of each view in the last sample must still equal
/// the verified ones. Some samples are followed by a pass with a launch for each view (latency_passes()). Rows that
/// fail end with their reason, and so do rows for which the budget has no time. GPUs are asked for their clocks, power
/// and throttling during each sample (see Sampler). Meanwhile the pulse is taken, and rows learn what it says of their
/// rates. Writes the file of --benchmark_out. With options.runs above 1 all of it is done that often, each time with
/// new sessions. After an interrupt, rows with 5 samples or more, or with all, keep them; the others have none. shared:
/// a watch; and a journal, which gets the samples now and then, or has some already, which are not taken again. Throws
/// Error{invalid_input} if that file, or what Google Benchmark prints, cannot be written, Error{usage} if the journal
/// is damaged.
[[nodiscard]] Measurement measure_rows(std::vector<RowRun>& rows, const Options& options, const BenchmarkFlags& flags,
                                       const Recording& shared);
/// The same without a journal. host: the work of its pulse; openmp::pulse_s() where it is empty. find_monitor: of a
/// row's GPU.
[[nodiscard]] Measurement measure_rows(std::vector<RowRun>& rows, const Options& options, const BenchmarkFlags& flags,
                                       Budget& budget = no_budget(), const Pulses::Work& host = {},
                                       const FindMonitor& find_monitor = find_gpu_monitor);

} // namespace tetrace
