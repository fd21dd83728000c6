#include "core/base/error.h"
#include "core/base/printable.h"
#include "scenes/builder/build.h"
#include "scenes/builder/failure.h"
#include "scenes/builder/mesh_reader.h"
#include "scenes/builder/run_cgal.h"
#include "scenes/builder/run_tetgen.h"
#include "scenes/raw_mesh.h"
#include "scenes/scene_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <sys/time.h>
#include <unistd.h>

namespace {

using namespace tetrace;

void say(const char* kind, const std::string& what)
{
    const std::string text = printable_text(what);
    for (std::size_t begin = 0; begin <= text.size();) {
        const auto end = std::min(text.find('\n', begin), text.size());
        fmt::print(stderr, "{}: {}\n", kind, text.substr(begin, end - begin));
        begin = end + 1;
    }
}

void say_progress(double fraction, const std::string& detail)
{
    static std::optional<Stopwatch> since_last;
    if (since_last && since_last->seconds() < 0.1) return;
    since_last.emplace();
    say("progress", fmt::format("{:.4f} {}", fraction, detail));
}

BuilderTalk talk()
{
    return {[](const std::string& text) { say("stage", text); }, [](const std::string& text) { say("note", text); },
            say_progress};
}

// SIGINT asks the optimiser to end with what it has. Until TetGen is done it ends the program, as SIGTERM always does.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

void finish_when_interrupted(PreparedScene& prepared)
{
    prepared.limits.stop = &interrupted;
    std::signal(SIGINT, [](int) { interrupted.store(true); });
}

int code_of(ErrorKind kind)
{
    return kind == ErrorKind::invalid_input ? BUILDER_BAD_MESH : exit_code(kind);
}
static_assert(exit_code(ErrorKind::usage) == BUILDER_USAGE && exit_code(ErrorKind::missing) == BUILDER_MISSING_FILE &&
                  exit_code(ErrorKind::internal) == BUILDER_INTERNAL,
              "the program's codes are the builder's, but for a bad mesh");

// Runs one part of the work; reports why it failed.
template <class Work>
int guarded(const Work& work)
{
    try {
        work();
        return BUILDER_GOOD;
    } catch (const Error& error) {
        say("error", error.what());
        return code_of(error.kind());
    } catch (const BuilderFailure& failure) {
        say("error", failure.what());
        return failure.code();
    } catch (const std::bad_alloc&) {
        say("error", fmt::format("out of memory; {}", allow_more_memory));
        return BUILDER_OUT_OF_MEMORY;
    } catch (const std::exception& unexpected) {
        say("error", fmt::format("internal: {}; please report it with the mesh", unexpected.what()));
        return BUILDER_INTERNAL;
    }
}

// Nothing if the command line is complete, else the exit code.
std::optional<int> parse(int argc, char** argv, BuilderOptions& options)
{
    CLI::App app{
        "Builds a tetrace scene: reads a mesh of triangles (PLY, OBJ, OFF, STL, glTF) or tets (MEDIT, Gmsh, TetGen, "
        "VTK), checks it,\n"
        "tetrahedralizes the rest of its domain with "
        "TetGen and writes a .tet file. `tetrace build` runs it; it links CGAL (GPL) and TetGen (AGPL), "
        "tetrace does not.",
        "tetrace-builder"};
    app.set_version_flag("--version", builder_tool());
    app.add_option("--mesh", options.mesh, "mesh file to read")->required()->type_name("FILE");
    app.add_option("--out", options.out, "scene file to write, replaced as a whole")->required()->type_name("FILE.tet");
    app.add_option("--prepared", options.prepared,
                   "the mesh as read, repaired and placed: read this file if it is there, else write it; for runs with "
                   "other switches or orders")
        ->type_name("FILE");
    app.add_option("--name", options.name, "name of the scene; default: the mesh file's")->type_name("NAME");
    std::string domain(name_of(options.domain));
    const std::string tight(name_of(DomainKind::tight)), wide(name_of(DomainKind::wide));
    app.add_option("--domain", domain,
                   "tight: the mesh's box grown by 2 %; wide: a cube of half-size 3 radii; default: tight")
        ->check(CLI::IsMember({tight, wide}).description(""))
        ->type_name(tight + "|" + wide);
    app.add_option("--divisions", options.divisions, "squares along each side of the domain, 1 to 64; default: 8")
        ->check(CLI::Range(1, 64).description(""))
        ->type_name("N");
    app.add_option("--switches", options.switches,
                   "TetGen's switches, or cgal: CGAL makes the tets (6.1 and later); default: pq5Y")
        ->type_name("SWITCHES");
    app.add_option("--order", options.order,
                   "N: give TetGen vertices and triangles in the Nth order at random; from 100 on, the domain's sides "
                   "in N / 100 squares, too; default: 0, as they are")
        ->type_name("N")
        ->check(CLI::Range(0, 6499));
    app.add_flag("--repair", options.repair,
                 "cut triangles that cross along their intersections, in place of refusing");
    app.add_option("--weld", options.weld,
                   "with --repair: merge what is nearer than this, in units of the domain, whose longest side "
                   "has 1 to 2; default: 0, only if an exact repair never ends")
        ->check(CLI::Range(0.0, weld_tolerances.back()).description(""))
        ->type_name("T");
    app.add_option(
           "--tetgen-for", options.tetgen_for_s,
           "the tets cannot be made if that takes more than this many seconds of processor time; default: 0, no limit")
        ->check(CLI::Range(0.0, 1e6).description(""))
        ->type_name("S");
    app.add_flag("--as-read", options.as_read,
                 "write only the triangles as the file has them, not cleaned, placed or checked, for tetrace judge");
    app.add_flag("--mesh-only", options.mesh_only,
                 "write a scene without tets, which BVHs can be built of; TetGen does not run");
    std::string tets(name_of(options.tets));
    const std::string cdt(name_of(TetsKind::cdt)), rays(name_of(TetsKind::rays));
    app.add_option("--tets", tets,
                   "cdt: as TetGen makes them; rays: then optimised, so that rays cross fewer faces, from a graded "
                   "set of points unless the switches have q or O0, or --weld is given; default: cdt")
        ->check(CLI::IsMember({cdt, rays}).description(""))
        ->type_name(cdt + "|" + rays);
    app.add_option("--effort", options.effort, "of the optimiser, 0 (none, and no more points) to 3; default: 2")
        ->check(CLI::Range(0, max_effort).description(""))
        ->type_name("N");
    app.add_option("--optimise-for", options.optimise_for_s,
                   "the optimiser stops after this many seconds, with the tets reached so far; default: 300")
        ->check(CLI::Range(0.0, 1e6).description(""))
        ->type_name("S");
    app.add_flag("--optimise-own", options.optimise_own,
                 "with --tets rays: optimise the tets of a file of tets too, within their regions");
    app.footer("After SIGINT the optimiser ends, and what it has reached is checked and written.\n"
               "Exit codes: 0 good; 2 usage; 3 file missing; 4 internal; 5 bad mesh; 10 self-intersections; 11 no "
               "tets could be made;\n"
               "12 the tets failed a check; 13 out of memory.");
    try {
        app.parse(argc, argv);
        options.domain = domain == wide ? DomainKind::wide : DomainKind::tight;
        options.tets = tets == rays ? TetsKind::rays : TetsKind::cdt;
        return std::nullopt;
    } catch (const CLI::Success& asked) {
        return app.exit(asked);
    } catch (const CLI::ParseError& wrong) {
        say("error", fmt::format("reading the command line: {}; see tetrace-builder --help", wrong.what()));
        return BUILDER_USAGE;
    }
}

void require_out_folder(const std::filesystem::path& out)
{
    const auto folder = out.has_parent_path() ? out.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(folder))
        throw Error(ErrorKind::missing, fmt::format("writing {}: folder {} does not exist; create it first",
                                                    out.string(), folder.string()));
}

