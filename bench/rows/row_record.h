#pragma once

#include "bench/rows/gpu_state.h"
#include "bench/rows/rows.h"
#include "bench/truth/hit_checks.h"
#include "bench/truth/oracle.h"
#include "core/base/error.h"
#include "core/device/self_test.h"

#include <functional>
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

/// What a row shows in a check, from best to worst: its conformity (bench/measuring/conformity.h), or why it fails
/// although that is good. other_answers: right as before, but not the same bits in each repetition. flawed: its
/// method's wrong rays, on a device whose bits are not openmp's.
enum class Finding {
    reference,
    bit_exact,
    uncompared,
    within_ulps,
    unsupported,
    skipped,
    other_answers,
    flawed,
    not_exact,
    wrong,
    error
};
template <>
inline constexpr auto enum_names<Finding> = names_up_to<Finding::error>("reference", "bit-exact", "not compared",
                                                                        "within ulps", "unsupported", "skipped",
                                                                        "other answers", "flawed", "not exact", "wrong",
                                                                        "error");

/// Whether a check fails by itself where a row shows this.
[[nodiscard]] constexpr bool fails(Finding shown)
{
    return shown >= Finding::other_answers;
}

/// The first ray on which a backend differs from openmp.
struct DifferingRay {
    std::uint32_t view = 0, x = 0, y = 0;
    Hit ours{}, openmp{};
    Task task = Task::trace; ///< says how they are read
};

/// How a ray that is wrong or differs walked, for whoever looks into it. Empty if that is not known.
struct RayWalk {
    std::vector<std::uint32_t> openmp; ///< tets of openmp's walk; none in a BVH
    std::vector<std::uint32_t> own;    ///< of the device's, the first ones
    std::string command;               ///< follows the ray on the device and on openmp
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
    RayWalk walk_of_different, walk_of_wrong; ///< of first_different, and of verdicts.first_wrong
    std::uint64_t lost_at_device_cap = 0;     ///< lost rays with Device::max_steps steps, fewer than the proof allows
    std::uint64_t hit_hash = 0;               ///< of all hits, view after view; 0 where shards had them, not known
    std::uint64_t views_hash = 0;             ///< of the hashes of the views, one after the other; shards know it too
    std::vector<std::uint64_t> view_hashes;   ///< of each view's hits
    double kernel_s = 0;                      ///< device seconds of this first pass
    double wall_s = 0;                        ///< launch to end, by the host's clock
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

/// What a row pays once, before its first ray, and the memory that it occupies from then on.
struct RowSetup {
    double compile_s = 0;               ///< kernels compiled; of Embree, its BVH built
    bool compile_cached = false;        ///< the kernels came from the cache of compiled programs
    double upload_s = 0;                ///< data copied to where the kernel reads it
    std::optional<double> build_s;      ///< TetGen and our optimiser, the BVH's builder, Embree, or a GPU's driver
    std::optional<double> bvh_build_s;  ///< of our BVHs; of layout rt the driver's, by the device's clock
    std::optional<double> pack_s;       ///< from the built structure to the bytes that are copied; none for Embree
    std::optional<std::uint64_t> bytes; ///< of the session
};

/// Seconds before a row's first ray that its structure costs. Compiling kernels and copying to the device are left out:
/// they are costs of the API.
struct SetupCost {
    double build_s = 0;
    double pack_s = 0;
    std::uint64_t bytes = 0;

    [[nodiscard]] double once_s() const { return build_s + pack_s; }
};

/// Launches that trace all selected views once.
struct LaunchCounts {
    std::uint32_t joined = 0; ///< if views are traced together; 0: not known
    std::uint32_t single = 0; ///< if each view has a launch of its own
};

/// A row as plain data: its key, its set-up, its hits, and its samples. Everything that is printed, written or compared
/// is made of records, whether they were just measured, read from a result, or merged of several.
struct RowRecord {
    RowKey key;
    Device device;                     ///< without a name if the row's scene could not be loaded
    std::string clock;                 ///< that kernel times are read from
    std::optional<SelfTest> self_test; ///< of the device in the row's math mode; empty: it runs none of our kernels
    RowSetup setup;
    std::string fall_back;                 ///< why its BVH is not the cheapest of its tree; empty if it is
    std::optional<std::uint64_t> ray_hash; ///< of its given rays, view after view
    Outcome outcome = Traced{};
    std::uint32_t passes = 1; ///< of a sample, which traces all views so often; of `reproduce` the most of any view
    LaunchCounts launches;    ///< of a pass
    std::vector<double> samples_s;          ///< device seconds of a pass over all views, traced together, per sample
    std::vector<double> wall_samples_s;     ///< the same by the host's clock, from launch to the end of wait
    std::vector<std::size_t> run_samples;   ///< number of samples_s of each run; empty if the row is not timed
    std::vector<double> latency_samples_s;  ///< device seconds of a pass with a launch for each view
    std::optional<GpuSummary> gpu = {};     ///< of a row on a GPU that reports anything
    std::optional<double> pulse_ratio = {}; ///< of the pulse next to the samples to its fastest, their median
    std::vector<Finding> repeated = {};     ///< what each repetition of a check showed; empty if there was one
    std::string disturbance = {};           ///< why the rate is not to be trusted, see disturbance_text()
};

/// Whether a row's answers are ok or flawed, so that it may have a rate.
[[nodiscard]] constexpr bool has_answers(Status status)
{
    return status == Status::ok || status == Status::flawed;
}

[[nodiscard]] Status status_of(const RowRecord& row);
[[nodiscard]] bool has_answers(const RowRecord& row);
/// What setting a row up cost; empty if that is not known.
[[nodiscard]] std::optional<SetupCost> setup_cost(const RowRecord& row);
void set_setup_cost(RowRecord& row, const SetupCost& cost);
/// The reason, in one line; empty if the status is ok.
[[nodiscard]] std::string reason_of(const RowRecord& row);
/// "cpu", "gpu" or "emulated"; empty if the row has no device because its scene could not be loaded.
[[nodiscard]] std::string device_kind_text(const RowRecord& row);
/// The rows of a scene, by its label.
[[nodiscard]] std::vector<const RowRecord*> rows_of(const std::string& scene, const std::vector<RowRecord>& rows);
/// The samples of each run of the measurement.
[[nodiscard]] std::vector<std::vector<double>> samples_of_runs(const RowRecord& row);
/// Whether the samples have a launch for each view, one after the other: their times are latencies.
[[nodiscard]] bool has_latency(const RowRecord& row);
/// The result of tracing; null if the row failed or was skipped.
[[nodiscard]] const Traced* traced(const RowRecord& row);

/// Whether a row's answers fail a run. They do if the row is wrong. They also do if its method claims robustness and
/// has lost a ray, or mistaken one where that does not pass. Rows without an answer do not fail by themselves.
[[nodiscard]] bool fails(const RowRecord& row, bool flawed_passes);

/// The exit code for the rows' statuses: 1 if one fails; else that of the first error; else 0.
[[nodiscard]] int exit_code(const std::vector<RowRecord>& rows, bool flawed_passes);
[[nodiscard]] int exit_code(const std::vector<RowRecord>& rows, const std::function<bool(const RowRecord&)>& row_fails);

} // namespace tetrace
