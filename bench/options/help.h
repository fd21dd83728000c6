#pragma once

#include "bench/options/options.h"

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace tetrace {

/// The help of a verb, without its options.
struct VerbHelp {
    Verb verb;
    const char* summary;
    const char* description; ///< paragraphs, with an empty line between
    const char* examples;    ///< lines
};

/// One entry per verb, in the order in which help lists them.
[[nodiscard]] std::span<const VerbHelp> verb_helps();

/// What the program's exit codes mean.
inline constexpr std::pair<int, const char*> exit_code_meanings[] = {
    {0, "good"},
    {1, "a wrong result, a regression, or a driver that failed, crashed or hung"},
    {2, "a command line, a mesh or another input that is not accepted"},
    {3, "something required is missing or not supported here"},
    {4, "an internal error"}};

/// Topics of help that are not verbs.
inline constexpr std::string_view other_topics[] = {"options", "man", "bash", "zsh", "fish"};

/// What `tetrace help TOPIC` prints: the program (empty topic), a verb, "options", the Markdown table of all options,
/// or what manual.h and completion.h make. whole: of a verb everything, in place of its first_page().
[[nodiscard]] std::string help_text(const std::string& topic, bool whole = false);

/// A verb's help in one screen: usage, the usual options, an example, exit codes.
[[nodiscard]] std::string first_page(const VerbHelp& help, std::size_t width);
/// "Usage: tetrace compare A.json B.json [OPTION]...".
[[nodiscard]] std::string usage_of(Verb verb);

/// The program's version, commit, compiler, libraries and licence.
[[nodiscard]] std::string version_text();

} // namespace tetrace
