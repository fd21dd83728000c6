#pragma once

#include <cstdint>

namespace tetrace {

/// Expects how long the optimiser's rounds still take: gains of rounds, and their times, fall about geometrically.
class Forecast {
public:
    /// elapsed_s: since the first round began. gain: by which the round lowered the cost.
    void end_round(double elapsed_s, double gain);

    /// Seconds until a round gains less than `enough`, or `max_rounds` more are done.
    /// share_of_round: how much of the current one is done, in [0, 1].
    [[nodiscard]] double left_s(double elapsed_s, double share_of_round, double enough, std::uint32_t max_rounds) const;

private:
    double begin_s_ = 0;                         ///< of the current round
    double last_s_ = 0, last_gain_ = 0;          ///< of the last round; 0 before there is one
    double time_ratio_ = 0.6, gain_ratio_ = 0.3; ///< of a round to the one before; first those of bunny
};

} // namespace tetrace
