#include "bench/debugging/trace_run.h"

#include "bench/debugging/dump.h"
#include "bench/debugging/trace_sheet.h"
#include "bench/measuring/scene_rows.h"
#include "bench/output/row_fields.h"
#include "bench/rows/ray_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tetrace {

namespace {

KernelId our_kernel(const Options& options)
{
    for (const auto& [option, count] :
         {std::pair("--order", options.orders.size()), std::pair("--rays", options.rays.size()),
          std::pair("--ray-order", options.ray_orders.size()), std::pair("--task", options.tasks.size())})
        if (count > 1)
            throw Error(ErrorKind::usage, fmt::format("{}: {} accepts one value here", name_of(options.verb), option));
    const KernelId kernel = one_kernel(options);
    if (!is_portable(kernel))
        throw Error(ErrorKind::usage,
                    fmt::format("{}: {} is not one of tetrace's kernels: it returns only the hit; use a method "
                                "of the cdt, or layout bvh2, bvh4 or cwbvh",
                                name_of(options.verb), name_of(kernel)));
    return kernel;
}

} // namespace

std::vector<RowKey> rows_of_ray(const Options& options)
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

TraceRun run_trace(const Options& options)
{
    const std::vector<RowKey> keys = rows_of_ray(options);
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

namespace {

nlohmann::json step_json(const RayStep& step)
{
    nlohmann::json object = {{"beyond", step.beyond}};
    if (step.tet) object["tet"] = *step.tet;
    if (step.face) object["face"] = *step.face;
    if (step.face) object["products"] = step.products;
    return object;
}

nlohmann::json row_json(const RowRun& row)
{
    nlohmann::json object = {{"backend", row.key.backend},
                             {"device_index", row.key.device},
                             {"schedule", name_of(row.key.kernel.schedule)},
                             {"status", name_of(status_of(row))}};
    if (!row.device.name.empty()) object["device"] = row.device.name;
    if (!row.device.driver.empty()) object["driver"] = row.device.driver;
    if (const std::string reason = reason_of(row); !reason.empty()) object["reason"] = reason;
    return object;
}

nlohmann::json device_json(const RowRun& row, const TraceRun& run)
{
    nlohmann::json object = row_json(row);
    const auto ray = std::ranges::find(run.rays, &row, &RayOnDevice::row);
    if (ray == run.rays.end()) return object;
    const auto named = [&](Hit hit) {
        hit.face_id = source_triangle(run.scene->loaded().scene, hit.face_id);
        return hit_json(hit);
    };
    object["hit"] = named(ray->hit);
    object["alone"] = named(ray->alone);
    object["steps"] = nlohmann::json::array();
    for (const RayStep& step : ray->steps)
        object["steps"].push_back(step_json(step));
    object["steps_cut"] = ray->is_cut;
    if (ray->visits.rays > 0) object["visits"] = {{"nodes", ray->visits.nodes}, {"triangles", ray->visits.triangles}};
    const RayOnDevice* const reference = run.reference();
    if (reference == nullptr) return object;
    if (const auto at = first_difference(*ray, *reference)) object["first_difference"] = *at + 1;
    object["differs"] = differs(*ray, *reference);
    return object;
}

/// What is not as it is of primary rays, and of tets in chains.
void add_given(nlohmann::json& trace, const RowKey& key, const PixelRay& ray, const Scene& scene)
{
    if (key.order != TetOrder::chains) trace["order"] = name_of(key.order);
    if (key.ray_order != RayOrder::tiles) trace["ray_order"] = name_of(key.ray_order);
    if (!ray.given) return;
    const GivenRay& given = *ray.given;
    trace["rays"] = name_of(key.rays);
    if (given.end < NO_END) trace["end"] = given.end;
    if (given.half_face == NO_HALF_FACE || key.kernel.structure != Structure::cdt) return; // a BVH starts at a point
    trace["start"] = {{"tet", half_face_tet(given.half_face)}, {"face", half_face_index(given.half_face)}};
    if (given.triangle != FREE_FACE) trace["start"]["triangle"] = source_triangle(scene, given.triangle);
}

nlohmann::json trace_json(const TraceRun& run, const Options& options)
{
    const KernelId& kernel = run.rows.front().key.kernel;
    const auto numbers = [](const Float3& vector) { return nlohmann::json{vector.x, vector.y, vector.z}; };
    nlohmann::json trace = {{"method", name_of(kernel.method)},
                            {"layout", name_of(kernel.layout)},
                            {"math", name_of(kernel.math)},
                            {"view", run.scene->view_numbers().front()},
                            {"pixel", {options.pixel->x, options.pixel->y}},
                            {"origin", numbers(run.ray.origin)},
                            {"direction", numbers(run.ray.direction)},
                            {"devices", nlohmann::json::array()}};
    add_given(trace, run.rows.front().key, run.ray, run.scene->loaded().scene);
    for (const RowRun& row : run.rows)
        trace["devices"].push_back(device_json(row, run));
    nlohmann::json section = result_head(options);
    section["scenes"] = nlohmann::json::array();
    section["scenes"].push_back(scene_json(*run.scene, options));
    section["trace"] = std::move(trace);
    return {{"tetrace", std::move(section)}};
}

} // namespace

Report trace_report(const TraceRun& run, const Options& options)
{
    // As a file has it: what is not finite is null there.
    const nlohmann::json json =
        nlohmann::json::parse(trace_json(run, options).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    ShownTrace shown = shown_trace(ResultValue(json, "the trace").at("tetrace"));
    Report report{std::move(shown.sheet), std::move(shown.table), json};
    report.markdown = report.sheet.markdown();
    if (options.out) report.sheet.labelled("Result", options.out->string());
    return report;
}

} // namespace tetrace
