#include "bench/options/completion.h"

#include "bench/options/help.h"
#include "bench/options/option_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tetrace {

namespace {

/// In single quotes, for a shell.
std::string in_quotes(std::string_view text)
{
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

/// As zsh's _arguments and _describe take it: colons and brackets have a meaning there.
std::string described(std::string_view text)
{
    std::string result;
    for (const char c : text) {
        if (c == ':' || c == '[' || c == ']' || c == '\\') result += '\\';
        result += c;
    }
    return result;
}

std::string_view first_sentence(std::string_view text)
{
    return text.substr(0, text.find(". "));
}

std::string verb_words()
{
    std::vector<std::string_view> names;
    for (const VerbHelp& verb : verb_helps())
        names.push_back(name_of(verb.verb));
    return fmt::format("{}", fmt::join(names, " "));
}

std::string topics_of_help()
{
    return fmt::format("{} {}", verb_words(), fmt::join(other_topics, " "));
}

/// The words that may follow a verb without an option: tables of `reproduce`, topics of `help`.
std::string words_after(Verb verb)
{
    if (verb == Verb::help) return topics_of_help();
    for (const OptionRow& row : option_table())
        if (!is_option(row) && takes(verb, row)) return fmt::format("{}", fmt::join(row.apply.names(), " "));
    return {};
}

/// The rows of a verb's options.
std::vector<const OptionRow*> rows_of_options(Verb verb)
{
    std::vector<const OptionRow*> rows;
    for (const OptionRow& row : option_table())
        if (is_option(row) && takes(verb, row)) rows.push_back(&row);
    return rows;
}

/// Lines of a bash `case` over "VERB OPTION": what completes the option's value.
std::string bash_values()
{
    std::string cases;
    for (const OptionRow& row : option_table()) {
        if (!is_option(row) || row.value.empty()) continue;
        std::vector<std::string> verbs;
        for (const VerbHelp& verb : verb_helps())
            if (takes(verb.verb, row)) verbs.push_back(fmt::format("'{} {}'", name_of(verb.verb), row.name));
        cases += fmt::format("    {}) words='{}' files={} ;;\n", fmt::join(verbs, "|"),
                             fmt::join(row.apply.names(), " "), row.apply.takes_files() ? "'*'" : "");
    }
    return cases;
}

} // namespace

std::string bash_completion()
{
    std::string options, words;
    for (const VerbHelp& verb : verb_helps()) {
        options += fmt::format("    {}) words='", name_of(verb.verb));
        for (const OptionRow* row : rows_of_options(verb.verb))
            options += row->name + ' ';
        options += "--help --help=all' ;;\n";
        if (const std::string after = words_after(verb.verb); !after.empty())
            words += fmt::format("    {}) words='{}' ;;\n", name_of(verb.verb), after);
        else if (file_arguments(verb.verb).max > 0)
            words += fmt::format("    {}) files='*.json' ;;\n", name_of(verb.verb));
    }
    // Bash makes words of "--option=value" at the "=". In a list, what follows the last comma is completed.
    return fmt::format(R"(# Completes command lines of tetrace in bash.
_tetrace()
{{
    local current=${{COMP_WORDS[COMP_CWORD]}} option= verb=${{COMP_WORDS[1]}} words= files= list=
    ((COMP_CWORD > 2)) && option=${{COMP_WORDS[COMP_CWORD - 1]}}
    if [[ $current == = ]]; then
        option=${{COMP_WORDS[COMP_CWORD - 1]}} current=
    elif [[ $option == = ]]; then
        option=${{COMP_WORDS[COMP_CWORD - 2]}}
    fi
    [[ $option == -o ]] && option=--out
    if ((COMP_CWORD == 1)); then
        words='{} --help --version'
    else
    case "$verb $option" in
{}    *)
        if [[ $current == -* ]]; then
    case $verb in
{}    esac
        else
    case $verb in
{}    esac
        fi ;;
    esac
    fi
    [[ $current == *,* ]] && list=${{current%,*}},
    if [[ -n $files ]]; then compopt -o filenames; else compopt +o default; fi 2> /dev/null
    mapfile -t COMPREPLY < <(
        compgen -P "$list" -W "$words" -- "${{current#"$list"}}"
        [[ -z $files ]] || compgen -P "$list" -f -X "!$files" -- "${{current#"$list"}}"
        [[ -z $files ]] || compgen -P "$list" -d -- "${{current#"$list"}}")
}}
complete -o default -F _tetrace tetrace
)",
                       verb_words(), bash_values(), options, words);
}

