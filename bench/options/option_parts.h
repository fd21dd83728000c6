#pragma once

#include "bench/options/option_table.h"

namespace tetrace {

// The parts of option_table() that have files of their own, and the verbs that their rows name.

[[nodiscard]] constexpr unsigned bit(Verb verb)
{
    return 1u << static_cast<unsigned>(verb);
}

inline constexpr unsigned measuring = bit(Verb::bench) | bit(Verb::check);
inline constexpr unsigned sharing = measuring | bit(Verb::reproduce);
inline constexpr unsigned tracing = measuring | bit(Verb::render);
inline constexpr unsigned reproducing = tracing | bit(Verb::reproduce);
inline constexpr unsigned selecting = tracing | bit(Verb::inspect);
inline constexpr unsigned building = bit(Verb::build) | reproducing;
inline constexpr unsigned reporting = measuring | bit(Verb::build) | bit(Verb::devices) | bit(Verb::scenes) |
                                      bit(Verb::reproduce) | bit(Verb::inspect) | bit(Verb::compare) | bit(Verb::show) |
                                      bit(Verb::merge);

/// What becomes of a result.
[[nodiscard]] std::vector<OptionRow> output_options();
/// How a run is shared among processes.
[[nodiscard]] std::vector<OptionRow> sharing_options();

} // namespace tetrace
