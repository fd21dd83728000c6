#pragma once

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

/// How a row ended; see `tetrace help bench`. A row is wrong where it differs from openmp, or its device left out rays,
/// wrote elsewhere or changed its answers; flawed where some of its rays are wrong or lost by the method's own doing.
enum class Status { ok, flawed, wrong, unsupported, skipped, error };
[[nodiscard]] std::string_view name_of(Status status);

/// The first ray on which a backend differs from openmp.
struct DifferingRay {
    std::uint32_t view = 0, x = 0, y = 0;
    Hit ours{}, openmp{};
};

/// Nodes and triangles of a BVH that rays visit.
struct Visits {
    std::uint64_t rays = 0; ///< that were counted
    std::uint64_t nodes = 0;
    std::uint64_t triangles = 0; ///< tests, of one triangle in two leaves two

    void add(const Visits& other);
};

/// What the verification of one image found out.
struct ImageVerdict {
    RayTotals totals;
    Visits visits;
    Verdicts verdicts;
    bool compared = false; ///< as in Traced, like all down to first_different
    std::uint64_t different = 0;
    std::uint64_t inexact = 0;
    std::uint64_t largest_ulps = 0;
    std::optional<DifferingRay> first_different;
    std::uint64_t hit_hash = 0; ///< of this image's hits
    double kernel_s = 0, wall_s = 0, download_s = 0;
};

/// What the untimed pass over all selected views found out.
struct Traced {
    RayTotals totals;
    Visits visits; ///< see count_visits()
    Verdicts verdicts;
    bool compared = false;          ///< with openmp; openmp's own rows and Embree's have nothing to compare with
    std::uint64_t different = 0;    ///< rays that differ from openmp's by more than the device's self-test allows
    std::uint64_t inexact = 0;      ///< rays that are not openmp's bits, allowed or not
    std::uint64_t largest_ulps = 0; ///< of t, u and v, among those allowed
    std::optional<DifferingRay> first_different;
    std::uint64_t hit_hash = 0; ///< of all hits, view after view
    std::uint64_t first_view_hash = 0;
    std::uint64_t last_view_hash = 0;
    double kernel_s = 0; ///< device seconds of this first pass
    double wall_s = 0;   ///< launch to end, on the host's clock
    double download_s = 0;

    /// Adds an image, all but its hash: images are added in the order of views.
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

/// A row from its selection to its result. Failures end as its outcome.
struct RowRun {
    RowKey key;
    SceneWork* scene = nullptr; ///< null where the scene could not be loaded
    Backend* backend = nullptr;
    Device device;
    std::optional<SelfTest> self_test; ///< of the device in the row's math mode; empty where it runs no kernel of ours
    const Packed* packed = nullptr;    ///< null for kernels that are not portable
    std::unique_ptr<Session> session;
    std::optional<std::size_t> view_of_rays; ///< whose rays the session has been given; see prepare_view()
    Outcome outcome = Traced{};
    double warm_s = 0;                  ///< wall seconds of the pass that warmed it up
    std::vector<double> samples_s;      ///< device seconds for all selected views, one a repetition
    std::vector<double> wall_samples_s; ///< the same on the host's clock, from launch to the end of wait
};

[[nodiscard]] Status status_of(const RowRun& row);
/// Why, in one line; empty where the status is ok.
[[nodiscard]] std::string reason_of(const RowRun& row);
/// "cpu", "gpu" or "emulated"; empty where the row has no device, since its scene could not be loaded.
[[nodiscard]] std::string device_kind_text(const RowRun& row);
/// The rows of a scene, by its label.
[[nodiscard]] std::vector<const RowRun*> rows_of(const std::string& scene, const std::vector<RowRun>& rows);
/// What was traced; null where the row failed or was skipped.
[[nodiscard]] const Traced* traced(const RowRun& row);

/// What a session is told; the same for every row of a run.
[[nodiscard]] SessionOptions session_options(const Options& options);

/// Opens a row's session on its device. Never throws but Error{interrupted}.
[[nodiscard]] RowRun open_row(const RowKey& key, SceneWork& scene, const Options& options);

/// Opens the session of a row of task search on tets that outlive it, on a device of one of the backends. Throws as the
/// other.
[[nodiscard]] RowRun open_row(const RowKey& key, const Packed& tets, const Options& options,
                              const std::vector<Backend*>& backends);

/// A row that could not be opened since its scene could not be loaded.
[[nodiscard]] RowRun failed_row(const RowKey& key, const Error& error);

/// Does a part of a row's work. What is thrown ends as the row's outcome and frees its session; Error{interrupted} goes
/// on.
void guarded(RowRun& row, const std::function<void()>& work);

/// Whether a row's answers fail a run: it is wrong, or its method claims robustness and has lost a ray, or mistaken one
/// unless that passes. Rows without an answer do not fail by themselves.
[[nodiscard]] bool fails(const RowRun& row, bool flawed_passes);

/// The exit code that the rows' statuses come to: 1 where one fails; else that of the first error; else 0.
[[nodiscard]] int exit_code(const std::vector<RowRun>& rows, bool flawed_passes);

} // namespace tetrace
