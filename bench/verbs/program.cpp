#include "bench/inspection/null_hardware.h"
#include "bench/measuring/run_journal.h"
#include "bench/options/help.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/variants/variant_program.h"
#include "bench/verbs/commands.h"
#include "bench/verbs/process_limits.h"
#include "bench/verbs/ranks.h"
#include "core/base/cache_home.h"
#include "core/base/control_groups.h"
#include "core/base/error.h"
#include "core/isolation/driver_server.h"
#include "core/isolation/isolation.h"

#include <algorithm>
#include <csignal>
#include <exception>
#include <fmt/format.h>
#include <iterator>
#include <memory>
#include <new>

namespace tetrace {

namespace {

std::vector<std::string>& command_line()
{
    static std::vector<std::string> arguments;
    return arguments;
}

} // namespace

void say_how_to_go_on(const Options& options)
{
    std::vector<std::string> words = command_line();
    std::erase_if(words, [](const std::string& word) { // --resume refuses them, see check_resume()
        return word.starts_with("--benchmark_out") || word.starts_with("--benchmark_format");
    });
    if (std::ranges::find(words, "--resume") == words.end()) words.emplace_back("--resume");
    say_when_interrupted(fmt::format("tetrace: what is finished is in '{}'; to go on: {}",
                                     journal_file(*options.out).string(), command_of(words)));
}

int end_interrupted()
{
    if (const std::string words = words_when_interrupted(); !words.empty()) say(words);
    return exit_code(ErrorKind::interrupted);
}

int end_interrupted_with_result(const Options& options)
{
    if (options.out)
        say_when_interrupted(fmt::format("tetrace: interrupted; what ran by then is in '{}'", options.out->string()));
    return end_interrupted();
}

std::string words_when_begun(const Options& options)
{
    const bool is_long = options.verb == Verb::bench || options.verb == Verb::check || options.verb == Verb::render ||
                         options.verb == Verb::page || options.verb == Verb::build || options.verb == Verb::inspect ||
                         options.verb == Verb::trace || options.verb == Verb::reproduce || options.verb == Verb::rays ||
                         options.verb == Verb::judge;
    if (!is_long) return {};
    const char* kept = options.verb == Verb::build    ? "scenes that were built before are in the cache"
                       : options.verb == Verb::render ? "pictures that were written before are whole"
                                                      : "an earlier result is unchanged";
    const bool resumes = options.verb == Verb::bench || options.verb == Verb::reproduce ||
                         (options.verb == Verb::check && options.repeat == 1 && has_rows(options));
    const char* hint = resumes && !options.out ? "; with --out FILE.json, --resume can go on" : "";
    return fmt::format("tetrace: interrupted; {}. To begin again: {}{}", kept, command_of(command_line()), hint);
}

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
    case Verb::page: return page_command(options);
    case Verb::trace: return trace_command(options);
    case Verb::dump: return dump_command(options);
    case Verb::rays: return rays_command(options);
    case Verb::judge: return judge_command(options);
    case Verb::compare: return compare_command(options);
    case Verb::show: return show_command(options);
    case Verb::report: return report_command(options);
    case Verb::merge: return merge_command(options);
    case Verb::help: print(help_text(options.help_topic, options.whole_help)); return 0;
    case Verb::version: print(version_text()); return 0;
    }
    throw Error(ErrorKind::internal, "run_verb: no such verb");
}

/// Of verbs that build scenes or load drivers.
std::unique_ptr<CacheHome> cache_of(Verb verb)
{
    constexpr Verb others[] = {Verb::scenes, Verb::compare, Verb::show,   Verb::report,
                               Verb::merge,  Verb::help,    Verb::version};
    if (std::ranges::find(others, verb) != std::end(others)) return nullptr;
    auto cache = std::make_unique<CacheHome>();
    if (verb == Verb::build) cache->keep();
    if (const std::string note = cache->note(); !note.empty()) say("tetrace: " + note);
    return cache;
}

int run_verb_or_rank(const Options& options)
{
    const auto rank = is_shared(options) ? this_rank() : std::nullopt;
    return rank ? run_rank(*rank, options, run_verb) : run_verb(options);
}

} // namespace

int run_program(const std::vector<std::string>& arguments)
{
    command_line() = arguments;
    std::signal(SIGXFSZ, SIG_IGN); // a file over `ulimit -f` is then an error of its write, as on a full disk
    try {
        // Two first words are not for users: with them the program starts itself, to load a driver.
        if (!arguments.empty() && arguments.front() == driver_verb)
            return serve_driver({arguments.begin() + 1, arguments.end()}, direct_backends());
        if (!arguments.empty() && arguments.front() == null_hardware_word)
            return run_null_hardware({arguments.begin() + 1, arguments.end()});
        limit_threads();
        const Options options = parse_options(arguments);
        check_stacks();
        const bool is_timed = options.verb == Verb::bench || options.verb == Verb::reproduce;
        if (is_timed && !options.list && options.threads != 1 && !this_rank()) start_again_if_busy(arguments);
        const auto cache = cache_of(options.verb);
        set_isolation(options.isolation, options.driver_limit_s,
                      options.variants > 0 ? backends_with_texts() : std::vector<std::string>{});
        return run_verb_or_rank(options);
    } catch (const Error& error) {
        say(std::string("tetrace: ") + error.what());
        const std::string words = words_when_interrupted();
        if (error.kind() == ErrorKind::interrupted && !words.empty()) say(words);
        return exit_code(error.kind());
    } catch (const std::bad_alloc&) {
        say("tetrace: out of memory" + memory_limit_text() + "; use a smaller --size, fewer scenes or fewer --views");
        return exit_code(ErrorKind::unsupported);
    } catch (const std::exception& error) {
        say(std::string("tetrace: internal error: ") + error.what());
        return exit_code(ErrorKind::internal);
    }
}

} // namespace tetrace
