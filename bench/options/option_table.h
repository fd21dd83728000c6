#pragma once

#include "bench/options/options.h"

#include <concepts>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tetrace {

/// What an option does with a value, and the values that it accepts.
class ApplyOption {
public:
    /// take: takes one value; throws Error{usage} if it is not accepted. names: what it accepts by name, in the order
    /// of help; empty for numbers and any text. takes_files: whether a file's name is accepted, too or instead.
    template <std::invocable<Options&, const std::string&> Take>
    ApplyOption(Take take, std::vector<std::string> names = {}, bool takes_files = false)
        : take_(std::move(take)), names_(std::move(names)), takes_files_(takes_files)
    {
    }
    void operator()(Options& options, const std::string& text) const { take_(options, text); }
    [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
    [[nodiscard]] bool takes_files() const { return takes_files_; }

private:
    std::function<void(Options&, const std::string&)> take_;
    std::vector<std::string> names_;
    bool takes_files_;
};

/// Verbs whose first page of help has an option, and its line there: "{}" is replaced by ApplyOption::names().
struct Usual {
    unsigned verbs = 0;
    const char* line = "";
};

/// One option of the program. Parsing and every --help are generated from it.
struct OptionRow {
    std::string group; ///< heading in help
    std::string name;  ///< with its dashes
    std::string value; ///< placeholder of its value; empty for a flag
    std::string help;  ///< sentences; the last one gives the default
    unsigned verbs;    ///< bit 1 << verb for each verb that takes it
    bool list;         ///< may be repeated, and takes several values separated by commas
    ApplyOption apply;
    Usual usual = {};
};

[[nodiscard]] const std::vector<OptionRow>& option_table();

/// The files that a verb reads, given without an option: how help writes them, and how many are allowed.
struct FileArguments {
    std::string_view names = "";
    std::size_t min = 0, max = 0;
};
[[nodiscard]] FileArguments file_arguments(Verb verb);

/// Whether it is an option, and not the words after a verb.
[[nodiscard]] inline bool is_option(const OptionRow& row)
{
    return row.name.starts_with("--");
}

[[nodiscard]] inline bool takes(Verb verb, const OptionRow& row)
{
    return (row.verbs >> static_cast<unsigned>(verb) & 1u) != 0;
}

} // namespace tetrace
