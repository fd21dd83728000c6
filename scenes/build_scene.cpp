#include "scenes/build_scene.h"

#include "core/base/error.h"
#include "core/base/printable.h"
#include "scenes/builder_exit.h"
#include "scenes/child_process.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <sstream>
#include <string_view>
#include <unistd.h>

namespace tetrace {

namespace fs = std::filesystem;

namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool address_space_is_shadowed = true;
#elif defined(__has_feature)
constexpr bool address_space_is_shadowed = __has_feature(address_sanitizer);
#else
constexpr bool address_space_is_shadowed = false;
#endif

bool can_execute(const fs::path& path)
{
    std::error_code ignored; // what cannot be looked at cannot be executed
    return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

constexpr const char* builder_name = "tetrace-builder";
constexpr double min_mesh_only_s = 60;
constexpr double tetgen_share = 0.25; // of the time limit, for each of its attempts
constexpr double hang =
    10; // times its processor time by the clock: the builder waits for something, not for a processor
constexpr double to_check_and_write_s = 120; // what an interrupted optimiser has reached; a second Ctrl-C ends it

fs::path in_search_path()
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (!folder.empty() && can_execute(fs::path(folder) / builder_name)) return fs::path(folder) / builder_name;
    return {};
}

/// What the builder has said so far, line by line.
struct Report {
    std::string stage = "starting", detail;
    double fraction = -1; ///< of the stage
    std::vector<std::string> notes, errors;
    std::optional<std::vector<std::string>> notes_on_mesh; ///< those before TetGen began
    std::string last_words;                                ///< the last other line, for example of a failed assertion

