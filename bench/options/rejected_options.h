#pragma once

#include "bench/options/options.h"

#include <string>
#include <vector>

namespace tetrace {

/// The names of a verb's options, as messages list them.
[[nodiscard]] std::vector<std::string> accepted_options(Verb verb);

/// Of what CLI11 could not place: the first unknown option, with what it may have been meant to be, or else the first
/// word. arguments: of the verb.
[[nodiscard]] std::string not_accepted(Verb verb, const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& unplaced);

/// Throws Error{usage} with the reason and the accepted options.
[[noreturn]] void reject_command_line(Verb verb, const std::string& reason);

} // namespace tetrace
