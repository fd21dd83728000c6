#include "bench/options/options.h"

#include "bench/options/help.h"
#include "bench/options/option_table.h"
#include "bench/options/option_values.h"
#include "bench/options/rejected_options.h"
#include "bench/options/workload.h"

#include "core/base/control_groups.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string_view>

namespace tetrace {

namespace {

/// The verbs that are words; the version is asked for by --version.
std::vector<Verb> all_verbs()
{
    auto verbs = values_of<Verb>();
    std::erase(verbs, Verb::version);
    return verbs;
}

std::vector<std::string> names_of_verbs()
{
    std::vector<std::string> names;
    for (const Verb verb : all_verbs())
        names.emplace_back(name_of(verb));
    return names;
}

bool is_google_benchmark_flag(const std::string& argument)
{
    return argument.rfind("--benchmark_", 0) == 0;
}

/// Google Benchmark reads its own flags; tetrace reads all others.
std::vector<std::string> without_benchmark_flags(const std::vector<std::string>& arguments, Options& options)
{
    std::vector<std::string> ours;
    for (const std::string& argument : arguments)
        (options.verb == Verb::bench && is_google_benchmark_flag(argument) ? options.benchmark_flags : ours)
            .push_back(argument);
    return ours;
}

std::string counted_files(std::size_t count)
{
    return count == 0 ? "no file is" : count == 1 ? "one file is" : fmt::format("{} files are", count);
}

void add_row(CLI::App& app, const OptionRow& row)
{
    if (row.value.empty()) {
        app.add_flag(row.name);
        return;
    }
    // Each occurrence takes one value. The number of occurrences is checked after parsing, with our own error text.
    app.add_option(row.name, [](const CLI::results_t&) { return true; })
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void apply_values(Options& options, const OptionRow& row, const std::vector<std::string>& occurrences)
{
    if (occurrences.size() > 1 && !row.list)
        throw Error(ErrorKind::usage,
                    fmt::format("{} is given {} times; it accepts one value", row.name, occurrences.size()));
    for (const std::string& text : occurrences)
        for (const std::string& value : row.name == "--scene" ? split_scenes(row.name, text)
                                        : row.list            ? split_list(row.name, text)
                                                              : std::vector{text})
            row.apply(options, value);
}

/// Lists that start with a default; the first value given replaces it.
void clear_default(Options& options, const std::string& name)
{
    if (name == "--domain") options.domains.clear();
    if (name != "--tets") return;
    options.tets.clear();
    options.names_tets = true;
}

void apply_row(Options& options, const OptionRow& row, CLI::App& app)
{
    const CLI::Option* given = app.get_option(row.name);
    if (given->count() == 0) return;
    if (row.value.empty())
        row.apply(options, "");
    else {
        clear_default(options, row.name);
        apply_values(options, row, given->results());
    }
}

void set_files(Options& options, const std::vector<std::string>& given)
{
    const FileArguments files = file_arguments(options.verb);
    if (given.size() < files.min || given.size() > files.max)
        throw Error(ErrorKind::usage, fmt::format("{0}: {1} given; usage: tetrace {0} {2} [OPTION]...",
                                                  name_of(options.verb), counted_files(given.size()), files.names));
    options.files.assign(given.begin(), given.end());
}

void check_single(const Options& options, const char* name, std::size_t count)
{
    if (options.verb != Verb::build && count > 1)
        throw Error(ErrorKind::usage, fmt::format("{} accepts one value for '{}'; lists are for 'tetrace build'", name,
                                                  name_of(options.verb)));
}

/// A list is an axis of `bench`: each value once. One value is none.
template <class T, class Text>
void check_axis(Verb verb, const char* name, std::vector<T>& values, const Text& text)
{
    if (verb != Verb::bench && values.size() > 1)
        throw Error(ErrorKind::usage,
                    fmt::format("{} accepts one value for '{}'; lists are for 'tetrace bench'", name, name_of(verb)));
    for (std::size_t i = 1; i < values.size(); ++i)
        if (std::find(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i), values[i]) !=
            values.begin() + static_cast<std::ptrdiff_t>(i))
            throw Error(ErrorKind::usage, fmt::format("{}: {} is given twice", name, text(values[i])));
    if (values.size() == 1) values.clear();
}

void check_axes(Options& options)
{
    check_axis(options.verb, "--size", options.sizes,
               [](ImageSize size) { return fmt::format("{}x{}", size.width, size.height); });
    check_axis(options.verb, "--threads", options.thread_counts, [](unsigned count) { return std::to_string(count); });
    std::ranges::sort(options.thread_counts);
    if (!options.thread_counts.empty() && options.thread_counts.front() == 0)
        throw Error(ErrorKind::usage, "--threads: 0 means all, which a list has to give as a number, as in 1,2,4");
}

/// `trace` follows one ray, and a case of `dump` has the work-group of one.
void check_ray(const Options& options)
{
    if (options.scenes.empty())
        throw Error(ErrorKind::usage, fmt::format("{}: --scene SCENE is missing: which scene?", name_of(options.verb)));
    if (options.scenes.size() > 1)
        throw Error(ErrorKind::usage, fmt::format("{}: --scene accepts one scene; {} are given", name_of(options.verb),
                                                  options.scenes.size()));
    if (!options.pixel)
        throw Error(ErrorKind::usage, fmt::format("{}: --pixel X,Y is missing: which ray?", name_of(options.verb)));
    if (options.pixel->x >= options.width || options.pixel->y >= options.height)
        throw Error(ErrorKind::usage,
                    fmt::format("--pixel: {},{} is outside the image, whose pixels go from 0,0 to {},{}; --size "
                                "sets its size",
                                options.pixel->x, options.pixel->y, options.width - 1, options.height - 1));
}

void check_dump(const Options& options)
{
    if (options.backends.size() != 1) throw Error(ErrorKind::usage, "dump: --backend needs one backend: whose files?");
    if (!options.out) throw Error(ErrorKind::usage, "dump: --out FOLDER is missing: where to?");
    if (!options.scenes.empty()) check_ray(options);
    if (!options.entries.empty() && (options.changes.empty() || !options.scenes.empty()))
        throw Error(ErrorKind::usage, "dump: --entry chooses the command of a variant's text: it goes with --variant, "
                                      "and without --scene, where --task and --rays choose the kernel");
}

/// What `dump` accepts without a case, and what a case of a defect accepts; the other options choose a scene's case.
constexpr std::string_view of_files[] = {"--backend", "--out",    "--method",  "--layout",
                                         "--math",    "--device", "--variant", "--entry"};
constexpr std::string_view of_defects[] = {"--backend", "--out", "--defect"};

void check_case(const Options& options, const CLI::App& app)
{
    const bool has_defect = !options.defect.empty();
    if (!has_defect && !options.scenes.empty()) return;
    const auto accepted = has_defect ? std::span(of_defects) : std::span<const std::string_view>(of_files);
    for (const OptionRow& row : option_table())
        if (takes(Verb::dump, row) && app.get_option(row.name)->count() > 0 &&
            std::ranges::find(accepted, row.name) == accepted.end())
            throw Error(ErrorKind::usage,
                        has_defect ? fmt::format("dump: {} does not go with --defect", row.name)
                                   : fmt::format("dump: {} is for a case; name its scene with --scene", row.name));
}

void check_together(const Options& options)
{
    check_single(options, "--domain", options.domains.size());
    if (options.verb != Verb::render) check_single(options, "--tets", options.tets.size());
    check_single(options, "--divisions", options.divisions.size());
    check_single(options, "--switches", options.switches.size());
    require_views(options);
    if (options.verb == Verb::render) check_single(options, "--rays", options.rays.size());
    if (options.verb == Verb::render && !options.rays.empty() &&
        std::ranges::find(options.pictures, Picture::tally) == options.pictures.end())
        throw Error(ErrorKind::usage, "--rays: only --picture tally shows other rays than the image's own");
    if (options.tets.size() > 1 && writes_hits(options.pictures))
        throw Error(ErrorKind::usage, "--picture hits: a file has the hits of one kind of tets; name one with --tets");
    if ((options.defects || options.stress) && !shard_of(options).is_whole())
        throw Error(ErrorKind::usage, std::string(options.defects ? "--defects" : "--stress") +
                                          " takes only seconds and cannot be sharded; leave out --shard");
    if (options.variants == 0 && options.seed)
        throw Error(ErrorKind::usage, "--seed chooses variants; say how many with --variants");
    const bool only_compiles = options.verb == Verb::inspect;
    if (only_compiles && options.variants == 0 && std::isfinite(options.budget_s))
        throw Error(ErrorKind::usage, "--budget: inspect has it only with --variants, which says how many to compile");
    if (only_compiles && options.variants > 0 &&
        (!options.backends.empty() || !options.devices.empty() || options.code_folder))
        throw Error(ErrorKind::usage, "--variants: inspect compiles them for GPUs that --target names, and keeps no "
                                      "code; leave out --backend, --device and --code");
    if (options.brief && !options.columns.empty())
        throw Error(ErrorKind::usage, "--columns: --brief has columns of its own; leave one of them out");
    if (options.verb == Verb::trace) check_ray(options);
    if (options.verb == Verb::dump) check_dump(options);
}

/// `reproduce rivals`, `ladder` and `volume` are runs of `bench` over given rows; the other tables are of views one
/// after the other. Rays of the last two are random and do not depend on cameras.
constexpr std::string_view only_of_rivals[] = {"--runs"};
constexpr std::string_view not_of_bench_runs[] = {"--builds", "--searches", "--shard", "--wait"};
constexpr std::string_view not_of_ladder[] = {"--camera-set", "--views"};
constexpr std::string_view not_of_volume[] = {"--camera-set"};

void check_bench_runs(const Options& options, const CLI::App& app)
{
    const auto target = std::ranges::find_if(options.targets, is_bench_run);
    const bool is_any = target != options.targets.end();
    const std::string name(is_any ? name_of(*target) : "");
    if (is_any && options.targets.size() > 1)
        throw Error(ErrorKind::usage,
                    fmt::format("reproduce: {} cannot be combined with other tables; run it by itself", name));
    const auto reject = [&](std::span<const std::string_view> options_of_others, const std::string& what) {
        for (const std::string_view option : options_of_others)
            if (app.get_option(std::string(option))->count() > 0)
                throw Error(ErrorKind::usage, fmt::format("{} {}", option, what));
    };
    if (!is_any || *target != PaperTarget::rivals)
        reject(only_of_rivals, "is for 'reproduce rivals'; the other tables are measured once");
    if (is_any)
        reject(not_of_bench_runs, fmt::format("is not for 'reproduce {}', which is one run of one process", name));
    if (is_any && *target == PaperTarget::ladder)
        reject(not_of_ladder, "is not for 'reproduce ladder', which traces random rays");
    if (is_any && *target == PaperTarget::volume)
        reject(not_of_volume, "is not for 'reproduce volume', which crosses tets on random rays");
}

/// A verb's defaults.
Options defaults_of(Verb verb)
{
    Options options;
    options.verb = verb;
    if (verb != Verb::bench) options.budget_s = std::numeric_limits<double>::infinity();
    if (verb == Verb::check || verb == Verb::trace || verb == Verb::dump || verb == Verb::page)
        options.width = options.height = 256; // seconds for the scene cubes on all devices
    if (verb == Verb::trace || verb == Verb::dump) options.views = "0";
    if (verb != Verb::reproduce) return options;
    options.camera_set = CameraSet::flight; // as many views as in the paper, over its range of steps
    options.structures = {Structure::cdt};
    options.tets = {TetsKind::cdt}; // as in the paper; --builds adds others
    options.samples = 5;
    options.sample_s = 0.005; // of each of 1,282 views
    return options;
}

/// A workload decides them.
constexpr std::string_view decided_by_workload[] = {"--scene",  "--repair",    "--no-repair", "--domain",     "--tets",
                                                    "--effort", "--divisions", "--switches",  "--camera-set", "--views",
                                                    "--size",   "--rays",      "--ray-order", "--task"};

void check_workload(Verb verb, const CLI::App& app)
{
    if (app.get_option_no_throw("--workload") == nullptr || app.get_option("--workload")->count() == 0) return;
    for (const OptionRow& row : option_table())
        if (takes(verb, row) && std::ranges::find(decided_by_workload, row.name) != std::end(decided_by_workload) &&
            app.get_option(std::string(row.name))->count() > 0)
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: --workload decides it, so that results compare; leave one of them out", row.name));
}

bool asks_for(PaperTarget target, Verb verb, const CLI::App& app)
{
    if (verb != Verb::reproduce) return false;
    const auto& tables = app.get_option("TABLE")->results();
    return std::ranges::find(tables, name_of(target)) != tables.end();
}

/// Those of `bench`, but for more rows in as many minutes.
Options defaults_of_rivals()
{
    Options options;
    options.verb = Verb::reproduce;
    options.width = options.height = 512;
    options.budget_s = 600;
    return options;
}

/// The same, for one view: random rays of the next ones would be alike.
Options defaults_of_ladder()
{
    Options options = defaults_of_rivals();
    options.views = "0";
    options.rays = {RayKind::random};
    options.budget_s = 300;
    return options;
}

/// The same, for two views, and less per row: there are many, and their answers matter more than their rates.
Options defaults_of_volume()
{
    Options options = defaults_of_ladder();
    options.views = "0,1";
    options.width = options.height = 64;
    options.samples = 3;
    options.sample_s = 0;
    options.budget_s = std::numeric_limits<double>::infinity();
    return options;
}

/// The main job has three scenes: two views of each take as long as four views of two did.
void choose_default_views(Options& options)
{
    const bool is_main_job = options.verb == Verb::bench && options.scenes.empty() && !options.own_cameras &&
                             options.camera_set == CameraSet::frame;
    if (is_main_job && options.views.empty()) options.views = workloads().front().views;
}

/// What shards of one run may differ in, and what `merge` gives anew: where output goes, and on what they run.
constexpr std::string_view own_options[] = {"--shard", "--wait",        "--out",    "--format",  "--resume", "--label",
                                            "--junit", "--differences", "--device", "--threads", "--columns"};

Options help_of(const std::string& topic, bool whole = false)
{
    Options options;
    options.help_topic = topic;
    options.whole_help = whole;
    return options;
}

Options parse_verb(Verb verb, const std::vector<std::string>& arguments)
{
    const auto has = [&](const char* word) { return std::ranges::find(arguments, word) != arguments.end(); };
    if (has("--help=all")) return help_of(std::string(name_of(verb)), true);
    if (has("--version") || has("-V")) return {.verb = Verb::version};
    Options options = defaults_of(verb);
    CLI::App app;
    app.set_help_flag("--help,-h");
    for (const OptionRow& row : option_table())
        if (takes(verb, row)) add_row(app, row);
    std::vector<std::string> files;
    if (file_arguments(verb).max > 0) app.add_option("FILE", files);
    auto ours = without_benchmark_flags(arguments, options);
    std::ranges::reverse(ours); // CLI11 takes the arguments from the back
    try {
        app.parse(std::move(ours));
    } catch (const CLI::CallForHelp&) {
        return help_of(std::string(name_of(verb)));
    } catch (const CLI::ExtrasError&) {
        reject_command_line(verb, not_accepted(verb, arguments, app.remaining()));
    } catch (const CLI::ArgumentMismatch& problem) {
        reject_command_line(verb, without_value(verb, problem.what()));
    } catch (const CLI::ParseError& problem) {
        reject_command_line(verb, problem.what());
    }
    if (asks_for(PaperTarget::rivals, verb, app)) options = defaults_of_rivals();
    if (asks_for(PaperTarget::ladder, verb, app)) options = defaults_of_ladder();
    if (asks_for(PaperTarget::volume, verb, app)) options = defaults_of_volume();
    for (const OptionRow& row : option_table())
        if (takes(verb, row)) apply_row(options, row, app);
    if (verb == Verb::reproduce) check_bench_runs(options, app);
    if (verb == Verb::dump) check_case(options, app);
    check_workload(verb, app);
    check_axes(options);
    set_files(options, files);
    choose_default_views(options);
    options.words = {std::string(name_of(verb))};
    options.words.insert(options.words.end(), arguments.begin(), arguments.end());
    options.arguments = without_options(options.words, own_options);
    check_together(options);
    return options;
}

Options parse_help(const std::vector<std::string>& topics)
{
    if (topics.empty()) return {};
    std::vector<std::string> names = names_of_verbs();
    const std::size_t verbs = names.size();
    names.insert(names.end(), std::begin(other_topics), std::end(other_topics));
    const std::string& topic = topics.front();
    const auto found = std::ranges::find(names, topic);
    if (found == names.end()) reject_name("help", topic, names);
    const bool is_verb = found - names.begin() < static_cast<std::ptrdiff_t>(verbs);
    if (topics.size() == 1) return help_of(topic);
    if (topics.size() == 2 && topics.back() == "all" && is_verb) return help_of(topic, true);
    throw Error(ErrorKind::usage, fmt::format("help: '{}' is not expected; usage: tetrace help [VERB [all] | TOPIC]",
                                              is_verb && topics[1] == "all" ? topics[2] : topics[1]));
}

} // namespace

std::vector<std::string> without_options(const std::vector<std::string>& words, std::span<const std::string_view> names)
{
    const auto is_flag = [](const std::string& name) {
        const auto row = std::ranges::find(option_table(), name, &OptionRow::name);
        return row != option_table().end() && row->value.empty();
    };
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string name = words[i].substr(0, words[i].find('='));
        if (std::ranges::find(names, name) == names.end())
            kept.push_back(words[i]);
        else if (name == words[i] && !is_flag(name))
            ++i; // its value
    }
    return kept;
}

