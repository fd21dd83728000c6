#include "bench/output/row_json.h"

#include "bench/measuring/figures.h"
#include "bench/output/device_json.h"
#include "bench/output/self_test_json.h"
#include "bench/rows/row_tracing.h"
#include "core/base/hash.h"

namespace tetrace {

namespace {

using nlohmann::json;

template <class T>
void set_if(json& object, const char* key, const std::optional<T>& value)
{
    if (value) object[key] = *value;
}

json key_json(const RowKey& key)
{
    return {{"name", row_name(key)},
            {"scene", key.scene},
            {"structure", name_of(key.kernel.structure)},
            {"method", name_of(key.kernel.method)},
            {"layout", name_of(key.kernel.layout)},
            {"backend", key.backend},
            {"rays", name_of(key.rays)},
            {"ray_order", name_of(key.ray_order)},
            {"math", name_of(key.kernel.math)},
            {"order", name_of(key.order)}};
}

json visits_json(const Visits& visits)
{
    const auto rays = static_cast<double>(visits.rays);
    return {{"nodes", visits.nodes},
            {"triangles", visits.triangles},
            {"mean_nodes", static_cast<double>(visits.nodes) / rays},
            {"mean_triangles", static_cast<double>(visits.triangles) / rays}};
}

json counts_json(const RayTotals& totals)
{
    json counts = {{"rays", totals.rays}, {"hits", totals.hits}, {"misses", totals.misses}, {"lost", totals.lost}};
    if (totals.steps() == 0) return counts;
    const MeanSteps mean = mean_steps(totals);
    counts["steps"] = totals.steps();
    set_if(counts, "mean_steps", mean.all);
    set_if(counts, "mean_steps_hit", mean.hit);
    set_if(counts, "mean_steps_miss", mean.miss);
    return counts;
}

json wrong_ray_json(const WrongRay& ray)
{
    return {{"view", ray.view},
            {"x", ray.x},
            {"y", ray.y},
            {"reason", ray.reason},
            {"ours", hit_json(ray.ours)},
            {"embree", {{"face_id", ray.reference_face}, {"t", ray.reference_t}}}};
}

json verification_json(const Traced& result)
{
    const Verdicts& verdicts = result.verdicts;
    json object = {{"rays", verdicts.rays},     {"agreed", verdicts.agreed},
                   {"ties", verdicts.ties},     {"settled", verdicts.settled},
                   {"offset", verdicts.offset}, {"wrong", verdicts.wrong},
                   {"lost", verdicts.lost},     {"compared_with_openmp", result.compared}};
    if (verdicts.ties > 0) object["largest_tie_distance"] = verdicts.largest_tie_distance;
    if (result.compared) {
        object["different_from_openmp"] = result.different;
        object["largest_ulps"] = result.largest_ulps;
    }
    if (result.first_different) {
        const DifferingRay& ray = *result.first_different;
        object["first_different"] = {{"view", ray.view},
                                     {"x", ray.x},
                                     {"y", ray.y},
                                     {"ours", hit_json(ray.ours)},
                                     {"openmp", hit_json(ray.openmp)}};
    }
    if (verdicts.first_wrong) object["first_wrong"] = wrong_ray_json(*verdicts.first_wrong);
    return object;
}

json times_json(const RowRun& row, const Traced& result)
{
    const SetupTimes setup = row.session ? row.session->setup_times() : SetupTimes{};
    json times = {{"clock", row.backend->clock()},
                  {"first_kernel_s", result.kernel_s},
                  {"first_wall_s", result.wall_s},
                  {"download_s", result.download_s}};
    // A session that compiles or copies nothing says 0.
    if (setup.compile_s > 0) times["compile_s"] = setup.compile_s;
    if (setup.compile_cached) times["compile_cached"] = true;
    if (setup.upload_s > 0) times["upload_s"] = setup.upload_s;
    if (row.packed != nullptr) times["pack_s"] = row.packed->pack_s;
    if (row.packed != nullptr) set_if(times, "bvh_build_s", row.packed->bvh_build_s);
    if (setup.build_s > 0) times["bvh_build_s"] = setup.build_s;
    if (!row.samples_s.empty()) times["samples_s"] = row.samples_s;
    if (!row.wall_samples_s.empty()) times["wall_samples_s"] = row.wall_samples_s;
    const auto figures = figures_of(row);
    if (!figures) return times;
    times["median_s"] = figures->kernel_s.median;
    times["lower_quartile_s"] = figures->kernel_s.lower_quartile;
    times["upper_quartile_s"] = figures->kernel_s.upper_quartile;
    times["spread"] = figures->kernel_s.spread();
    times["noisy"] = figures->kernel_s.noisy();
    set_if(times, "overhead_s", figures->overhead_s);
    set_if(times, "wall_s", figures->wall_s);
    return times;
}

json rates_json(const RowRun& row, const Figures& figures)
{
    json rates = {{"mrays_per_s", figures.mrays_per_s}};
    set_if(rates, "msteps_per_s", figures.msteps_per_s);
    if (!figures.gb_per_s) return rates;
    rates["estimated_gb_per_s"] = *figures.gb_per_s;
    rates["bytes_per_step"] = bytes_per_step(row.key.kernel);
    rates["bytes_per_step_is"] =
        "an estimate: what a step loads of its tet's record on average (docs/spec/devices.md, W7)";
    return rates;
}

} // namespace

nlohmann::json hit_json(const Hit& hit)
{
    return {{"face_id", hit.face_id}, {"tet", hit.tet}, {"t", hit.t}, {"u", hit.u}, {"v", hit.v}, {"steps", hit.steps}};
}

nlohmann::json scene_json(const SceneWork& scene, const Options& options)
{
    const LoadedScene& loaded = scene.loaded();
    const BuildInfo& build = loaded.scene.build;
    json object = {{"name", scene.label()},
                   {"hash", hash_text(loaded.hash)},
                   {"source", build.source},
                   {"source_hash", hash_text(build.source_hash)},
                   {"triangles", loaded.scene.mesh.triangles.size()},
                   {"tets", scene.counts().tets},
                   {"occlusive_faces", scene.counts().occlusive_faces},
                   {"free_faces", scene.counts().free_faces},
                   {"boundary_faces", scene.counts().boundary_faces},
                   {"domain", name_of(loaded.scene.domain.kind)},
                   {"divisions", loaded.scene.domain.divisions},
                   {"switches", build.switches},
                   {"tool", build.tool},
                   {"build_s", build.build_s},
                   {"from_cache", loaded.from_cache},
                   {"camera_set", name_of(options.camera_set)},
                   {"views", scene.view_numbers()},
                   {"width", scene.width()},
                   {"height", scene.height()},
                   {"locate_s", scene.locate_s()}};
    if (!loaded.file.empty()) object["file"] = loaded.file.filename().string();
    return object;
}

nlohmann::json row_json(const RowRun& row)
{
    json object = key_json(row.key);
    object["status"] = name_of(status_of(row));
    if (const std::string reason = reason_of(row); !reason.empty()) object["reason"] = reason;
    if (!row.device.name.empty()) {
        object["device"] = device_json(row.device);
        object["device_index"] = row.key.device;
    }
    if (row.self_test) object["self_test"] = self_test_json(*row.self_test);
    const Traced* result = traced(row);
    if (result == nullptr) return object;
    if (row.session != nullptr) object["bytes"] = row.session->bytes();
    if (row.key.kernel.task == Task::rays) object["ray_hash"] = hash_text(hash_of_rays(row));
    object["counts"] = counts_json(result->totals);
    if (result->visits.rays > 0) object["visits"] = visits_json(result->visits);
    object["verification"] = verification_json(*result);
    object["hit_hash"] = hash_text(result->hit_hash);
    object["times"] = times_json(row, *result);
    if (const auto figures = figures_of(row)) object["rates"] = rates_json(row, *figures);
    return object;
}

} // namespace tetrace
