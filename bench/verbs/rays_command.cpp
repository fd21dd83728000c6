#include "bench/judging/answers.h"
#include "bench/judging/made_rays.h"
#include "bench/output/report.h"
#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "bench/verbs/commands.h"
#include "bench/verbs/judged_mesh.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

void require_npy(const char* option, const std::filesystem::path& path)
{
    if (path.extension() != ".npy")
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: '{}' does not end in .npy, the format that is written; rename it", option, path.string()));
    check_writable(option, path);
}

void require_exact_numbers(const TriangleMesh& mesh)
{
    constexpr std::size_t most = 1u << 24; // float32 has each of these numbers
    if (mesh.triangles.size() > most)
        throw Error(
            ErrorKind::unsupported,
            fmt::format("--answers: float32 numbers only {} triangles, and the mesh has {}; leave out --answers", most,
                        mesh.triangles.size()));
}

std::vector<MeshRay> exact_rays(const std::vector<RayNumbers>& numbers)
{
    std::vector<MeshRay> rays;
    for (const auto& [x, y, z, t_min, dx, dy, dz, t_max] : numbers)
        rays.push_back({{x, y, z}, {dx, dy, dz}, t_min, t_max});
    return rays;
}

void write_answers(const std::filesystem::path& file, const TriangleMesh& mesh, const std::vector<RayNumbers>& rays,
                   unsigned threads)
{
    const NearestSearch search(mesh);
    write_npy(file, 4, right_answers(search, exact_rays(rays), threads, [](double done) {
                  progress_line().show("finding the exact answers", done);
              }));
    print(fmt::format("Answers: {} ({} by exact arithmetic)\n", file.string(), counted(rays.size(), "ray", "rays")));
}

} // namespace

int rays_command(const Options& options)
{
    require_one_mesh(options, "--scene SCENE");
    if (!options.out) throw Error(ErrorKind::usage, "rays: --out FILE.npy is missing: where to?");
    require_npy("--out", *options.out);
    if (options.answer_file) {
        require_npy("--answers", *options.answer_file);
        if (std::filesystem::absolute(*options.answer_file).lexically_normal() ==
            std::filesystem::absolute(*options.out).lexically_normal())
            throw Error(ErrorKind::usage, "--answers: it is the file of --out; name another one");
        check_not_an_input(*options.answer_file, {*options.out}, "--answers"); // by a link
    }
    const ReadMesh read = read_judged_mesh(options);
    if (options.answer_file) require_exact_numbers(read.mesh);
    std::vector<RayNumbers> rays;
    for (const MadeRays kind : options.made_rays.empty() ? values_of<MadeRays>() : options.made_rays) {
        progress_line().show(fmt::format("making {} rays", name_of(kind)), -1);
        const auto made = make_mesh_rays(kind, read.mesh, options.made_count);
        rays.insert(rays.end(), made.begin(), made.end());
    }
    write_npy(*options.out, 8, {rays.front().data(), 8 * rays.size()});
    if (!read.file.empty()) print(fmt::format("Mesh: {}\n", read.file.string()));
    print(fmt::format("Rays: {} ({})\n", options.out->string(), counted(rays.size(), "ray", "rays")));
    if (options.answer_file) write_answers(*options.answer_file, read.mesh, rays, options.threads);
    return 0;
}

} // namespace tetrace