void require_views(const Options& options)
{
    if (!selected_views(options).empty() || options.verb == Verb::reproduce) return;
    Options whole = options;
    whole.shard = Shard();
    throw Error(ErrorKind::usage, fmt::format("--shard {}: this shard would be empty; views selected: {}",
                                              text_of(shard_of(options)), selected_views(whole).size()));
}

Options parse_options(const std::vector<std::string>& arguments)
{
    if (arguments.empty()) return {};
    const std::string& first = arguments.front();
    std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
    Options options;
    if (first == "--version" || first == "-V") {
        options.verb = Verb::version;
        return options;
    }
    if (first == "--help" || first == "-h" || first == "help") return parse_help(rest);
    for (const Verb verb : all_verbs())
        if (name_of(verb) == first) {
            const auto accepted = accepted_options(verb);
            if (std::ranges::find(accepted, "--out") != accepted.end())
                std::ranges::replace(rest, std::string("-o"), std::string("--out"));
            return parse_verb(verb, rest);
        }
    reject_verb(first, names_of_verbs());
}

namespace {

/// Of the scene builder: what is left of a container's limit, so that it ends with a message and is not killed.
std::uint64_t usual_memory_limit()
{
    const std::uint64_t usual = BuildOptions{}.memory_limit_bytes, least = std::uint64_t{64} << 20; // 0 is no limit
    return std::clamp(ControlGroups().free_memory_bytes().value_or(usual), least, usual);
}

} // namespace

