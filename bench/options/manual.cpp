#include "bench/options/manual.h"

#include "bench/options/help.h"
#include "bench/options/identity.h"
#include "bench/options/option_table.h"
#include "bench/terminal/text.h"

#include <fmt/format.h>

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

} // namespace tetrace
