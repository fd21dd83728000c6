#include "bench/options/manual.h"

#include "bench/options/help.h"
#include "bench/options/identity.h"
#include "bench/options/option_table.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tetrace {

namespace {

/// Text for troff: a backslash, a hyphen that is to be copied, and a line that would begin with a macro.
std::string troff(std::string_view text)
{
    std::string result;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
        if (c == '\\')
            result += "\\e";
        else if (c == '-')
            result += "\\-";
        else
            result += c;
    }
    return result;
}

std::string paragraphs(std::string_view text)
{
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find("\n\n", at), text.size());
        result += fmt::format("{}{}\n", at == 0 ? "" : ".PP\n", troff(text.substr(at, end - at)));
        at = end + 2;
    }
    return result;
}

std::string verbs_taking(const OptionRow& row)
{
    std::string names;
    for (const VerbHelp& verb : verb_helps())
        if (takes(verb.verb, row)) append_item(names, ", ", name_of(verb.verb));
    return names;
}

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

bool is_option(const OptionRow& row)
{
    return row.name.starts_with("--");
}

} // namespace

std::string man_page()
{
    std::string text = fmt::format(".TH TETRACE 1 \"\" \"tetrace {}\" \"User Commands\"\n"
                                   ".SH NAME\ntetrace \\- time and check one ray tracing program under four APIs\n"
                                   ".SH SYNOPSIS\n.B tetrace\n.I VERB\n.RI [ OPTION ]...\n.SH VERBS\n",
                                   troff(build_identity().version));
    for (const VerbHelp& verb : verb_helps()) {
        const FileArguments files = file_arguments(verb.verb);
        text += fmt::format(".SS tetrace {}{}{}\n{}.PP\n.nf\n{}.fi\n", name_of(verb.verb), files.max > 0 ? " " : "",
                            files.names, paragraphs(verb.description), troff(verb.examples));
    }
    text += ".SH OPTIONS\n";
    std::string group;
    for (const OptionRow& row : option_table()) {
        if (row.group != group) text += fmt::format(".SS {}\n", troff(row.group));
        group = row.group;
        text += fmt::format(".TP\n.BR {}{}\n{}\n.br\nTaken by {}.\n", troff(row.name),
                            row.value.empty() ? "" : fmt::format(" \" \\fI{}\\fR\"", troff(row.value)), troff(row.help),
                            verbs_taking(row));
    }
    text += ".SH EXIT STATUS\n";
    for (const auto& [code, meaning] : exit_code_meanings)
        text += fmt::format(".TP\n.B {}\n{}\n", code, meaning);
    return text + ".SH ENVIRONMENT\n"
                  ".TP\n.B XDG_CACHE_HOME\nWhere built scenes and compiled programs are kept, in its folder tetrace; "
                  "by default ~/.cache.\n"
                  ".TP\n.B TMPDIR\nWhere they are during a run if that folder cannot be written to; by default /tmp.\n"
                  ".TP\n.B TETRACE_MESHES\nA folder with the catalogue's meshes, asked before the system's.\n"
                  ".TP\n.B OMP_NUM_THREADS\nHost threads, where \\-\\-threads is not given.\n"
                  ".TP\n.B GOMP_SPINCOUNT, OMP_WAIT_POLICY\nHow OpenMP's threads wait. If neither is set and other "
                  "processes use the processors, bench and reproduce set the first to 2000.\n"
                  ".TP\n.B NO_COLOR\nNo colours.\n";
}

std::string bash_completion()
{
    std::string verbs, options;
    for (const VerbHelp& verb : verb_helps()) {
        verbs += fmt::format("{} ", name_of(verb.verb));
        options += fmt::format("    {}) words='", name_of(verb.verb));
        for (const OptionRow& row : option_table())
            if (is_option(row) && takes(verb.verb, row)) options += row.name + ' ';
        options += "--help' ;;\n";
    }
    return fmt::format("# Completes command lines of tetrace in bash.\n"
                       "_tetrace()\n{{\n"
                       "    local current=${{COMP_WORDS[COMP_CWORD]}} words=\n"
                       "    if ((COMP_CWORD == 1)); then\n"
                       "        words='{}--help --version'\n"
                       "    elif [[ $current == -* ]]; then\n"
                       "    case ${{COMP_WORDS[1]}} in\n{}    esac\n"
                       "    elif [[ ${{COMP_WORDS[1]}} == help ]]; then\n"
                       "        words='{}{}'\n"
                       "    fi\n"
                       "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
                       "}}\n"
                       "complete -o default -F _tetrace tetrace\n",
                       verbs, options, verbs, fmt::join(other_topics, " "));
}

std::string zsh_completion()
{
    std::string verbs, cases;
    for (const VerbHelp& verb : verb_helps()) {
        verbs +=
            fmt::format("        {}\n", in_quotes(fmt::format("{}:{}", name_of(verb.verb), described(verb.summary))));
        cases += fmt::format("    {})\n        _arguments", name_of(verb.verb));
        for (const OptionRow& row : option_table()) {
            if (!is_option(row) || !takes(verb.verb, row)) continue;
            const std::string value = row.value.empty() ? "" : fmt::format(":{}:_files", described(row.value));
            cases += " \\\n            " + in_quotes(fmt::format("{}{}[{}]{}", row.list ? "*" : "", row.name,
                                                                 described(first_sentence(row.help)), value));
        }
        cases += " \\\n            '--help[describe the verb]' '*: :_files'\n        ;;\n";
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

} // namespace tetrace
