#pragma once

#include "bench/options/options.h"
#include "core/device/backend.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// One combination to measure; its name is its key in every result.
struct RowKey {
    std::string scene;   ///< label, see scene_label(); with its size if there are several, see SizedScene
    std::string backend; ///< name, see all_backends()
    KernelId kernel;
    RayKind rays = RayKind::primary;
    TetOrder order = TetOrder::chains;
    std::size_t device = 0; ///< index in the backend's devices()
    unsigned threads = 0;   ///< host threads, if they differ from the whole run's
    RayOrder ray_order = RayOrder::tiles;
    unsigned in_flight = 1; ///< launches of a sample that may be on the device together

    friend bool operator==(const RowKey&, const RowKey&) = default;
};

/// The reference's row that does the same work as a row: on its device, with all threads, in schedule tiles, a launch
/// after the other.
[[nodiscard]] RowKey reference_row(RowKey key);

/// Whether two rows do the same work: one kernel, regardless of its schedule, on the same tets, rays and orders.
/// Backends, devices, threads and launches in flight may differ.
[[nodiscard]] bool same_work(const RowKey& a, const RowKey& b);

/// Whether two rows trace the same rays of the same scene in the same order, with any kernels on any device, and
/// for the same task.
[[nodiscard]] bool same_rays(RowKey a, RowKey b);

/// Whether two rows keep their devices busy in the same way, so that their rates may be compared: with as many host
/// threads, and as many launches in flight.
[[nodiscard]] bool same_load(const RowKey& a, const RowKey& b);

/// Whether two rows run in the same place: a backend's device, with the same load.
[[nodiscard]] bool same_place(const RowKey& a, const RowKey& b);

/// Whether the row runs on the reference_backend().
[[nodiscard]] bool on_reference(const RowKey& key);

/// structure/method/layout/scene/rays/math:mode/api:backend, as Google Benchmark shows it; contains no device name and
/// no counts. Rows of another order than chains have "order:hilbert" and the like before the api. Rows of another
/// schedule than tiles have "schedule:persistent". Rows whose given rays come in another order than that of tiles have
/// "rays:morton". Rows of a backend's later devices end in the device's index, "api:opencl:1". Rows of task search have
/// no rays: theirs are given. Rows with other threads than the whole run end in "/threads:1", rows with several
/// launches in flight in "/in_flight:2".
[[nodiscard]] std::string row_name(const RowKey& key);

/// The kernel of these names, as results have them; empty if this tetrace has none.
[[nodiscard]] std::optional<KernelId> kernel_named(std::string_view method, std::string_view layout,
                                                   std::string_view math, std::string_view schedule,
                                                   Task task = Task::trace);

/// The kernels that rows of a task, as options call it, have for rays of a kind. None where a task crosses the domain
/// and the rays have an end.
[[nodiscard]] std::vector<KernelId> kernels_for(Task asked, RayKind kind);

/// Name without the scene, for tables under the scene's heading: "cdt maria tet80".
[[nodiscard]] std::string kernel_title(const RowKey& key);

/// The rows that the options select, scene after scene; rows of one scene in the order of kernels, backends and
/// devices.
/// - Math mode does not select among the rows of Embree and of drivers (rt), nor schedule among Embree's; order selects
/// only among those of the cdt.
/// - Defaults: exact, tiles and (except in `reproduce`) packets, and chains. Without methods, of the cdt only maria
/// and project on half32 and tet64.
/// - Kinds of rays other than primary have rows of the kernels that take rays.
/// - Rows of task segments have given rays, primary ones too, and no kind whose rays have an end.
/// - A backend has rows of its usable devices. A backend without one has rows of its first device where --backend or
/// --require names it.
/// - A kernel that a backend has and a device cannot run still gets a row, which ends as unsupported.
/// - Rows have --launches-in-flight if their device can: a processor's threads begin a launch when the one before it
/// has ended, and the sums of task tally are those of one launch. Throws Error{usage} if no row can.
/// - Layout rt has rows by default only on real GPUs that run it, and elsewhere where --layout, a filter or schedule
/// pipeline names it. Of schedules, tiles (ray queries) and pipeline select among them. If neither is given, a device
/// has one row: ray queries, or a pipeline if it has only that. Throws Error{missing} if a text of --device matches
/// no usable device, listing the usable ones; Error{usage} if nothing is selected: it names the options, and what there
/// would be without them.
[[nodiscard]] std::vector<RowKey> select_rows(const Options& options, const std::vector<std::string>& scene_labels,
                                              const std::vector<Backend*>& backends = all_backends());

/// The same without --filter, which only decides whether there are rows of layout rt.
[[nodiscard]] std::vector<RowKey> unfiltered_rows(const Options& options, const std::vector<std::string>& scene_labels,
                                                  const std::vector<Backend*>& backends = all_backends());
/// Those that --filter keeps, perhaps none.
[[nodiscard]] std::vector<RowKey> filtered_rows(const Options& options, std::vector<RowKey> rows);
/// Throws Error{usage} as select_rows() does if no row is left of the unfiltered ones.
void require_rows(const Options& options, const std::vector<RowKey>& rows, const std::vector<RowKey>& unfiltered);

/// The scene name of rows of task search: the tets of core/rays/search_set.h.
inline constexpr const char* search_scene = "random-tets";

/// The rows of task search, selected in the same way, but --filter may keep none; openmp has an extra row first, on one
/// thread.
[[nodiscard]] std::vector<RowKey> select_search_rows(const Options& options,
                                                     const std::vector<Backend*>& backends = all_backends());

/// "cuda: no device: <reason>" for each backend that select_rows() leaves out because none of its devices is usable.
[[nodiscard]] std::vector<std::string> missing_devices(const Options& options,
                                                       const std::vector<Backend*>& backends = all_backends());

/// Whether --device keeps the backend's device of this index.
[[nodiscard]] bool wanted_device(const Options& options, const Backend& backend, std::size_t index);

/// Whether a kernel of the structure has the method.
[[nodiscard]] bool is_method_of(Structure structure, Method method);

/// The scene, and the rays unless they are primary: "bunny", "bunny, shadow rays", "bunny, ao rays morton".
[[nodiscard]] std::string rays_title(const RowKey& key);

/// A row's device in tables: "opencl", "opencl:1" for a backend's later devices, "openmp, 1 thread", "cuda, 2 in
/// flight".
[[nodiscard]] std::string device_label(const RowKey& key);

/// "cdt maria tet80 on opencl": a row of a scene that the text has already named.
[[nodiscard]] std::string row_label(const RowKey& key);

} // namespace tetrace
