#pragma once

#include "backends/embree/bvh_builder.h"
#include "bench/options/options.h"
#include "bench/rows/ray_store.h"
#include "core/device/backend.h"
#include "core/mesh/locate.h"
#include "scenes/load.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace tetrace {

/// A scene in packed form, and the cost of packing it.
struct Packed {
    PackedScene data;
    double pack_s = 0;
    std::optional<double> bvh_build_s; ///< of a BVH, which is built once for all its layouts
    std::string fall_back;             ///< of a BVH: why it is not the heuristic's best tree; empty if it is
};

/// How the starts of a moving camera were found, compared with exact location.
struct StartWalk {
    MoveCounts counts;
    double exact_s = 0; ///< seconds for locating the same positions exactly, each on its own
};

/// Where the rays of each view start.
struct ViewStarts {
    std::vector<Start> starts;
    double seconds = 0;            ///< for finding them
    std::optional<StartWalk> walk; ///< of the wide domain, where cameras are inside and move from view to view
};

/// Finds the starts of views, in their order. In the wide domain each is found from the one before, and compared with
/// exact location. Throws Error{internal} if the two differ.
[[nodiscard]] ViewStarts find_starts(const Scene& scene, const std::vector<Float3>& origins);

/// A scene as all sizes of its images share it.
struct SharedScene {
    LoadedScene loaded;
    TetMeshCounts counts;
    std::optional<BuiltBvh> bvh;
    std::map<std::pair<Layout, TetOrder>, Packed> packed;
};

/// A loaded scene with everything that its rows share: packed forms, views, start tets.
class SceneWork {
public:
    /// Takes the views that the options select, and finds the tets where their rays start.
    /// arguments: see arguments(). label: its name in rows.
    SceneWork(std::shared_ptr<SharedScene> shared, const Options& options, std::string arguments, std::string label);
    /// The same with the scene's own name.
    SceneWork(LoadedScene loaded, const Options& options, std::string arguments = {});

    [[nodiscard]] const LoadedScene& loaded() const { return shared_->loaded; }
    [[nodiscard]] const std::shared_ptr<SharedScene>& shared() const { return shared_; }
    [[nodiscard]] const std::string& label() const { return label_; }
    /// The part of a command line that asks for this scene and these images again; empty if no command line asked
    /// for it.
    [[nodiscard]] const std::string& arguments() const { return arguments_; }
    [[nodiscard]] const TetMeshCounts& counts() const { return shared_->counts; }
    [[nodiscard]] const std::vector<std::uint32_t>& view_numbers() const { return view_numbers_; }
    /// Of the numbers of the whole camera set, if its name does not determine them: the user's own, and `frame`.
    [[nodiscard]] const std::optional<std::uint64_t>& camera_set_hash() const { return camera_set_hash_; }
    [[nodiscard]] const std::vector<View>& views() const { return views_; }
    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }
    [[nodiscard]] std::size_t rays_per_view() const { return std::size_t{width_} * height_; }
    /// Seconds for locating the origins of all views.
    [[nodiscard]] double locate_s() const { return locate_s_; }
    /// How the camera's walk from view to view found them; empty if each was located on its own.
    [[nodiscard]] const std::optional<StartWalk>& start_walk() const { return start_walk_; }

    /// Packs at the first call; later calls return the same object. Throws Error{unsupported} as pack() and pack_bvh()
    /// do.
    [[nodiscard]] const Packed& packed(Layout layout, TetOrder order);

    /// The BVH of the scene's mesh, built at the first call.
    [[nodiscard]] const BuiltBvh& bvh();

    /// The given rays, for rows of other kinds than primary.
    [[nodiscard]] RayStore& given_rays() { return given_rays_; }

    /// Forgets all views but the first ones: an interrupted run ends with those that it has completed.
    void keep_first_views(std::size_t count);

    /// The number of a row's rays in a view that enter the domain, counted at the first call for these rays.
    [[nodiscard]] std::uint64_t entering(const RowKey& key, std::size_t view);

    /// The tet of the scene that contains a view's origin; NO_TET if the origin is outside the domain.
    [[nodiscard]] std::uint32_t start_tet(std::size_t view) const { return start_tets_.at(view); }

    /// Host threads used for all work.
    [[nodiscard]] unsigned threads() const { return threads_; }

    /// The job of the view at `index` of views(). packed: null for kernels that are not portable. device: its loops
    /// decide the cap of steps.
    [[nodiscard]] TraceJob job(std::size_t index, const PackedScene* packed,
                               const Device& device = reference_backend().devices().front()) const;

private:
    std::shared_ptr<SharedScene> shared_;
    std::string label_, arguments_;
    std::uint32_t width_, height_;
    std::vector<std::uint32_t> view_numbers_;
    std::optional<std::uint64_t> camera_set_hash_;
    std::vector<View> views_;
    std::vector<std::uint32_t> start_tets_; ///< as the tet mesh numbers them
    double locate_s_ = 0;
    std::optional<StartWalk> start_walk_;
    unsigned threads_;
    RayStore given_rays_;
    /// By kind, whether they are an image's and not given, and view.
    std::map<std::tuple<RayKind, bool, std::size_t>, std::uint64_t> entering_;
};

/// Loads a scene, prints its messages, and prepares it. label: its name in rows; empty: its scene_label().
/// Throws what load_scene() throws.
[[nodiscard]] SceneWork load_work(const SceneRequest& request, const Options& options, const std::string& label = {});

/// The same scene, which both share, with the images of other options. label: its name in rows.
[[nodiscard]] SceneWork resized(const SceneWork& scene, const SceneRequest& request, const Options& options,
                                const std::string& label);

/// Default scenes that are not available here, and how to get them, one sentence each; empty where scenes were named.
[[nodiscard]] std::vector<std::string> missing_default_scenes(const Options& options);

/// Host threads used for all work: the number asked for, else OpenMP's (OMP_NUM_THREADS, else all that the process may
/// use).
[[nodiscard]] unsigned resolved_threads(const Options& options);

/// The part of a command line that asks for the same scene and the same images, and for buffers and tiles alike, as a
/// shell takes it: "--scene cubes --resolution 6 --size 256x256". Views are left out.
[[nodiscard]] std::string scene_arguments(const SceneRequest& request, const Options& options);

} // namespace tetrace
