#include "bench/judging/answers.h"
#include "bench/judging/judged_report.h"
#include "bench/options/identity.h"
#include "bench/output/report.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "bench/verbs/commands.h"
#include "bench/verbs/judged_mesh.h"
#include "core/base/files.h"
#include "core/base/stopwatch.h"

#include <cmath>
#include <fmt/format.h>

namespace tetrace {

void require_one_mesh(const Options& options, const char* option)
{
    if (options.scenes.size() != 1)
        throw Error(ErrorKind::usage, fmt::format("{}: {} is {}: which mesh?", name_of(options.verb), option,
                                                  options.scenes.empty() ? "missing" : "given several times"));
}

ReadMesh read_judged_mesh(const Options& options)
{
    ReadMesh read = read_mesh_of(options.scenes.front(), progress_line().callback());
    for (const std::string& message : read.messages)
        say("tetrace: " + message);
    for (std::size_t i = 0; i < read.mesh.vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(static_cast<double>(read.mesh.vertices[i][axis])) > max_coordinate)
                throw Error(
                    ErrorKind::invalid_input,
                    fmt::format("reading {}: vertex {} has a coordinate above 2^120; scale the mesh and the rays "
                                "down",
                                options.scenes.front(), i));
    return read;
}

namespace {

/// The files that were judged.
struct JudgedFiles {
    NpyArray rays, hits;
};

JudgedFiles read_files(const Options& options)
{
    JudgedFiles files{read_npy(*options.ray_file, 8, "origin, t_min, direction, t_max of each ray"),
                      read_npy(*options.hit_file, 4, "face, t, u, v of each ray")};
    if (files.rays.rows != files.hits.rows)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("judge: {} has {} rays, and {} has {} answers; give one answer for each ray",
                                options.ray_file->string(), files.rays.rows, options.hit_file->string(),
                                files.hits.rows));
    if (files.rays.rows == 0)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("judge: {} has no rays; write at least one", options.ray_file->string()));
    return files;
}

void stop_if_interrupted()
{
    if (is_interrupted()) throw Error(ErrorKind::interrupted, "judge: interrupted; not all answers were judged");
}

JudgedRun judged_run(const Options& options)
{
    const JudgedFiles files = read_files(options);
    const auto rays = mesh_rays_of(files.rays, *options.ray_file);
    const auto answers = mesh_answers_of(files.hits, *options.hit_file);
    const ReadMesh read = read_judged_mesh(options);
    JudgedRun run;
    note_mesh(run, options.scenes.front(), read.mesh);
    run.rays = rays.size();
    run.rays_are_double = files.rays.is_double;
    run.hits_are_double = files.hits.is_double;
    run.tolerance = {run.rays_are_double && run.hits_are_double ? 0x1p-53 : 0x1p-24, options.slack};
    const Stopwatch watch;
    const NearestSearch search(read.mesh);
    run.counts = judge_answers({read.mesh, search, run.tolerance}, rays, answers, options.threads, [](double done) {
        stop_if_interrupted();
        progress_line().show("judging", done);
    });
    stop_if_interrupted();
    run.seconds = watch.seconds();
    return run;
}

void write_judged_junit(const Options& options, std::string xml)
{
    if (!options.junit) return;
    if (options.anonymous) xml = anonymous_text(xml, options);
    if (prints_junit(options))
        print(xml);
    else
        write_whole(*options.junit, xml);
}

void require_files(const Options& options)
{
    require_one_mesh(options, "--mesh MESH");
    if (!options.ray_file) throw Error(ErrorKind::usage, "judge: --ray-file FILE.npy is missing: which rays?");
    if (!options.hit_file) throw Error(ErrorKind::usage, "judge: --hits FILE.npy is missing: whose answers?");
    check_output(options);
    if (options.out) check_not_an_input(*options.out, {*options.ray_file, *options.hit_file});
    if (!options.junit || prints_junit(options)) return;
    check_not_an_input(*options.junit, {*options.ray_file, *options.hit_file}, "--junit");
    check_writable("--junit", *options.junit);
}

} // namespace

int judge_command(const Options& options)
{
    require_files(options);
    const StopWhenInterrupted stop;
    if (options.junit) something_to_keep(); // JUnit then says that the run was ended
    try {
        const JudgedRun run = judged_run(options);
        deliver_besides_junit(options, judged_report(run, options));
        write_judged_junit(options, judged_junit(run));
        return run.counts.faults() == 0 ? 0 : exit_code(ErrorKind::wrong_result);
    } catch (const Error& error) {
        write_judged_junit(options, judged_junit_of(error.what()));
        throw;
    }
}

} // namespace tetrace