    void take(const std::string& said)
    {
        const std::string line = printable_line(said);
        const auto rest = [&](std::string_view prefix) -> std::string {
            if (!line.starts_with(prefix)) return "";
            return line.substr(std::min(line.size(), line.find_first_not_of(' ', prefix.size())));
        };
        if (const std::string text = rest("stage: "); !text.empty())
            begin(text);
        else if (const std::string progress = rest("progress: "); !progress.empty())
            take_progress(progress);
        else if (const std::string note = rest("note: "); !note.empty())
            notes.push_back(note);
        else if (const std::string error = rest("error: "); !error.empty())
            errors.push_back(error);
        else if (!line.empty())
            last_words = line.substr(0, 300);
    }

private:
    void begin(const std::string& text)
    {
        if (text.starts_with("TetGen") || text.starts_with("CGAL")) notes_on_mesh = notes;
        stage = text;
        detail.clear();
        fraction = -1;
    }
    /// "0.25 round 2: ..."
    void take_progress(const std::string& text)
    {
        const std::size_t space = std::min(text.find(' '), text.size());
        const auto [end, problem] = std::from_chars(text.data(), text.data() + space, fraction);
        if (problem != std::errc() || !(fraction >= 0 && fraction <= 1)) fraction = -1;
        detail = text.substr(std::min(space + 1, text.size()));
    }
};

/// One way in which the builder can end without a scene.
struct Ending {
    ErrorKind kind;
    std::string what; ///< whether it happened
    std::string remedy;
    bool builder_knows = false; ///< the builder's own words hold the remedy; ours is for when it said nothing
};

Ending ending_of_exit(int code)
{
    switch (code) {
    case BUILDER_USAGE: return {ErrorKind::usage, "an option is not accepted", "check `--switches`", true};
    case BUILDER_BAD_MESH: return {ErrorKind::invalid_input, "the mesh cannot be used", "repair the mesh", true};
    case BUILDER_MISSING_FILE: return {ErrorKind::missing, "a file is missing", "check the paths", true};
    case BUILDER_INTERNAL:
        return {ErrorKind::internal, "the builder failed by its own fault (exit code 4)", "please report it"};
    case BUILDER_SELF_INTERSECTION:
        return {
            ErrorKind::invalid_input, "the mesh intersects itself",
            "leave out `--no-repair`, or repair the mesh so that its triangles meet only in shared edges and vertices",
            true};
    case BUILDER_TETGEN_REFUSED:
        return {ErrorKind::invalid_input, "no tets could be made",
                fmt::format("{}, or repair the mesh", try_other_switches), true};
    case BUILDER_ABSURD_OUTPUT:
        return {ErrorKind::invalid_input, "the tets failed the checks",
                fmt::format("{}, or repair the mesh", try_other_switches), true};
    case BUILDER_OUT_OF_MEMORY:
        return {ErrorKind::invalid_input, "the builder ran out of memory", std::string(allow_more_memory), true};
    default:
        return {ErrorKind::internal, fmt::format("the builder ended with exit code {}, which is none of its own", code),
                "check which program TETRACE_BUILDER and PATH lead to"};
    }
}

Ending ending_of(const ChildOutcome& outcome, const BuildOptions& options)
{
    using End = ChildOutcome::End;
    switch (outcome.end) {
    case End::timed_out:
        return {ErrorKind::invalid_input,
                fmt::format("the limit of {:g} s of processor time was reached", options.time_limit_s),
                fmt::format("allow more with `--time-limit`, or {}", try_other_switches)};
    case End::interrupted: return {ErrorKind::interrupted, "interrupted", "run it again to build the scene"};
    case End::signalled:
        return {
            ErrorKind::invalid_input,
            fmt::format("the builder crashed (signal {}, {})", outcome.code, ::strsignal(outcome.code)),
            fmt::format("{}, allow more memory with `--memory-limit`, or repair the mesh: self-intersections are the "
                        "usual cause",
                        try_other_switches)};
    case End::exited: break;
    }
    return ending_of_exit(outcome.code);
}

/// The builder's own words.
std::string finding(const Report& report)
{
    if (!report.errors.empty()) return fmt::format(": {}", fmt::join(report.errors, "; "));
    return report.last_words.empty() ? "" : fmt::format(", its last words: {}", report.last_words);
}

Error failure(const std::string& doing, const Ending& ending, const Report& report, double wall_s)
{
    const bool remedy_needed = !ending.builder_knows || report.errors.empty();
    return {ending.kind, fmt::format("{}: {}{} (last stage: {}{}){}{}", doing, ending.what, finding(report),
                                     report.stage, wall_s < 1 ? "" : fmt::format(", {:.1f} s", wall_s),
                                     remedy_needed ? "; " : "", remedy_needed ? ending.remedy : "")};
}

[[noreturn]] void fail_without_builder(const std::string& label)
{
    const char* given = std::getenv("TETRACE_BUILDER");
    const std::string looked = given != nullptr && *given != '\0'
                                   ? fmt::format("TETRACE_BUILDER names {}, which cannot be executed", given)
                                   : fmt::format("program {} is neither next to this one nor in PATH", builder_name);
    throw Error(
        ErrorKind::missing,
        fmt::format(
            "building scene {}: {}; install the packages libtet1.5-dev (libtet-dev after Debian 13) and libcgal-dev "
            "and build tetrace again, or let TETRACE_BUILDER name the program",
            label, looked));
}

/// The meshes that a run of the builder leaves for the next ones: a file for each tolerance, in the folder of the
/// scene.
class PreparedMeshes {
public:
    explicit PreparedMeshes(fs::path out) : out_(std::move(out)) {}

