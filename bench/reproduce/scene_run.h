#pragma once

#include "bench/measuring/verify.h"
#include "bench/reproduce/flat_tets.h"
#include "bench/reproduce/row_recorder.h"
#include "bench/reproduce/setup_costs.h"

#include <memory>
#include <string>
#include <vector>

namespace tetrace {

/// The builds that tables compare: as the options ask for it, and as near to the paper as known.
inline constexpr const char* our_build = "ours";
inline constexpr const char* papers_build = "paper's";

/// A scene in one of the builds that tables compare.
struct SceneBuild {
    SceneRequest request;
    std::string scene;      ///< what tables call it
    std::string build;      ///< "ours" or "paper's"
    std::string label;      ///< what rows call it: the scene, "-paper" behind it for the paper's build
    bool robustness = true; ///< whether to look for flat tets
    bool timing = true;     ///< whether to take samples
    bool methods = true;    ///< whether to trace all of the cdt's methods asked for, or maria alone
    bool rivals = false;    ///< whether to trace the BVHs too
};

/// A scene with its rows, and what came of each view.
struct SceneRun : RecordedRows {
    SceneBuild build;
    std::unique_ptr<SceneWork> scene; ///< null where it could not be loaded
    std::unique_ptr<Verifier> verifier;
    std::unique_ptr<FlatTets> flat; ///< null where nobody asks

    std::vector<std::optional<SetupCost>> costs; ///< row by row; nothing where nobody asks

    std::vector<std::string> flawed_pictures, extreme_pictures; ///< names of files beside the result's
    std::vector<std::string> picture_problems;                  ///< why one is missing, a sentence each
    nlohmann::json row_records;                                 ///< the rows as results have them; made by close()

    /// Keeps what results need of the devices, and frees the rest: scenes follow each other, and memory is limited.
    void close();
};

/// Those of a run that a table is about.
using SceneRuns = std::vector<const SceneRun*>;

/// The rows of a build. Of the options' methods and layouts, those of a structure select among its rows alone where
/// BVHs are traced beside the CDT: all of them where none is named. Throws Error{usage} as select_rows() does.
[[nodiscard]] std::vector<RowKey> rows_of_build(const SceneBuild& build, const Options& options);

/// How the scene's views were taken from a camera set of `population` views, for images of the paper's size.
[[nodiscard]] Sampling sampling_of(const SceneWork& scene, std::size_t population);

/// Loads the scene and opens its rows; a scene that cannot be loaded ends its rows with the reason.
[[nodiscard]] SceneRun open_scene_run(const SceneBuild& build, const Options& options);

/// Traces every view with every row, verifies each image, times it where asked for, and appends the view to the
/// journal; views that the journal has are taken from there. journal: may be null.
/// Throws Error{usage} where the journal is of another scene or of other rows.
void run_views(SceneRun& run, const Options& options, Journal* journal, RunProgress& progress);

} // namespace tetrace