std::vector<SceneRequest> scene_requests(const Options& options)
{
    BuildOptions build = default_build(options.tets.front());
    build.domain = options.domains.front();
    if (!options.divisions.empty()) build.divisions = options.divisions.front();
    if (!options.switches.empty()) build.switches = options.switches.front();
    build.repair = options.repair.value_or(true);
    build.effort = options.effort;
    build.resolution = options.resolution;
    build.time_limit_s = options.time_limit_s;
    build.optimise_s = options.optimise_s;
    build.mesh_will_do = std::ranges::any_of(options.targets, is_bench_run) || options.verb == Verb::bench ||
                         options.verb == Verb::check || options.verb == Verb::render;
    build.keep_unfinished = options.verb == Verb::build;
    build.optimise_own = options.names_tets;
    build.memory_limit_bytes = options.memory_limit_bytes != 0 ? options.memory_limit_bytes : usual_memory_limit();
    const bool are_pinned = options.verb != Verb::build && is_usual_build(build);
    std::vector<SceneRequest> requests;
    for (const std::string& name : options.scenes)
        requests.push_back({name, build});
    if (options.scenes.empty())
        for (const std::string& name : default_scenes())
            requests.push_back({are_pinned ? default_scene(name) : name, build, true});
    return requests;
}

std::string camera_set_name(const Options& options)
{
    return options.own_cameras ? options.own_cameras->name : std::string(name_of(options.camera_set));
}

std::size_t camera_set_size(const Options& options)
{
    return options.own_cameras ? options.own_cameras->views.size() : view_count(options.camera_set);
}

Shard shard_of(const Options& options)
{
    return options.shard.value_or(Shard());
}

std::vector<std::uint32_t> selected_views(const Options& options)
{
    return dealt(
        parse_views(options.views, camera_set_size(options), options.verb == Verb::trace ? "--view" : "--views"),
        shard_of(options));
}

} // namespace tetrace
