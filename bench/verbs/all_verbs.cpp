#include "bench/inspection/null_hardware.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "bench/verbs/ranks.h"
#include "core/base/error.h"

namespace tetrace {

namespace {

int run_verb(const Options& options)
{
    say_when_interrupted(words_when_begun(options));
    switch (options.verb) {
    case Verb::devices: return devices_command(options);
    case Verb::scenes: return scenes_command(options);
    case Verb::build: return build_command(options);
    case Verb::bench: return bench_command(options);
    case Verb::check: return check_command(options);
    case Verb::render: return render_command(options);
    case Verb::reproduce: return reproduce_command(options);
    case Verb::inspect: return inspect_command(options);
    case Verb::trace: return trace_command(options);
    case Verb::dump: return dump_command(options);
    case Verb::compare: return compare_command(options);
    case Verb::show: return show_command(options);
    case Verb::report: return report_command(options);
    case Verb::merge: return merge_command(options);
    case Verb::help:
    case Verb::version: break; // every program's
    }
    throw Error(ErrorKind::internal, "run_verb: no such verb");
}

int run_verb_or_rank(const Options& options)
{
    const auto rank = is_shared(options) ? this_rank() : std::nullopt;
    return rank ? run_rank(*rank, options, run_verb) : run_verb(options);
}

std::optional<int> run_unlisted(const std::vector<std::string>& arguments)
{
    if (arguments.empty() || arguments.front() != null_hardware_word) return std::nullopt;
    return run_null_hardware({arguments.begin() + 1, arguments.end()});
}

} // namespace

int run_program(const std::vector<std::string>& arguments)
{
    return run_program(arguments, {run_verb_or_rank, run_unlisted});
}

} // namespace tetrace
