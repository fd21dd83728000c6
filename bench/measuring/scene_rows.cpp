#include "bench/measuring/scene_rows.h"

#include "bench/rows/sized_scene.h"
#include "bench/terminal/interrupts.h"
#include "bench/terminal/progress.h"
#include "core/base/hash.h"
#include "core/base/printable.h"
#include "scenes/pinned.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>

namespace tetrace {

namespace {

std::vector<RowKey> rows_of(const std::string& label, const std::vector<RowKey>& keys)
{
    std::vector<RowKey> rows;
    std::ranges::copy_if(keys, std::back_inserter(rows), [&](const RowKey& key) { return key.scene == label; });
    return rows;
}

/// Whether an error ends only the rows of a scene, not the run.
bool ends_rows(const Error& error)
{
    return error.kind() != ErrorKind::usage && error.kind() != ErrorKind::interrupted;
}

void skip_interrupted(SceneRows& result, std::span<const RowKey> keys)
{
    for (const RowKey& key : keys) {
        RowRun& row = result.rows.emplace_back();
        row.key = key;
        end_interrupted(row);
    }
}

void open_rows_of(SceneRows& result, SceneWork& scene, const std::vector<RowKey>& keys, const Options& options)
{
    for (const RowKey& key : keys) {
        const double done = static_cast<double>(&key - keys.data()) / static_cast<double>(keys.size());
        progress_line().show("opening " + scene.label(), done, -1, row_label(key));
        if (is_interrupted())
            skip_interrupted(result, {&key, 1});
        else
            result.rows.push_back(open_row(key, scene, options));
    }
}

/// The scene is loaded once for all sizes of its images.
void open_sizes(SceneRows& result, const std::vector<RowKey>& keys, const SceneRequest& request, const Options& options)
{
    const SceneWork* first = nullptr;
    for (const SizedScene& sized : sized_scenes(scene_label(request.name), options)) {
        const auto of_size = rows_of(sized.label, keys);
        if (of_size.empty()) continue;
        const Options own = at_size(options, sized.size);
        result.scenes.push_back(std::make_unique<SceneWork>(
            first == nullptr ? load_work(request, own, sized.label) : resized(*first, request, own, sized.label)));
        first = result.scenes.back().get();
        open_rows_of(result, *result.scenes.back(), of_size, own);
    }
}

/// keys: all of the scene, size after size.
void open_rows(SceneRows& result, const std::vector<RowKey>& keys, const SceneRequest& request, const Options& options)
{
    const std::size_t before = result.rows.size();
    const auto not_opened = [&] { return std::span(keys).subspan(result.rows.size() - before); };
    try {
        if (is_interrupted())
            skip_interrupted(result, keys);
        else
            open_sizes(result, keys, request, options);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted && is_stop_handled()) { // the builder had the signal
            interrupt();
            skip_interrupted(result, not_opened());
            return;
        }
        if (!ends_rows(error)) throw;
        say(fmt::format("{}: {}", scene_label(request.name), error.what()));
        for (const RowKey& key : not_opened())
            result.rows.push_back(failed_row(key, error));
    }
}

void verify_scene(std::vector<RowRun>& rows, SceneWork& scene, const Options& options, const ImageSeen& image_seen,
                  const Recording& shared)
{
    std::vector<RowRun*> pointers;
    for (RowRun& row : rows)
        if (row.scene == &scene) pointers.push_back(&row);
    try {
        verify_rows(pointers, scene, options, image_seen, shared);
    } catch (const JournalError&) {
        throw;
    } catch (const Error& error) {
        if (!ends_rows(error)) throw;
        say(fmt::format("{}: {}", scene.label(), error.what()));
        for (RowRun* row : pointers)
            *row = failed_row(row->key, error);
    }
}

} // namespace

std::vector<RowKey> selected_rows(const Options& options, const std::function<bool(const std::string&)>& keeps)
{
    std::vector<RowKey> rows;
    for (RowKey& key : select_rows(options, scene_labels(options)))
        if (keeps(row_name(key))) rows.push_back(std::move(key));
    if (rows.empty())
        throw Error(ErrorKind::usage,
                    "--benchmark_filter matches none of the selected rows; --list prints their names");
    return rows;
}

SceneRows open_and_verify(const std::vector<RowKey>& keys, const Options& options, const ImageSeen& image_seen,
                          const Recording& shared)
{
    SceneRows result;
    result.rows.reserve(keys.size()); // rows keep their addresses
    for (const SceneRequest& request : scene_requests(options)) {
        std::vector<RowKey> scene_keys;
        for (const SizedScene& sized : sized_scenes(scene_label(request.name), options))
            std::ranges::move(rows_of(sized.label, keys), std::back_inserter(scene_keys));
        if (!scene_keys.empty()) open_rows(result, scene_keys, request, options);
    }
    const unsigned samples = options.verb == Verb::check ? 0 : options.samples;
    shared.budget->plan(result.rows, samples, options.sample_s, options.runs);
    for (const auto& scene : result.scenes)
        verify_scene(result.rows, *scene, options, image_seen, shared);
    return result;
}

void require_answers(const std::vector<const RowRecord*>& rows, const char* done)
{
    const auto unanswered = [](const RowRecord* row) {
        const Status status = status_of(*row);
        return status == Status::skipped || status == Status::unsupported;
    };
    if (!rows.empty() && std::ranges::all_of(rows, unanswered))
        throw Error(ErrorKind::missing,
                    fmt::format("nothing was {}: no selected row could run here, for example {}: {}", done,
                                row_name(rows.front()->key), reason_of(*rows.front())));
}

void require_answers(const std::vector<RowRecord>& rows, const char* done)
{
    std::vector<const RowRecord*> all;
    for (const RowRecord& row : rows)
        all.push_back(&row);
    require_answers(all, done);
}

Verdicts all_verdicts(const std::vector<RowRecord>& rows)
{
    Verdicts sum;
    for (const RowRecord& row : rows)
        if (const Traced* result = traced(row)) sum.add(result->verdicts);
    return sum;
}

namespace {

nlohmann::json optimised_json(const OptimisedInfo& made)
{
    nlohmann::json object = {{"effort", static_cast<unsigned>(made.effort)},
                             {"seconds", made.seconds},
                             {"rounds", made.rounds},
                             {"cost_before", made.cost_before},
                             {"cost_after", made.cost_after},
                             {"reason", made.reason},
                             {"end", name_of(made.end)},
                             {"operations", nlohmann::json::array()}};
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
            {"passes", repair.passes},
            {"tolerance", repair.tolerance},
            {"moved", repair.moved}};
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
                             {"order", build.order},
                             {"tets_kind", name_of(build.optimised.tets)},
                             {"tool", build.tool},
                             {"from_cache", loaded.from_cache},
                             {"camera_set", camera_set_name(options)},
                             {"views", scene.view_numbers()},
                             {"width", scene.width()},
                             {"height", scene.height()},
                             {"locate_s", scene.locate_s()}};
    object["mesh_hash"] = hash_text(mesh_hash(loaded.scene.mesh));
    if (const PinnedScene* const pinned = pinned_with(loaded.hash)) object["pinned"] = std::string(pinned->name);
    if (build.build_s > 0) object["build_s"] = build.build_s; // else the tets were stored
    const auto list = [](Double3 v) { return nlohmann::json{v.x, v.y, v.z}; };
    const BoundingSphere sphere = source_sphere(loaded.scene);
    object["centre"] = list(sphere.centre);
    object["radius"] = sphere.radius;
    if (build.rounding > 0) object["rounding"] = build.rounding;
    if (build.centre != Double3{}) object["subtracted"] = list(build.centre);
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
