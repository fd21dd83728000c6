#include "bench/measuring/scene_records.h"

#include "core/base/hash.h"
#include "core/base/printable.h"

namespace tetrace {

namespace {

nlohmann::json optimised_json(const OptimisedInfo& made)
{
    nlohmann::json object = {{"effort", made.effort},         {"seconds", made.seconds},
                             {"rounds", made.rounds},         {"cost_before", made.cost_before},
                             {"cost_after", made.cost_after}, {"reason", made.reason},
                             {"end", name_of(made.end)},      {"operations", nlohmann::json::array()}};
    for (const OptimiserOperation& operation : made.operations)
        object["operations"].push_back({{"name", operation.name},
                                        {"done", operation.done},
                                        {"gain", operation.gain},
                                        {"seconds", operation.seconds}});
    return object;
}

nlohmann::json repair_json(const RepairInfo& repair)
{
    return {{"crossing_pairs", repair.crossing_pairs},
            {"cut_triangles", repair.cut_triangles},
            {"pieces", repair.pieces},
            {"dropped", repair.dropped},
            {"passes", repair.passes}};
}

} // namespace

nlohmann::json scene_json(const SceneWork& scene, const Options& options)
{
    const LoadedScene& loaded = scene.loaded();
    const BuildInfo& build = loaded.scene.build;
    nlohmann::json object = {{"name", scene.label()},
                             {"hash", hash_text(loaded.hash)},
                             {"source", build.source},
                             {"source_hash", hash_text(build.source_hash)},
                             {"triangles", loaded.scene.mesh.triangles.size()},
                             {"tets", scene.counts().tets},
                             {"occlusive_faces", scene.counts().occlusive_faces},
                             {"free_faces", scene.counts().free_faces},
                             {"boundary_faces", scene.counts().boundary_faces},
                             {"reached_tets", scene.counts().reached_tets},
                             {"domain", name_of(loaded.scene.domain.kind)},
                             {"divisions", loaded.scene.domain.divisions},
                             {"switches", build.switches},
                             {"tets_kind", name_of(build.optimised.tets)},
                             {"tool", build.tool},
                             {"build_s", build.build_s},
                             {"from_cache", loaded.from_cache},
                             {"camera_set", camera_set_name(options)},
                             {"views", scene.view_numbers()},
                             {"width", scene.width()},
                             {"height", scene.height()},
                             {"locate_s", scene.locate_s()}};
    if (loaded.no_tets) object["no_tets"] = printable_text(loaded.no_tets->what());
    if (const auto& hash = scene.camera_set_hash()) object["camera_set_hash"] = hash_text(*hash);
    if (build.repair.asked) object["repair"] = repair_json(build.repair);
    if (build.optimised.asked == TetsKind::rays) object["optimised"] = optimised_json(build.optimised);
    if (const auto& walk = scene.start_walk())
        object["start_walk"] = {{"walked", walk->counts.walked},
                                {"located", walk->counts.located},
                                {"steps", walk->counts.steps},
                                {"most_steps", walk->counts.max_steps},
                                {"exact_s", walk->exact_s}};
    if (!loaded.views.empty()) object["own_views"] = true;
    if (!loaded.file.empty()) object["file"] = loaded.file.filename().string();
    return object;
}

std::vector<nlohmann::json> scene_records(const SceneRows& run, const Options& options)
{
    std::vector<nlohmann::json> records;
    for (const auto& scene : run.scenes) {
        nlohmann::json& record = records.emplace_back(scene_json(*scene, options));
        for (const RowRun& row : run.rows) {
            if (row.scene != scene.get() || row.packed == nullptr) continue;
            if (row.key.kernel.structure == Structure::cdt && !record.contains("packed_bytes"))
                record["packed_bytes"] = row.packed->data.bytes();
            if (row.packed->bvh_build_s) record["bvh_build_s"] = *row.packed->bvh_build_s;
        }
    }
    return records;
}

} // namespace tetrace
