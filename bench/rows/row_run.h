#pragma once

#include "bench/rows/gpu_state.h"
#include "bench/rows/rows.h"
#include "bench/rows/scene_work.h"
#include "bench/truth/hit_checks.h"
#include "bench/truth/oracle.h"
#include "core/base/error.h"
#include "core/device/self_test.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tetrace {

/// How a row ended; see `tetrace help bench`. wrong: it differs from openmp, or its device left out rays, wrote
/// elsewhere or changed its answers. flawed: the method itself makes some of its rays wrong or lost.
enum class Status { ok, flawed, wrong, unsupported, skipped, error };
template <>
inline constexpr auto enum_names<Status> = names_up_to<Status::error>("ok", "flawed", "wrong", "unsupported", "skipped",
                                                                      "error");

/// The first ray on which a backend differs from openmp.
struct DifferingRay {
    std::uint32_t view = 0, x = 0, y = 0;
    Hit ours{}, openmp{};
};

/// Nodes and triangles of a BVH that rays visit.
struct Visits {
    std::uint64_t rays = 0; ///< rays that were counted
    std::uint64_t nodes = 0;
    std::uint64_t triangles = 0; ///< tests; a triangle in two leaves counts twice

    void add(const Visits& other);
};

/// Result of verifying one image.
struct ImageVerdict {
    RayTotals totals;
    std::optional<std::uint64_t> entering = {}; ///< as in Traced
    Visits visits;
    Verdicts verdicts;
    bool compared = false; ///< as in Traced, and so are the members down to first_different
    std::uint64_t different = 0;
    std::uint64_t inexact = 0;
    std::uint64_t max_ulps = 0;
    std::optional<DifferingRay> first_different;
    std::uint64_t lost_at_device_cap = 0; ///< as in Traced
    std::uint64_t hit_hash = 0;           ///< of this image's hits
    double kernel_s = 0, wall_s = 0, download_s = 0;
};

/// Result of the untimed pass over all selected views.
struct Traced {
    RayTotals totals;
    std::optional<std::uint64_t> entering = {}; ///< rays that enter the domain's box, see enters(); empty: not known
    Visits visits;                              ///< see count_visits()
    Verdicts verdicts;
    bool compared = false;       ///< with openmp; openmp's own rows and Embree's have nothing to compare with
    std::uint64_t different = 0; ///< rays that differ from openmp's by more than the device's self-test allows
    std::uint64_t inexact = 0;   ///< rays that differ from openmp's in some bit, allowed or not
    std::uint64_t max_ulps = 0;  ///< of t, u and v, among those allowed
    std::optional<DifferingRay> first_different;
    std::uint64_t lost_at_device_cap = 0;   ///< lost rays with Device::max_steps steps, fewer than the proof allows
    std::uint64_t hit_hash = 0;             ///< of all hits, view after view; 0 where shards had them, not known
    std::uint64_t views_hash = 0;           ///< of the hashes of the views, one after the other; shards know it too
    std::vector<std::uint64_t> view_hashes; ///< of each view's hits
    double kernel_s = 0;                    ///< device seconds of this first pass
    double wall_s = 0;                      ///< launch to end, by the host's clock
    double download_s = 0;

    /// Adds an image, except for hit_hash: images are added in the order of views.
    void add(const ImageVerdict& image);
};
struct Skipped {
    Status status = Status::skipped; ///< or unsupported
    std::string reason;
};
struct Failed {
    ErrorKind kind = ErrorKind::internal;
    std::string what;
};
using Outcome = std::variant<Traced, Skipped, Failed>;

/// What a row pays once, before its first ray, and the memory that it occupies from then on. Compiling kernels and
/// copying to the device are left out: they are costs of the API, not of the structure.
struct SetupCost {
    double build_s = 0;      ///< TetGen and our optimiser, the BVH's builder, Embree, or a GPU's driver
    double pack_s = 0;       ///< from the built structure to the bytes that are copied; none for Embree
    std::uint64_t bytes = 0; ///< of the session

    [[nodiscard]] double once_s() const { return build_s + pack_s; }
};

/// Views that one launch traces together: indices in SceneWork::views(), ascending.
using ViewBatch = std::vector<std::size_t>;

/// Launches that trace all selected views once.
struct LaunchCounts {
    std::uint32_t joined = 0; ///< if views are traced together; 0: not known
    std::uint32_t single = 0; ///< if each view has a launch of its own
};

