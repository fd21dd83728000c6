#include "bench/merging/view_journal.h"

#include "bench/merging/shard_results.h"
#include "bench/options/identity.h"
#include "bench/reproduce/image_record.h"
#include "core/base/hash.h"

#include <filesystem>
#include <fmt/format.h>

namespace tetrace {

void ViewJournal::see(const SeenImage& image)
{
    if (shard_of(*options_).is_whole()) return;
    const SceneWork& scene = *image.row.scene;
    const std::uint32_t view = scene.view_numbers()[image.view];
    nlohmann::json& entry = entries_[{scene.label(), view}];
    if (entry.is_null())
        entry = {{"scene", scene.label()}, {"scene_hash", hash_text(scene.loaded().hash)}, {"view", view}};
    ImageRecord record;
    record.verdict = image.verdict;
    entry["rows"][row_name(image.row.key)] = outcome_json(record);
}

void ViewJournal::write() const
{
    if (shard_of(*options_).is_whole()) return;
    std::filesystem::remove(journal_file(*options_->out)); // of a run that was ended here: all views are known anew
    Journal journal(journal_file(*options_->out),
                    {{"commit", build_identity().commit}, {"shard", text_of(shard_of(*options_))}}, false);
    for (const auto& [place, entry] : entries_)
        journal.append(entry);
    journal.finish();
}

} // namespace tetrace
