#include "bench/options/rejected_options.h"

#include "bench/options/option_table.h"
#include "bench/options/option_values.h"
#include "scenes/catalogue.h"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

namespace tetrace {

namespace {

/// Options that had a name which has another meaning for other verbs.
struct Renamed {
    Verb verb;
    std::string_view before, now;
};
constexpr Renamed renamed[] = {{Verb::check, "--picture", "--differences"},
                               {Verb::judge, "--rays", "--ray-file"},
                               {Verb::report, "--picture", "--image"},
                               {Verb::inspect, "--require", "--require-target"}};

/// Empty if none does.
std::string verbs_taking_option(const std::string& name)
{
    std::vector<std::string> verbs;
    for (const Verb verb : values_of<Verb>())
        if (std::ranges::any_of(option_table(),
                                [&](const OptionRow& row) { return row.name == name && takes(verb, row); }))
            verbs.emplace_back(name_of(verb));
    return join_alternatives(verbs);
}

} // namespace

std::string without_value(Verb verb, const std::string& problem)
{
    const std::string name = problem.substr(0, problem.find(':'));
    const auto row = std::ranges::find_if(option_table(),
                                          [&](const OptionRow& one) { return one.name == name && takes(verb, one); });
    if (row == option_table().end()) return problem;
    return row->value.empty() ? name + " takes no value" : fmt::format("{} needs a value: {}", name, row->value);
}

void reject_verb(const std::string& word, std::vector<std::string> verbs)
{
    verbs.insert(verbs.end(), {"--help", "--version"});
    const std::string guess = did_you_mean(word, verbs);
    const std::string reason = find_in_catalogue(word) != nullptr
                                   ? fmt::format("; a scene is 'tetrace bench --scene {}'; accepted", word)
                               : guess.empty() ? "; accepted"
                                               : guess + " Accepted";
    throw Error(ErrorKind::usage, fmt::format("'{}' is not a verb{}: {}\n'tetrace help' describes them", word, reason,
                                              join_alternatives(verbs)));
}

std::vector<std::string> accepted_options(Verb verb)
{
    std::vector<std::string> names;
    for (const OptionRow& row : option_table())
        if (takes(verb, row)) names.push_back(row.name);
    names.emplace_back("--help");
    if (verb == Verb::bench) names.emplace_back("--benchmark_* (Google Benchmark's own)");
    return names;
}

std::string not_accepted(Verb verb, const std::vector<std::string>& arguments, const std::vector<std::string>& unplaced)
{
    const auto accepted = accepted_options(verb);
    for (const std::string& argument : arguments) {
        const std::string name = argument.substr(0, argument.find('='));
        if (name.size() < 2 || !name.starts_with('-') || std::ranges::find(unplaced, argument) == unplaced.end())
            continue;
        for (const Renamed& option : renamed)
            if (option.verb == verb && option.before == name)
                return fmt::format("{} of {} is now {}", name, name_of(verb), option.now);
        const std::string guess = did_you_mean(name, accepted), others = verbs_taking_option(name);
        if (guess.empty() && !others.empty())
            return fmt::format("'{}' is not an option of {}, but of {}", name, name_of(verb), others);
        return fmt::format("'{}' is not an option{}", name, guess);
    }
    const auto first = std::ranges::find_if(arguments, [&](const std::string& argument) {
        return std::ranges::find(unplaced, argument) != unplaced.end();
    });
    const std::string word = first != arguments.end() ? *first : "";
    const bool takes_scenes = std::ranges::find(accepted, "--scene") != accepted.end();
    return fmt::format("'{}' is not expected{}", word,
                       takes_scenes && !word.starts_with('-') ? fmt::format("; a scene is '--scene {}'", word) : "");
}

void reject_command_line(Verb verb, const std::string& reason)
{
    throw Error(ErrorKind::usage, fmt::format("{0}: {1}\naccepted options: {2}\n'tetrace {0} --help' describes them",
                                              name_of(verb), reason, join_alternatives(accepted_options(verb))));
}

} // namespace tetrace
