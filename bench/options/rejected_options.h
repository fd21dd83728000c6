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

/// What CLI11 says of an option without its value ("--scene: 1 required"), in our words.
[[nodiscard]] std::string without_value(Verb verb, const std::string& problem);

/// Throws Error{usage}: the word is not a verb. verbs: their names.
[[noreturn]] void reject_verb(const std::string& word, std::vector<std::string> verbs);

/// Throws Error{usage} with the reason and the accepted options.
[[noreturn]] void reject_command_line(Verb verb, const std::string& reason);

} // namespace tetrace
