#pragma once

#include "bench/options/options.h"
#include "core/device/backend.h"

#include <string>
#include <vector>

namespace tetrace {

/// What is measured, one combination; its name is its key in every result.
struct RowKey {
    std::string scene;   ///< label, see scene_label()
    std::string backend; ///< name, see all_backends()
    KernelId kernel;
    RayKind rays = RayKind::primary;
    TetOrder order = TetOrder::hilbert;
    std::size_t device = 0; ///< index in the backend's devices()
    unsigned threads = 0;   ///< host threads, where not those of the whole run
    RayOrder ray_order = RayOrder::tiles;

    friend bool operator==(const RowKey&, const RowKey&) = default;
};

/// The row of the reference that does the work of a row: on its device, with all threads, in schedule tiles.
[[nodiscard]] RowKey reference_row(RowKey key);

/// Whether two rows do the same work: one kernel, but for its schedule, on the same tets, rays and orders. Backends,
/// devices and threads may differ.
[[nodiscard]] bool same_work(const RowKey& a, const RowKey& b);

/// Whether two rows trace the same rays of the same scene in the same order, with whatever kernels and wherever.
[[nodiscard]] bool same_rays(RowKey a, RowKey b);

/// Whether two rows run in the same place: a backend's device, with the same threads.
[[nodiscard]] bool same_place(const RowKey& a, const RowKey& b);

/// Whether the row runs on the reference_backend().
[[nodiscard]] bool on_reference(const RowKey& key);

/// structure/method/layout/scene/rays/math:mode/api:backend, as Google Benchmark shows it; no device's name and no
/// counts in it. Rows of another order than hilbert have "order:reached" or "order:input" before the api, rows of
/// another schedule than tiles "schedule:persistent", rows whose given rays come in another order than that of tiles
/// "rays:morton"; rows of a backend's later devices have their index behind it, "api:opencl:1". Rows of task search
/// have no rays: theirs are given.
[[nodiscard]] std::string row_name(const RowKey& key);

/// Name without the scene, for tables headed by it: "cdt maria tet80".
[[nodiscard]] std::string kernel_title(const RowKey& key);

/// The rows that the options select, scene after scene, rows of one scene in the order of kernels, backends and
/// devices. Math mode and schedule do not select among Embree's rows and drivers' (rt), order among those of the cdt
/// only; without those options, exact, tiles and (but in `reproduce`) packets, and hilbert, and without methods only
/// maria and project on half32 of the cdt's. Kinds of rays but primary have rows of the kernels that take rays. A
/// backend has rows of its usable devices; one that has none, of its first where --backend or --require names it. A
/// kernel that a backend has and a device cannot run is a row all the same: it will end as unsupported. Layout rt has
/// rows by default only on real GPUs that run it, elsewhere where --layout or a filter names it. Throws Error{usage}
/// where nothing is selected: it names the options, and what there would be without them.
[[nodiscard]] std::vector<RowKey> select_rows(const Options& options, const std::vector<std::string>& scene_labels,
                                              const std::vector<Backend*>& backends = all_backends());

/// What rows of task search call the tets of core/rays/search_set.h.
inline constexpr const char* search_scene = "random-tets";

/// The rows of task search that the options select, in the same way; openmp has one more in front, on one thread.
[[nodiscard]] std::vector<RowKey> select_search_rows(const Options& options,
                                                     const std::vector<Backend*>& backends = all_backends());

/// "cuda: no device: <reason>" for each backend that select_rows() leaves out since none of its devices is usable.
[[nodiscard]] std::vector<std::string> missing_devices(const Options& options,
                                                       const std::vector<Backend*>& backends = all_backends());

/// "opencl", with ":1" behind it for a backend's later devices, "openmp, 1 thread": a row's device in tables.
[[nodiscard]] std::string device_label(const RowKey& key);

/// "cdt maria tet80 on opencl": a row of a scene that is named already.
[[nodiscard]] std::string row_label(const RowKey& key);

} // namespace tetrace
