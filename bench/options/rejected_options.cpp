#include "bench/options/rejected_options.h"

#include "bench/options/option_table.h"
#include "bench/options/option_values.h"

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
                               {Verb::report, "--picture", "--image"},
                               {Verb::inspect, "--require", "--require-target"}};

} // namespace

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
        return fmt::format("'{}' is not an option{}", name, did_you_mean(name, accepted));
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
