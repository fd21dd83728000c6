#pragma once

#include "bench/options/option_table.h"

namespace tetrace {

/// Options for those who study one layout, schedule or device; the last heading of each help.
inline constexpr const char* experiments = "Experiments";

// The parts of option_table() that have files of their own, and the verbs that their rows name.

/// OptionRow::verbs of one verb.
[[nodiscard]] constexpr unsigned bit(Verb verb)
{
    return 1u << static_cast<unsigned>(verb);
}

/// Of Usual: all that take the option.
inline constexpr unsigned every_verb = ~0u;
[[nodiscard]] constexpr Usual usual_for(unsigned verbs, const char* line)
{
    return {verbs, line};
}

inline constexpr unsigned measuring = bit(Verb::bench) | bit(Verb::check);
inline constexpr unsigned sharing = measuring | bit(Verb::reproduce);
inline constexpr unsigned tracing = measuring | bit(Verb::render) | bit(Verb::trace);
inline constexpr unsigned reproducing = tracing | bit(Verb::reproduce);
inline constexpr unsigned selecting = tracing | bit(Verb::inspect);
inline constexpr unsigned building = bit(Verb::build) | bit(Verb::dump) | bit(Verb::page) | reproducing;
inline constexpr unsigned reporting = measuring | bit(Verb::build) | bit(Verb::devices) | bit(Verb::scenes) |
                                      bit(Verb::reproduce) | bit(Verb::inspect) | bit(Verb::trace) |
                                      bit(Verb::compare) | bit(Verb::show) | bit(Verb::merge) | bit(Verb::judge);

/// Of `reproduce` alone.
[[nodiscard]] std::vector<OptionRow> reproduce_options();
/// What a check is judged by.
[[nodiscard]] std::vector<OptionRow> expectation_options();
/// What becomes of a result.
[[nodiscard]] std::vector<OptionRow> output_options();
/// How a run is shared among processes.
[[nodiscard]] std::vector<OptionRow> sharing_options();
// Of verbs for those who look into a kernel (debugging_options.cpp).
[[nodiscard]] std::vector<OptionRow> inspect_options();
[[nodiscard]] std::vector<OptionRow> trace_options();
/// Of `rays` and `judge`.
[[nodiscard]] std::vector<OptionRow> mesh_ray_options();

} // namespace tetrace