/// A row from its selection to its result. A failure becomes its outcome.
struct RowRun {
    RowKey key;
    SceneWork* scene = nullptr; ///< null where the scene could not be loaded
    Backend* backend = nullptr;
    Device device;
    std::optional<SelfTest> self_test; ///< of the device in the row's math mode; empty: it runs none of our kernels
    const Packed* packed = nullptr;    ///< null for kernels that are not portable
    std::unique_ptr<Session> session;
    std::uint64_t max_buffer_bytes = 0; ///< that the session may make; 0: no limit
    ViewBatch views_of_rays;            ///< views whose rays the session has been given; see prepare_batch()
    Outcome outcome = Traced{};
    std::string recorded_reason = {};            ///< of a row that was read from a result, in place of its outcome's
    std::optional<SetupCost> recorded_cost = {}; ///< of such a row: its setup_cost()
    double warm_s = 0;                           ///< wall seconds of the warm-up pass
    std::uint32_t passes = 1; ///< of a sample, which traces all views so often; of `reproduce` the most of any view
    std::vector<ViewBatch> batches;         ///< of a pass of a sample: one launch each
    LaunchCounts launches;                  ///< of a pass
    std::vector<double> samples_s;          ///< device seconds of a pass over all views, traced together, per sample
    std::vector<double> wall_samples_s;     ///< the same by the host's clock, from launch to the end of wait
    std::vector<std::size_t> run_samples;   ///< number of samples_s of each run; empty if the row is not timed
    std::vector<double> latency_samples_s;  ///< device seconds of a pass with a launch for each view
    std::optional<GpuReadings> gpu = {};    ///< of a row on a GPU that tells something
    std::optional<double> pulse_ratio = {}; ///< of the pulse beside the samples to its fastest, their median
    std::string disturbance = {};           ///< why the rate is not to be trusted, see disturbance_text()
};

[[nodiscard]] Status status_of(const RowRun& row);
/// Whether samples of the row are taken: it is open, and ok or flawed.
[[nodiscard]] bool is_timed(const RowRun& row);
/// What setting a row up cost: of one whose session is open, or that was read from a result which has it.
[[nodiscard]] std::optional<SetupCost> setup_cost(const RowRun& row);
/// The reason, in one line; empty where the status is ok.
[[nodiscard]] std::string reason_of(const RowRun& row);
/// "cpu", "gpu" or "emulated"; empty where the row has no device because its scene could not be loaded.
[[nodiscard]] std::string device_kind_text(const RowRun& row);
/// The rows of a scene, by its label.
[[nodiscard]] std::vector<const RowRun*> rows_of(const std::string& scene, const std::vector<RowRun>& rows);
/// The samples of each run of the measurement.
[[nodiscard]] std::vector<std::vector<double>> samples_of_runs(const RowRun& row);
/// The result of tracing; null where the row failed or was skipped.
[[nodiscard]] const Traced* traced(const RowRun& row);

/// Settings of a session; the same for every row of a run.
[[nodiscard]] SessionOptions session_options(const Options& options);

/// Opens a row's session on its device. Throws only Error{interrupted}.
[[nodiscard]] RowRun open_row(const RowKey& key, SceneWork& scene, const Options& options);

/// Opens the session of a row anew, after it was closed. A failure becomes the row's outcome.
void reopen_row(RowRun& row, const Options& options);

/// Opens the session of a row of task search on a device of one of the backends. The tets must outlive it. Throws as
/// the other overload does.
[[nodiscard]] RowRun open_row(const RowKey& key, const Packed& tets, const Options& options,
                              const std::vector<Backend*>& backends);

/// A row that could not be opened because its scene could not be loaded.
[[nodiscard]] RowRun failed_row(const RowKey& key, const Error& error);

/// Does a part of a row's work. An exception becomes the row's outcome and frees its session; Error{interrupted} is
/// passed on.
void guarded(RowRun& row, const std::function<void()>& work);

/// Whether a row's answers fail a run. They do if the row is wrong. They also do if its method claims robustness and
/// has lost a ray, or mistaken one where that does not pass. Rows without an answer do not fail by themselves.
[[nodiscard]] bool fails(const RowRun& row, bool flawed_passes);

/// The exit code for the rows' statuses: 1 where one fails; else that of the first error; else 0.
[[nodiscard]] int exit_code(const std::vector<RowRun>& rows, bool flawed_passes);

} // namespace tetrace
