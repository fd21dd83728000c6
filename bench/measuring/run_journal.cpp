#include "bench/measuring/run_journal.h"

#include "bench/options/identity.h"
#include "bench/rows/scene_work.h"
#include "bench/rows/sized_scene.h"
#include "bench/terminal/progress.h"
#include "core/base/error.h"
#include "core/base/hash.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

using nlohmann::json;

json scene_head(const SceneRequest& request, const std::string& label)
{
    const BuildOptions& how = request.build;
    json head = {{"label", label},
                 {"name", request.name},
                 {"domain", name_of(how.domain)},
                 {"divisions", how.divisions},
                 {"tets", name_of(how.tets)},
                 {"effort", how.effort},
                 {"repair", how.repair},
                 {"switches", how.switches},
                 {"resolution", how.resolution}};
    if (how.optimise_own) head["optimise_own"] = true;
    return head;
}

json run_head(const Options& options, const std::vector<RowKey>& keys)
{
    const BuildIdentity program = build_identity();
    json head = {{"version", program.version},
                 {"commit", program.commit},
                 {"compiler", program.compiler},
                 {"flags", program.flags},
                 {"cpu", host_identity().cpu},
                 {"cameras", camera_set_name(options)},
                 {"cameras_hash", options.own_cameras ? hash_text(options.own_cameras->hash()) : std::string()},
                 {"views", selected_views(options)},
                 {"size", {options.width, options.height}},
                 {"threads", resolved_threads(options)},
                 {"tile", options.tile_height},
                 {"packet_lanes", options.packet_lanes},
                 {"buffer_limit", options.buffer_limit},
                 {"budget_s", std::isinf(options.budget_s) ? json() : json(options.budget_s)},
                 {"samples", options.samples},
                 {"exact_samples", options.exact_samples},
                 {"sample_s", options.sample_s},
                 {"runs", options.runs},
                 {"shard", text_of(shard_of(options))},
                 {"scenes", json::array()},
                 {"rows", json::array()},
                 {"devices", json::array()}};
    for (const SceneRequest& request : scene_requests(options))
        for (const SizedScene& sized : sized_scenes(scene_label(request.name), options))
            head["scenes"].push_back(scene_head(request, sized.label));
    for (const RowKey& key : keys)
        head["rows"].push_back(row_name(key));
    for (const Backend* backend : all_backends()) {
        const auto& named = options.backends;
        if (!named.empty() && std::ranges::find(named, backend->name()) == named.end()) continue; // nor loaded
        for (const Device& device : backend->devices())
            if (device.usable) head["devices"].push_back({backend->name(), device.name, device.driver});
    }
    return head;
}

std::filesystem::path journal_file(const std::filesystem::path& result)
{
    return result.string() + ".journal";
}

std::unique_ptr<Journal> open_journal(const Options& options, const json& head)
{
    if (options.out)
        return std::make_unique<Journal>(journal_file(*options.out), head, options.resume,
                                         options.verb != Verb::reproduce);
    if (options.resume)
        throw Error(ErrorKind::usage,
                    "--resume: the journal is in the result's folder; name the result's file with --out");
    return nullptr;
}

void end_journal(Journal* journal, const Options& options)
{
    if (journal == nullptr) return;
    journal->finish();
    say_when_interrupted({});
    if (options.verb != Verb::reproduce && shard_of(options).is_whole())
        std::filesystem::remove(journal_file(*options.out));
}

} // namespace tetrace