    [[nodiscard]] fs::path file(double tolerance) const { return fmt::format("{}.mesh{:g}", out_.string(), tolerance); }
    /// The builder speaks of a mesh only if it prepares it.
    void add_notes(double tolerance, Report& report)
    {
        const auto known = notes_.find(tolerance);
        if (known != notes_.end())
            report.notes.insert(report.notes.begin(), known->second.begin(), known->second.end());
        else if (report.notes_on_mesh)
            notes_.emplace(tolerance, *report.notes_on_mesh);
    }

private:
    fs::path out_;
    std::map<double, std::vector<std::string>> notes_;
};

std::vector<std::string> arguments_of(const fs::path& mesh, const fs::path& out, const fs::path& prepared,
                                      const std::string& label, const BuildOptions& options, const TetsAttempt& attempt)
{
    std::vector<std::string> arguments = {
        "--mesh",         mesh.string(),
        "--out",          out.string(),
        "--name",         label,
        "--domain",       std::string(name_of(options.domain)),
        "--divisions",    std::to_string(options.divisions),
        "--switches",     attempt.switches,
        "--order",        std::to_string(attempt.order),
        "--tets",         std::string(name_of(options.tets)),
        "--effort",       std::to_string(options.effort),
        "--tetgen-for",   fmt::format("{:g}", tetgen_share * options.time_limit_s),
        "--optimise-for", fmt::format("{:g}", options.optimise_s > 0 ? options.optimise_s : options.time_limit_s / 2)};
    if (options.optimise_own) arguments.emplace_back("--optimise-own");
    if (options.repair) arguments.insert(arguments.end(), {"--repair", "--weld", fmt::format("{}", attempt.weld)});
    if (!prepared.empty()) arguments.insert(arguments.end(), {"--prepared", prepared.string()});
    return arguments;
}

std::string text_of(const TetsAttempt& attempt)
{
    std::string text = attempt.switches;
    if (attempt.order >= 100) text += fmt::format(" with the domain's sides in {0} x {0} squares", attempt.order / 100);
    if (attempt.order % 100 > 0) text += fmt::format(" in order {}", attempt.order % 100);
    if (attempt.weld > 0) text += fmt::format(" welded at {:.2g}", attempt.weld);
    return text;
}

/// A builder that has ended, and what it said.
struct Run {
    ChildOutcome outcome;
    Report report;

    [[nodiscard]] bool is_good() const
    {
        return outcome.end == ChildOutcome::End::exited && outcome.code == BUILDER_GOOD;
    }
    /// Whether TetGen is to blame, so that other switches may help.
    [[nodiscard]] bool tetgen_failed() const
    {
        if (outcome.end == ChildOutcome::End::signalled) return !is_repairing();
        return outcome.end == ChildOutcome::End::exited &&
               (outcome.code == BUILDER_TETGEN_REFUSED || outcome.code == BUILDER_ABSURD_OUTPUT);
    }
    /// Whether triangles cross: there was no repair, or it had no end.
    [[nodiscard]] bool repair_failed() const
    {
        return outcome.end == ChildOutcome::End::exited && outcome.code == BUILDER_SELF_INTERSECTION;
    }
    /// Whether the repair was what it was ended in.
    [[nodiscard]] bool is_repairing() const { return report.stage.starts_with("repairing"); }
    /// Whether a scene of only the mesh is possible: rays can be traced through its triangles.
    [[nodiscard]] bool only_tets_failed() const
    {
        return tetgen_failed() || repair_failed() || outcome.end == ChildOutcome::End::signalled ||
               outcome.end == ChildOutcome::End::timed_out ||
               (outcome.end == ChildOutcome::End::exited && outcome.code == BUILDER_OUT_OF_MEMORY);
    }
};

Run run_builder(const fs::path& builder, const std::vector<std::string>& arguments, const std::string& label,
                const BuildOptions& options, const Progress& progress)
{
    Run run;
    // A scene's file is shorter than what it takes in memory.
    ChildLimits limits = {.time_s = hang * options.time_limit_s,
                          .processor_s = options.time_limit_s,
                          .memory_bytes = options.memory_limit_bytes,
                          .finish_s = options.keep_unfinished ? to_check_and_write_s : 0,
                          .file_bytes = options.memory_limit_bytes};
    // AddressSanitizer reserves terabytes of address space, in the builder of the same build too.
    if (address_space_is_shadowed) limits.memory_bytes = 0;
    run.outcome = run_child(
        builder, arguments, limits, [&](const std::string& line) { run.report.take(line); },
        [&](double processor_s) {
            if (!progress) return;
            // TetGen does not report its progress.
            const bool knows = run.report.fraction >= 0 || options.time_limit_s <= processor_s;
            const double max_minutes = std::ceil((options.time_limit_s - processor_s) / 60);
            progress(fmt::format("building {}: {}", label, run.report.stage), run.report.fraction,
                     knows ? run.report.detail : fmt::format("at most {:.0f} min of processor time more", max_minutes));
        });
    return run;
}

} // namespace

