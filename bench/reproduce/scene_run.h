#pragma once

#include "bench/measuring/row_recorder.h"
#include "bench/measuring/verify.h"
#include "bench/reproduce/flat_tets.h"
#include "bench/reproduce/kept_costs.h"
#include "bench/reproduce/likeness.h"

#include <memory>
#include <string>
#include <vector>

namespace tetrace {

/// The builds that tables compare: a CDT as the options ask for, one as near to the paper's as known, and tets for
/// rays.
inline constexpr const char* our_build = "ours";
inline constexpr const char* papers_build = "paper's";
inline constexpr const char* rays_build = "rays";

/// A scene in one of the builds that tables compare.
struct SceneBuild {
    SceneRequest request;
    std::string scene;      ///< name in tables
    std::string build;      ///< one of the three above
    std::string label;      ///< name in rows: the scene, with "-paper" or "-rays" appended for these builds
    bool robustness = true; ///< whether to look for flat tets
    bool timing = true;     ///< whether to take samples
    bool methods = true;    ///< whether to trace all methods of the cdt that were asked for, or only maria (and the
                            ///< fastest walk through tets for rays)
    bool rivals = false;    ///< whether to trace the BVHs as well
};

/// A scene with its rows, and the results for each view.
struct SceneRun : RecordedRows {
    SceneBuild build;
    std::unique_ptr<SceneWork> scene; ///< null if it could not be loaded
    Likeness likeness;                ///< to the paper's
    std::unique_ptr<Verifier> verifier;
    std::unique_ptr<FlatTets> flat; ///< null if nothing needs it

    std::vector<std::string> flawed_pictures, extreme_pictures; ///< names of files in the result's folder
    std::vector<std::string> picture_problems;                  ///< why one is missing, one sentence each

    /// Frees what results do not need: scenes run one after the other, and memory is limited.
    void close();
};

/// Those scenes of a run that a table covers.
using SceneRuns = std::vector<const SceneRun*>;

/// Whether its tets are not a CDT, but changed for rays: asked for so, or read from such a file.
[[nodiscard]] bool is_for_rays(const SceneRun& run);
/// "CDT" or "tets for rays".
[[nodiscard]] std::string tets_name(const SceneRun& run);
/// Those that the paper's claims are about.
[[nodiscard]] SceneRuns runs_of_cdt(const SceneRuns& runs);

/// The rows of a build. Where BVHs are traced as well as the CDT, the options' methods and layouts select only among
/// the rows of their own structure; a structure for which none is named keeps all its rows. --filter may keep none.
/// Throws Error{usage} as unfiltered_rows() does.
[[nodiscard]] std::vector<RowKey> rows_of_build(const SceneBuild& build, const Options& options);

/// How the scene's views were sampled from a camera set of `population` views, for images of the paper's size.
[[nodiscard]] Sampling sampling_of(const SceneWork& scene, std::size_t population);

/// Loads the scene and opens its rows; a scene that cannot be loaded ends its rows with the reason.
[[nodiscard]] SceneRun open_scene_run(const SceneBuild& build, const Options& options);

/// Loads only the scene, for rows that were read from results, for merging. Throws what load_work() throws.
[[nodiscard]] SceneRun recorded_scene_run(const SceneBuild& build, const Options& options,
                                          const std::vector<RowRecord>& rows);

/// Traces every view with every row, verifies each image, times it where asked for, and appends the view to the
/// journal. Views that are in the journal are taken from there.
/// Throws Error{usage} if the journal belongs to another scene or to other rows.
void run_views(SceneRun& run, const Options& options, const Recording& shared);

} // namespace tetrace
