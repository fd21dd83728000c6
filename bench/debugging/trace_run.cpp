#include "bench/debugging/trace_run.h"

#include "bench/debugging/one_kernel.h"
#include "bench/measuring/scene_rows.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

KernelId kernel_with_steps(const Options& options)
{
    if (options.orders.size() > 1) throw Error(ErrorKind::usage, "trace: --order takes one value here");
    const KernelId kernel = one_kernel(options);
    if (kernel.structure != Structure::cdt || !is_portable(kernel))
        throw Error(ErrorKind::usage,
                    fmt::format("trace: {} has no steps from tet to tet; take a method of the cdt", name_of(kernel)));
    return kernel;
}

/// The rows of the kernel, and openmp's first.
std::vector<RowKey> keys_of(const Options& options)
{
    const KernelId kernel = kernel_with_steps(options);
    Options one = options;
    one.structures = {kernel.structure};
    one.methods = {kernel.method};
    one.layouts = {kernel.layout};
    one.math = {kernel.math};
    if (one.schedules.empty()) one.schedules = {Schedule::tiles};
    std::vector<RowKey> keys = selected_rows(one, [](const std::string&) { return true; });
    const RowKey reference = reference_row(keys.front());
    std::erase(keys, reference);
    keys.insert(keys.begin(), reference);
    return keys;
}

} // namespace

TraceRun run_trace(const Options& options)
{
    const std::vector<RowKey> keys = keys_of(options);
    TraceRun run;
    run.scene = std::make_unique<SceneWork>(load_work(scene_requests(options).front(), options));
    run.ray = ray_of(run.scene->views().front(), *options.pixel);
    run.rows.reserve(keys.size()); // rays refer to rows
    for (const RowKey& key : keys) {
        RowRun& row = run.rows.emplace_back(open_row(key, *run.scene, options));
        if (row.session == nullptr) continue;
        guarded(row, [&] { run.rays.push_back(follow_ray(row, 0, *options.pixel)); });
    }
    return run;
}

bool differs(const RayOnDevice& ray, const RayOnDevice& reference)
{
    if (!reference_of(ray.row->key)) return false;
    return first_difference(ray, reference).has_value() || !is_same_hit(ray.hit, reference.hit, allowance_of(*ray.row));
}

} // namespace tetrace
