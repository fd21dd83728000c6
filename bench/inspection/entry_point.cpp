#include "bench/inspection/entry_point.h"

#include <algorithm>

namespace tetrace {

namespace {

template <class T>
bool keeps(const std::vector<T>& list, const T& value)
{
    return list.empty() || std::ranges::find(list, value) != list.end();
}

void add_entries(std::vector<EntryPoint>& points, const KernelId& kernel)
{
    points.push_back({kernel, Entry::outside});
    if (kernel.structure == Structure::cdt) points.push_back({kernel, Entry::inside});
    for (const auto& [task, entry] : {std::pair{Task::rays, Entry::rays}, std::pair{Task::search, Entry::search}}) {
        KernelId other = kernel;
        other.task = task;
        if (has_task(other)) points.push_back({other, entry});
    }
}

} // namespace

std::vector<EntryPoint> all_entry_points(Maker maker)
{
    std::vector<EntryPoint> points;
    for (const KernelId& kernel : all_kernels()) {
        const bool is_there =
            kernel.schedule == Schedule::tiles || (maker == Maker::nvidia && kernel.schedule == Schedule::persistent);
        if (is_portable(kernel) && is_there) add_entries(points, kernel);
    }
    return points;
}

bool wants(const Options& options, const EntryPoint& point)
{
    const KernelId& kernel = point.kernel;
    const bool wants_method = options.methods.empty() ? is_default(kernel) : keeps(options.methods, kernel.method);
    const bool wants_math = options.math.empty() ? kernel.math == MathMode::exact : keeps(options.math, kernel.math);
    return keeps(options.structures, kernel.structure) && wants_method && wants_math &&
           keeps(options.layouts, kernel.layout) && keeps(options.schedules, kernel.schedule) &&
           keeps(options.entries, point.entry);
}

std::string name_of(const EntryPoint& point)
{
    const std::string name(name_of(point.entry));
    return point.kernel.schedule == Schedule::tiles ? name : name + " persistent";
}

} // namespace tetrace
