#include "bench/measuring/ray_walks.h"

#include "bench/truth/walk_path.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

using Path = std::vector<std::uint32_t>;

constexpr std::uint32_t recorded_tets = 200; ///< of a device's walk, which is traced anew for each

TraceJob job_of_number(const RowRun& row, std::uint32_t view)
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
    return walk_path(row.packed->data, kernel, job_of_number(row, view), x, y);
}

/// The device's own walk; empty if the device can no longer trace it.
Path own_path(const RowRun& row, const DifferingRay& ray)
{
    if (row.packed == nullptr || row.session == nullptr || !leaves_tets(row)) return {};
    try {
        return walk_path(*row.session, job_of_number(row, ray.view), ray.x, ray.y, recorded_tets);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        return {};
    }
}

/// verb: of a command on one ray of the row.
std::string ray_command(const char* verb, const RowRun& row, std::uint32_t view, std::uint32_t x, std::uint32_t y)
{
    if (row.scene == nullptr || row.scene->arguments().empty() || !is_portable(row.key.kernel)) return {};
    const KernelId& kernel = row.key.kernel;
    std::string text = fmt::format("tetrace {} {} --view {} --pixel {},{} --method {} --layout {}", verb,
                                   row.scene->arguments(), view, x, y, name_of(kernel.method), name_of(kernel.layout));
    if (const Task task = asked_task(kernel.task); task != Task::trace)
        text += fmt::format(" --task {}", name_of(task));
    if (kernel.math != MathMode::exact) text += fmt::format(" --math {}", name_of(kernel.math));
    if (row.key.rays != RayKind::primary) text += fmt::format(" --rays {}", name_of(row.key.rays));
    if (row.key.ray_order != RayOrder::tiles) text += fmt::format(" --ray-order {}", name_of(row.key.ray_order));
    if (row.key.order != TetOrder::chains) text += fmt::format(" --order {}", name_of(row.key.order));
    if (kernel.schedule != Schedule::tiles) text += fmt::format(" --schedule {}", name_of(kernel.schedule));
    text += fmt::format(" --backend {}", row.key.backend);
    return row.key.device == 0 ? text : text + fmt::format(" --device {}:{}", row.key.backend, row.key.device);
}

} // namespace

std::string trace_command(const RowRun& row, std::uint32_t view, std::uint32_t x, std::uint32_t y)
{
    return traits_of(row.key.kernel.task).finds_hits ? ray_command("trace", row, view, x, y) : std::string();
}

std::string dump_command(const RowRun& row, std::uint32_t view, std::uint32_t x, std::uint32_t y)
{
    return ray_command("dump", row, view, x, y);
}

void note_walks(RowRun& row)
{
    Traced* const result = std::get_if<Traced>(&row.outcome);
    if (result == nullptr) return;
    if (const auto& ray = result->verdicts.first_wrong)
        result->walk_of_wrong = {
            path_of(row, ray->view, ray->x, ray->y), {}, trace_command(row, ray->view, ray->x, ray->y)};
    if (const auto& ray = result->first_different)
        result->walk_of_different = {path_of(row, ray->view, ray->x, ray->y), own_path(row, *ray),
                                     trace_command(row, ray->view, ray->x, ray->y)};
}

} // namespace tetrace