void write_as_read(const BuilderOptions& options)
{
    require_out_folder(options.out);
    const MeshSoup soup = read_mesh(options.mesh);
    for (const std::string& text : soup.notes)
        say("note", text);
    if (soup.centre != Double3{})
        throw Error(ErrorKind::invalid_input,
                    fmt::format("reading mesh {}: its coordinates are too large for its size to be rounded to float32; "
                                "subtract its centre, ({}, {}, {}), from its vertices and from the rays",
                                options.mesh.string(), soup.centre.x, soup.centre.y, soup.centre.z));
    write_raw_mesh(options.out, soup.mesh);
}

void write_mesh_only(const std::filesystem::path& out, PreparedScene& prepared)
{
    prepared.scene.build.switches.clear();
    prepared.scene.build.build_s = prepared.watch.seconds();
    write_scene(out, prepared.scene);
}

// Ends the program when it has used this many seconds of processor time from now on, with words that a handler may
// write; 0: no longer.
void begin_limit(double seconds)
{
    std::signal(SIGPROF, [](int) {
        constexpr std::string_view text =
            "error: the tets were not made within their share of the limit of time; allow more with "
            "tetrace's --time-limit\n";
        [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
        ::_exit(BUILDER_TETGEN_REFUSED);
    });
    const double whole = std::floor(seconds);
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(whole);
    timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - whole) * 1e6);
    ::setitimer(ITIMER_PROF, &timer, nullptr);
}

} // namespace

int main(int argc, char** argv)
{
    BuilderOptions options;
    if (const auto code = parse(argc, argv, options)) return *code;
    if (options.as_read) return guarded([&] { write_as_read(options); });
    PreparedScene prepared;
    int code = guarded([&] {
        if (options.switches != cgal_switches) require_switches(options.switches);
        require_out_folder(options.out);
        prepared = prepare_scene(options, talk());
    });
    if (code != BUILDER_GOOD) return code;
    if (options.mesh_only) return guarded([&] { write_mesh_only(options.out, prepared); });

    begin_limit(options.tetgen_for_s);
    RawTets output;
    if (options.switches == cgal_switches) {
        say("stage", "CGAL's tets");
        code = guarded([&] { output = run_cgal(prepared.facets(), prepared.surface, prepared.points); });
        if (code != BUILDER_GOOD) return code;
    } else {
        say("stage", "TetGen " + options.switches);
        std::set_terminate(explain_tetgen_failure); // and the call is not inside a handler: see run_tetgen
        output =
            run_tetgen(prepared.facets(), prepared.surface, prepared.points, options.switches, options.order % 100);
    }
    begin_limit(0);
    finish_when_interrupted(prepared);
    return guarded([&] {
        const Scene scene = finish_scene(std::move(prepared), output, talk());
        talk().stage("writing " + options.out.filename().string());
        write_scene(options.out, scene);
    });
}