fs::path find_builder()
{
    if (const char* given = std::getenv("TETRACE_BUILDER"); given != nullptr && *given != '\0')
        return can_execute(given) ? fs::path(given) : fs::path();
    std::error_code ignored; // without /proc this place is skipped
    const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path() / builder_name;
    return can_execute(beside) ? beside : in_search_path();
}

BuildEnd build_scene(const fs::path& mesh, const fs::path& out, const std::string& label, const BuildOptions& options,
                     const Progress& progress, std::vector<std::string>& notes)
{
    const fs::path builder = find_builder();
    if (builder.empty()) fail_without_builder(label);
    TetsAttempt attempt{options.switches};
    double spent_s = 0;
    PreparedMeshes prepared(out);
    const auto run_attempt = [&] {
        BuildOptions limited = options;
        limited.time_limit_s -= spent_s;
        Run run = run_builder(builder, arguments_of(mesh, out, prepared.file(attempt.weld), label, options, attempt),
                              label, limited, progress);
        spent_s += run.outcome.processor_s;
        prepared.add_notes(attempt.weld, run.report);
        return run;
    };
    Run run = run_attempt();
    std::vector<std::string> failed{text_of(attempt)};
    double no_repair_at = 0; // the tolerance at which a repair failed: it would in every order
    for (const TetsAttempt& next : fallback_attempts(options)) {
        if (attempt.weld > 0 && run.repair_failed()) no_repair_at = attempt.weld;
        if (!run.tetgen_failed() && !(attempt.weld > 0 && run.repair_failed())) break;
        if (spent_s > 0.95 * options.time_limit_s) break;
        if (next.weld > 0 && next.weld == no_repair_at) continue;
        if (failed.size() == 1)
            notes.push_back(fmt::format("TetGen failed with switches {} ({}); trying others", failed.back(),
                                        ending_of(run.outcome, options).what));
        attempt = next;
        Run another = run_attempt();
        // Where CGAL fails too, or is too old, the reason is still TetGen's.
        if (next.switches == cgal_switches && !another.is_good()) break;
        failed.push_back(text_of(attempt));
        run = std::move(another);
    }
    if (run.is_good() && failed.size() > 1)
        notes.push_back(fmt::format("{}, at attempt {}",
                                    attempt.switches == cgal_switches
                                        ? "CGAL made the tets"
                                        : fmt::format("TetGen made the tets with switches {}", failed.back()),
                                    failed.size()));
    const auto add_notes = [&](const Run& of) {
        notes.insert(notes.end(), of.report.notes.begin(), of.report.notes.end());
    };
    if (run.is_good()) {
        add_notes(run);
        return {run.outcome.interrupted, std::nullopt};
    }
    const Error error =
        failure(fmt::format("building scene {} from {} with switches {}", label, mesh.string(),
                            failed.size() == 1 ? failed.front()
                                               : fmt::format("{} and {} other ways, the last {}", failed.front(),
                                                             failed.size() - 1, failed.back())),
                ending_of(run.outcome, options), run.report, run.outcome.wall_s);
    if (!options.mesh_will_do || !run.only_tets_failed()) throw error;
    BuildOptions mesh_only = options;
    mesh_only.time_limit_s = std::max(options.time_limit_s, min_mesh_only_s);
    if (run.repair_failed() || run.is_repairing()) mesh_only.repair = false;
    std::vector<std::string> arguments =
        arguments_of(mesh, out, prepared.file(0), label, mesh_only, {options.switches});
    arguments.emplace_back("--mesh-only");
    Run second = run_builder(builder, arguments, label, mesh_only, progress);
    prepared.add_notes(0, second.report);
    if (second.outcome.end == ChildOutcome::End::interrupted)
        throw Error(ErrorKind::interrupted, fmt::format("building scene {}: interrupted", label));
    if (!second.is_good()) throw error;
    add_notes(second);
    return {second.outcome.interrupted, error};
}

