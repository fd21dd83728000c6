#pragma once

#include "bench/options/options.h"

#include <functional>
#include <string>
#include <vector>

namespace tetrace {

/// Takes one value of an option. Throws Error{usage}.
using ApplyOption = std::function<void(Options&, const std::string&)>;

/// One option of the program. Parsing and every --help are generated from it.
struct OptionRow {
    std::string group; ///< heading in help
    std::string name;  ///< with its dashes
    std::string value; ///< placeholder of its value; empty for a flag
    std::string help;  ///< sentences; the last one gives the default
    unsigned verbs;    ///< bit 1 << verb for each verb that takes it
    bool list;         ///< may be repeated, and takes several values separated by commas
    ApplyOption apply;
};

[[nodiscard]] const std::vector<OptionRow>& option_table();

/// The files that a verb reads, given without an option: how help writes them, and how many are allowed.
struct FileArguments {
    std::string_view names = "";
    std::size_t min = 0, max = 0;
};
[[nodiscard]] FileArguments file_arguments(Verb verb);

[[nodiscard]] inline bool takes(Verb verb, const OptionRow& row)
{
    return (row.verbs >> static_cast<unsigned>(verb) & 1u) != 0;
}

} // namespace tetrace
