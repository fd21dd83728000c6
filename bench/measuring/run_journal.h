#pragma once

#include "bench/measuring/journal.h"
#include "bench/options/options.h"
#include "bench/rows/rows.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetrace {

/// Everything that determines the answers of these rows, and how they are timed: the head of a run's journal. Scenes
/// are those of the options, unless the caller replaces them.
[[nodiscard]] nlohmann::json run_head(const Options& options, const std::vector<RowKey>& keys);
/// A scene in such a head.
[[nodiscard]] nlohmann::json scene_head(const SceneRequest& request, const std::string& label);

/// The journal of a result.
[[nodiscard]] std::filesystem::path journal_file(const std::filesystem::path& result);

/// The journal of the result file that the options name; null without one. With --resume it goes on. Otherwise
/// `reproduce`, whose runs take hours, refuses to replace that of a run that did not end; the other verbs begin anew.
/// Throws what Journal throws, and Error{usage} for --resume without a result file.
[[nodiscard]] std::unique_ptr<Journal> open_journal(const Options& options, const nlohmann::json& head);

/// Called when the result is written. `merge` needs the journal of a shard, and `reproduce --resume` repeats a result
/// from it; other journals are removed. journal: may be null.
void end_journal(Journal* journal, const Options& options);

} // namespace tetrace
