#include "bench/options/help.h"
#include "bench/options/option_table.h"
#include "bench/options/option_values.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

constexpr std::size_t text_column = 24; ///< in which the lines of options begin

/// A head, and text to its right.
std::string in_columns(const std::string& head, const std::string& text, std::size_t width)
{
    const std::string lines = wrapped(text, width, text_column);
    return head.size() < text_column ? fmt::format("{:<{}}", head, text_column) + lines.substr(text_column)
                                     : head + "\n" + lines;
}

bool is_usual(const OptionRow& row, Verb verb)
{
    return takes(verb, row) && (row.usual.verbs >> static_cast<unsigned>(verb) & 1u) != 0;
}

std::string usual_options(Verb verb, std::size_t width)
{
    std::string text;
    for (const OptionRow& row : option_table())
        if (is_usual(row, verb))
            text += in_columns(fmt::format("  {} {}", row.name, is_option(row) ? row.value : ""),
                               fmt::format(fmt::runtime(row.usual.line), join_alternatives(row.apply.names())), width);
    return text;
}

/// The first line that is of the verb, without what explains it to its right.
std::string_view example_of(const VerbHelp& help)
{
    std::string_view lines = help.examples;
    lines.remove_prefix(lines.find(fmt::format("tetrace {}", name_of(help.verb))));
    return lines.substr(0, std::min(lines.find('\n'), lines.find("  ")));
}

std::string exit_code_line()
{
    std::string text;
    for (const auto& [code, meaning] : exit_code_meanings)
        append_item(text, "; ", fmt::format("{} {}", code, meaning));
    return text + ".";
}

} // namespace

std::string usage_of(Verb verb)
{
    const FileArguments files = file_arguments(verb);
    std::string words(files.names);
    for (const OptionRow& row : option_table())
        if (!is_option(row) && takes(verb, row)) words = fmt::format("[{}...]", row.name);
    return fmt::format("Usage: tetrace {} {}{}{}", name_of(verb), words, words.empty() ? "" : " ",
                       verb == Verb::help ? "[VERB [all] | options | man | bash | zsh | fish]" : "[OPTION]...");
}

std::string first_page(const VerbHelp& help, std::size_t width)
{
    const std::string_view description = help.description;
    const std::size_t sentence = std::min(description.find(". "), description.find(".\n"));
    const std::string options = usual_options(help.verb, width);
    return fmt::format("{}\n\n{}\n{}{}{}{}{}", usage_of(help.verb),
                       wrapped(std::string(description.substr(0, sentence)) + ".", width, 0), options,
                       options.empty() ? "" : "\n", in_columns("Example", std::string(example_of(help)), width),
                       in_columns("Exit codes", exit_code_line(), width),
                       in_columns("All options", fmt::format("tetrace help {} all", name_of(help.verb)), width));
}

} // namespace tetrace
