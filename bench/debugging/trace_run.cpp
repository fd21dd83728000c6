#include "bench/debugging/trace_run.h"

#include "bench/debugging/one_kernel.h"
#include "bench/measuring/scene_rows.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

KernelId our_kernel(const Options& options)
{
    for (const auto& [option, count] :
         {std::pair("--order", options.orders.size()), std::pair("--rays", options.rays.size()),
          std::pair("--ray-order", options.ray_orders.size())})
        if (count > 1) throw Error(ErrorKind::usage, fmt::format("trace: {} accepts one value here", option));
    const KernelId kernel = one_kernel(options);
    if (!is_portable(kernel))
        throw Error(ErrorKind::usage,
                    fmt::format("trace: {} is not one of tetrace's kernels: it returns only the hit; use a method "
                                "of the cdt, or layout bvh2, bvh4 or cwbvh",
                                name_of(kernel)));
    return kernel;
}

/// The rows of the kernel, and openmp's first.
std::vector<RowKey> keys_of(const Options& options)
{
    const KernelId kernel = our_kernel(options);
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
    run.ray = ray_of(*run.scene, keys.front(), 0, *options.pixel);
    run.rows.reserve(keys.size()); // rays refer to rows
    for (const RowKey& key : keys) {
        RowRun& row = run.rows.emplace_back(open_row(key, *run.scene, options));
        if (row.session == nullptr) continue;
        guarded(row, [&] { run.rays.push_back(follow_ray(row, 0, *options.pixel)); });
    }
    return run;
}

const RayOnDevice* TraceRun::reference() const
{
    return !rays.empty() && rays.front().row == &rows.front() ? &rays.front() : nullptr;
}

bool differs(const RayOnDevice& ray, const RayOnDevice& reference)
{
    if (!reference_of(ray.row->key)) return false;
    return first_difference(ray, reference).has_value() || !is_same_hit(ray.hit, reference.hit, allowance_of(*ray.row));
}

} // namespace tetrace