namespace {

/// what: the builder's option for it.
void run_for_mesh(const char* what, const fs::path& mesh, const fs::path& out, const std::string& label,
                  const BuildOptions& options, const Progress& progress, std::vector<std::string>& notes)
{
    const fs::path builder = find_builder();
    if (builder.empty()) fail_without_builder(label);
    auto arguments = arguments_of(mesh, out, {}, label, options, {options.switches});
    arguments.emplace_back(what);
    const Run run = run_builder(builder, arguments, label, options, progress);
    if (!run.is_good())
        throw failure(fmt::format("reading the mesh of {} from {}", label, mesh.string()),
                      ending_of(run.outcome, options), run.report, run.outcome.wall_s);
    notes.insert(notes.end(), run.report.notes.begin(), run.report.notes.end());
}

} // namespace

void build_mesh_only(const fs::path& mesh, const fs::path& out, const std::string& label, const BuildOptions& options,
                     const Progress& progress, std::vector<std::string>& notes)
{
    run_for_mesh("--mesh-only", mesh, out, label, options, progress, notes);
}

void read_mesh_only(const fs::path& mesh, const fs::path& out, const std::string& label, const Progress& progress,
                    std::vector<std::string>& notes)
{
    run_for_mesh("--as-read", mesh, out, label, {}, progress, notes);
}

std::vector<TetsAttempt> fallback_attempts(const BuildOptions& options)
{
    if (options.switches != default_build(options.tets).switches) return {};
    constexpr std::uint32_t first_orders = 5, orders_of_welds = 10, orders_of_quality = 5, orders_of_squares = 4,
                            all_orders = 32;
    const std::string careful = options.switches + "0/2/2", quality = default_build(TetsKind::cdt).switches;
    std::vector<TetsAttempt> all;
    if (options.switches != quality)
        for (const char* const unoptimised : {"O0", "T1e-13O0"})
            all.push_back({options.switches + unoptimised});
    for (std::uint32_t order = 0; order < first_orders; ++order)
        all.push_back({careful, order});
    const auto add_welded = [&](double weld) {
        for (std::uint32_t order = 0; options.repair && order < orders_of_welds; ++order)
            all.push_back({order == 0 ? options.switches : careful, order, weld});
    };
    const auto add_welded_quality = [&](double weld) {
        if (!options.repair || options.switches == quality) return;
        for (std::uint32_t order = 0; order < orders_of_quality; ++order)
            all.push_back({quality + "0/2/2", order, weld});
    };
    add_welded(0x1p-20); // before those that may take their whole share of the time
    const auto add_squares = [&](const std::vector<std::uint32_t>& along_a_side) {
        for (const std::uint32_t squares : along_a_side)
            for (std::uint32_t order = 0; order < orders_of_squares; ++order)
                all.push_back({careful, 100 * squares + order});
    };
    add_squares({5, 2, 3, 1});
    if (options.switches != quality) all.push_back({quality});
    all.push_back({quality + "MT1e-13"});
    for (std::uint32_t order = 0; order < orders_of_quality; ++order)
        all.push_back({"p", order});
    add_welded_quality(0x1p-20);
    for (const double weld : {0x1p-18, 0x1p-16}) {
        add_welded(weld);
        add_welded_quality(weld);
    }
    for (std::uint32_t order = first_orders; order < all_orders; ++order)
        all.push_back({careful, order});
    add_welded(0x1p-14);
    add_squares({4, 6, 7, 9, 10, 11, 12, 13, 14, 15, 16});
    all.push_back({"pMT1e-13"});
    all.push_back({std::string(cgal_switches)}); // it does not end on most near layers, so it comes last
    return all;
}

} // namespace tetrace