namespace {

/// What zsh's _arguments completes a row's value with.
std::string zsh_value(const OptionRow& row)
{
    const std::string names = fmt::format("{}", fmt::join(row.apply.names(), " "));
    const std::string title = described(row.value);
    if (names.empty()) return fmt::format(":{}:{}", title, row.apply.takes_files() ? "_files" : "");
    const std::string one =
        row.list ? fmt::format("_sequence compadd - {}", names) : fmt::format("compadd - {}", names);
    if (!row.apply.takes_files()) return fmt::format(":{}:{{{}}}", title, one);
    return fmt::format(":{}:{{{}; _files}}", title, one);
}

} // namespace

std::string zsh_completion()
{
    std::string verbs, cases;
    for (const VerbHelp& verb : verb_helps()) {
        verbs +=
            fmt::format("        {}\n", in_quotes(fmt::format("{}:{}", name_of(verb.verb), described(verb.summary))));
        cases += fmt::format("    {})\n        _arguments", name_of(verb.verb));
        for (const OptionRow* row : rows_of_options(verb.verb)) {
            const std::string value = row->value.empty() ? "" : zsh_value(*row);
            cases += " \\\n            " +
                     in_quotes(fmt::format("{}{}{}[{}]{}", row->list ? "*" : "", row->name,
                                           row->value.empty() ? "" : "=", described(first_sentence(row->help)), value));
        }
        const std::string words = words_after(verb.verb);
        cases += fmt::format(" \\\n            '--help=-[describe the verb]::all:(all)' {}\n        ;;\n",
                             !words.empty()                      ? fmt::format("'*:word:({})'", words)
                             : file_arguments(verb.verb).max > 0 ? "'*:result:_files -g \"*.json(-.)\"'"
                                                                 : "");
    }
    return fmt::format("#compdef tetrace\n# Completes command lines of tetrace in zsh.\n"
                       "_tetrace()\n{{\n"
                       "    local -a verbs=(\n{}    )\n"
                       "    if ((CURRENT == 2)); then\n        _describe verb verbs\n        return\n    fi\n"
                       "    local verb=$words[2]\n"
                       "    shift words\n    ((CURRENT--))\n"
                       "    case $verb in\n{}    esac\n"
                       "}}\n"
                       "if [[ $funcstack[1] == _tetrace ]]; then _tetrace; else compdef _tetrace tetrace; fi\n",
                       verbs, cases);
}

std::string fish_completion()
{
    std::string text = "# Completes command lines of tetrace in fish.\ncomplete -c tetrace -f\n";
    for (const VerbHelp& verb : verb_helps()) {
        const std::string_view name = name_of(verb.verb);
        text +=
            fmt::format("complete -c tetrace -n __fish_use_subcommand -a {} -d {}\n", name, in_quotes(verb.summary));
        const std::string given = fmt::format("complete -c tetrace -n '__fish_seen_subcommand_from {}'", name);
        for (const OptionRow* row : rows_of_options(verb.verb)) {
            text += fmt::format("{} -l {} -d {}", given, row->name.substr(2), in_quotes(first_sentence(row->help)));
            if (!row->value.empty()) text += row->apply.takes_files() ? " -r -F" : " -x";
            const std::string names = fmt::format("{}", fmt::join(row->apply.names(), " "));
            if (!names.empty())
                text += row->list ? fmt::format(" -a '(__fish_complete_list , \"printf %s\\n {}\")'", names)
                                  : fmt::format(" -a '{}'", names);
            text += "\n";
        }
        if (const std::string words = words_after(verb.verb); !words.empty())
            text += fmt::format("{} -a '{}'\n", given, words);
        else if (file_arguments(verb.verb).max > 0)
            text += fmt::format("{} -k -a '(__fish_complete_suffix .json)'\n", given);
    }
    return text;
}

} // namespace tetrace
