#pragma once

#include "bench/measuring/view_recorder.h"

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

namespace tetrace {

/// The scenes of a run and its rows, scene after scene. Scenes keep their addresses.
struct SceneRows {
    std::vector<std::unique_ptr<SceneWork>> scenes;
    std::vector<RowRun> rows;
};

/// The rows that the options select among all scenes asked for; --filter and the given predicate on names apply. Throws
/// Error{usage} where no row is left.
[[nodiscard]] std::vector<RowKey> selected_rows(const Options& options,
                                                const std::function<bool(const std::string&)>& keeps);

/// Loads all scenes, opens their rows, skips those that do not fit the budget, and verifies the others (verify_rows()).
/// A scene that cannot be loaded or judged ends its rows with the reason, said once, on standard error. Throws
/// Error{usage} for a name that means no scene, and as Budget::plan() does.
[[nodiscard]] SceneRows open_and_verify(const std::vector<RowKey>& keys, const Options& options,
                                        const ImageSeen& image_seen = {}, const Recording& shared = {});

/// A run without an answer from any device must not look like one that went well. Throws Error{missing} with a reason
/// where every row is skipped or unsupported. done: "checked" or "measured".
void require_answers(const std::vector<const RowRecord*>& rows, const char* done);
void require_answers(const std::vector<RowRecord>& rows, const char* done);

/// Result of verifying all rows.
[[nodiscard]] Verdicts all_verdicts(const std::vector<RowRecord>& rows);

/// A scene as results record it: identity, build, counts, views.
[[nodiscard]] nlohmann::json scene_json(const SceneWork& scene, const Options& options);

/// The scenes of a run as results record them, each with the size of its first packed tets.
[[nodiscard]] std::vector<nlohmann::json> scene_records(const SceneRows& run, const Options& options);

} // namespace tetrace
