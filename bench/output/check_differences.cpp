#include "bench/output/check_differences.h"

#include "bench/terminal/text.h"
#include "bench/truth/walk_path.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

using Path = std::vector<std::uint32_t>;

constexpr std::uint32_t shown_tets = 200;

std::string face_text(std::uint32_t face)
{
    if (face == NO_HIT) return "no hit";
    if (face == LOST) return "lost";
    return fmt::format("triangle {}", face);
}

std::string hit_text(const Hit& hit)
{
    const std::string tet = hit.tet == NO_TET ? "no tet" : fmt::format("tet {}", hit.tet);
    return fmt::format("{}, t {:.9g}, u {:.9g}, v {:.9g}, {}, {} steps", face_text(hit.face_id), hit.t, hit.u, hit.v,
                       tet, hit.steps);
}

TraceJob job_of(const RowRun& row, std::uint32_t view)
{
    const auto& numbers = row.scene->view_numbers();
    const auto index = static_cast<std::size_t>(std::ranges::find(numbers, view) - numbers.begin());
    return row.scene->job(index, &row.packed->data, row.device);
}

/// Whether the tets of a ray's walk are listed. BVHs leave none; of given rays 'tetrace trace' lists them.
bool leaves_tets(const RowRun& row)
{
    return row.key.kernel.structure == Structure::cdt && row.key.kernel.task == Task::trace;
}

/// openmp's walk.
Path path_of(const RowRun& row, std::uint32_t view, std::uint32_t x, std::uint32_t y)
{
    if (row.packed == nullptr || !leaves_tets(row)) return {};
    KernelId kernel = row.key.kernel;
    kernel.schedule = Schedule::tiles;
    return walk_path(row.packed->data, kernel, job_of(row, view), x, y);
}

/// The device's own walk; empty where the device can no longer trace it.
Path own_path(const RowRun& row, const DifferingRay& ray)
{
    if (row.packed == nullptr || row.session == nullptr || !leaves_tets(row)) return {};
    try {
        return walk_path(*row.session, job_of(row, ray.view), ray.x, ray.y, shown_tets);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        return {};
    }
}

std::string path_text(const char* title, const Path& path)
{
    if (path.empty()) return {};
    std::string text = fmt::format("  {}:", title);
    for (std::size_t i = 0; i < std::min<std::size_t>(path.size(), shown_tets); ++i)
        text += fmt::format(" {}", path[i]);
    if (path.size() > shown_tets) text += fmt::format(" ... ({} in all)", path.size());
    return wrapped(text, 110, 2);
}

/// Where two walks diverge; empty where they do not.
std::string parting_text(const Path& ours, const Path& openmps)
{
    if (ours.empty() || openmps.empty()) return {};
    const auto [own, other] = std::mismatch(ours.begin(), ours.end(), openmps.begin(), openmps.end());
    if (own == ours.end() || other == openmps.end()) return {};
    return fmt::format("  The walks part at step {}: tet {} here, tet {} with openmp.\n", own - ours.begin() + 1, *own,
                       *other);
}

/// The command that follows the ray on this device and on openmp; empty for kernels that are not ours.
std::string trace_command(const RowRun& row, std::uint32_t view, std::uint32_t x, std::uint32_t y)
{
    if (row.scene == nullptr || row.scene->arguments().empty() || !is_portable(row.key.kernel)) return {};
    const KernelId& kernel = row.key.kernel;
    std::string text = fmt::format("tetrace trace {} --view {} --pixel {},{} --method {} --layout {}",
                                   row.scene->arguments(), view, x, y, name_of(kernel.method), name_of(kernel.layout));
    if (kernel.math != MathMode::exact) text += fmt::format(" --math {}", name_of(kernel.math));
    if (row.key.rays != RayKind::primary) text += fmt::format(" --rays {}", name_of(row.key.rays));
    if (row.key.ray_order != RayOrder::tiles) text += fmt::format(" --ray-order {}", name_of(row.key.ray_order));
    if (row.key.order != TetOrder::chains) text += fmt::format(" --order {}", name_of(row.key.order));
    if (kernel.schedule != Schedule::tiles) text += fmt::format(" --schedule {}", name_of(kernel.schedule));
    text += fmt::format(" --backend {}", row.key.backend);
    return row.key.device == 0 ? text : text + fmt::format(" --device {}:{}", row.key.backend, row.key.device);
}

/// "  Step by step: tetrace trace ...", in a line of its own, ready to paste.
std::string command_text(const std::string& command)
{
    return command.empty() ? std::string() : fmt::format("  Step by step: {}\n", command);
}

std::string different_text(const RowRun& row, const DifferingRay& ray)
{
    const Path ours = own_path(row, ray), openmps = path_of(row, ray.view, ray.x, ray.y);
    return fmt::format("{}: {} rays differ from openmp's, the first at view {}, pixel ({}, {})\n  this row: {}\n"
                       "  openmp:   {}\n{}{}{}{}\n",
                       row_name(row.key), traced(row)->different, ray.view, ray.x, ray.y, hit_text(ray.ours),
                       hit_text(ray.openmp), path_text("tets of this row", ours), path_text("tets of openmp", openmps),
                       parting_text(ours, openmps), command_text(trace_command(row, ray.view, ray.x, ray.y)));
}

std::string wrong_text(const RowRun& row, const WrongRay& ray)
{
    return fmt::format("{}: first wrong ray: view {}, pixel ({}, {}): {}\n  this row:  {}\n  exact ray: "
                       "{}, t {:.9g}\n{}{}\n",
                       row_name(row.key), ray.view, ray.x, ray.y, ray.reason, hit_text(ray.ours),
                       face_text(ray.reference_face), ray.reference_t,
                       path_text("tets of openmp", path_of(row, ray.view, ray.x, ray.y)),
                       command_text(trace_command(row, ray.view, ray.x, ray.y)));
}

} // namespace

std::string differences_text(const RowRun& row)
{
    const Traced* result = traced(row);
    if (result == nullptr) return {};
    std::string text;
    if (const auto& ray = result->first_different) text += different_text(row, *ray);
    if (const auto& ray = result->verdicts.first_wrong) text += wrong_text(row, *ray);
    return text;
}

void add_paths(nlohmann::json& row_json, const RowRun& row)
{
    const Traced* result = traced(row);
    if (result == nullptr) return;
    auto& verification = row_json["verification"];
    const auto add = [&](const char* key, const auto& ray) {
        if (leaves_tets(row)) verification[key]["path"] = path_of(row, ray.view, ray.x, ray.y);
        const std::string command = trace_command(row, ray.view, ray.x, ray.y);
        if (!command.empty()) verification[key]["command"] = command;
    };
    if (const auto& ray = result->verdicts.first_wrong) add("first_wrong", *ray);
    if (const auto& ray = result->first_different) {
        add("first_different", *ray);
        if (leaves_tets(row)) verification["first_different"]["own_path"] = own_path(row, *ray);
    }
}

} // namespace tetrace
