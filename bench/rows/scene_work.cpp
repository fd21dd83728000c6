#include "bench/rows/scene_work.h"

#include "bench/terminal/progress.h"
#include "bench/terminal/text.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/pack/pack_bvh.h"
#include "core/rays/entering.h"

#include <algorithm>
#include <fmt/format.h>
#include <omp.h>

namespace tetrace {

namespace {

std::shared_ptr<SharedScene> shared_scene(LoadedScene loaded)
{
    const TetMeshCounts counts = count_faces(loaded.scene.tets);
    return std::make_shared<SharedScene>(SharedScene{std::move(loaded), counts, {}, {}});
}

} // namespace

SceneWork::SceneWork(LoadedScene loaded, const Options& options, std::string arguments)
    : SceneWork(shared_scene(std::move(loaded)), options, std::move(arguments), {})
{
    label_ = shared_->loaded.scene.name;
}

SceneWork::SceneWork(std::shared_ptr<SharedScene> shared, const Options& options, std::string arguments,
                     std::string label)
    : shared_(std::move(shared)), label_(std::move(label)), arguments_(std::move(arguments)), width_(options.width),
      height_(options.height), view_numbers_(selected_views(options)), threads_(resolved_threads(options))
{
    const TriangleMesh& mesh = loaded().scene.mesh;
    const auto cameras = options.own_cameras ? options.own_cameras->cameras(bounding_sphere(mesh))
                                             : make_cameras(options.camera_set, mesh, loaded().views);
    if (options.own_cameras)
        camera_set_hash_ = options.own_cameras->hash();
    else if (options.camera_set == CameraSet::frame)
        camera_set_hash_ = hash_of_cameras(cameras);
    std::vector<Float3> origins;
    for (const std::uint32_t number : view_numbers_) {
        views_.push_back(make_view(cameras.at(number), width_, height_));
        origins.push_back(views_.back().origin);
    }
    const ViewStarts found = find_starts(loaded().scene, origins);
    for (std::size_t i = 0; i < views_.size(); ++i) {
        views_[i].origin = found.starts[i].origin; // rays of every structure start there
        start_tets_.push_back(found.starts[i].tet);
    }
    locate_s_ = found.seconds;
    start_walk_ = found.walk;
}

const Packed& SceneWork::packed(Layout layout, TetOrder order)
{
    const std::pair key{layout, order};
    if (const auto found = shared_->packed.find(key); found != shared_->packed.end()) return found->second;
    const bool is_bvh = structure_of(layout) == Structure::bvh;
    const BuiltBvh* const built = is_bvh ? &bvh() : nullptr;
    const Stopwatch watch;
    Packed made;
    made.data = is_bvh ? pack_bvh(loaded().scene.mesh, built->bvh, layout) : pack(loaded().scene, layout, order);
    made.pack_s = watch.seconds();
    if (is_bvh) {
        made.bvh_build_s = built->build_s;
        made.fall_back = built->fall_back.empty() ? made.data.fall_back : built->fall_back;
    }
    return shared_->packed.emplace(key, std::move(made)).first->second;
}

const BuiltBvh& SceneWork::bvh()
{
    auto& bvh = shared_->bvh;
    if (!bvh) bvh = build_bvh(loaded().scene.mesh, threads_);
    return *bvh;
}

void SceneWork::keep_first_views(std::size_t count)
{
    view_numbers_.resize(count);
    views_.resize(count);
    start_tets_.resize(count);
}

std::uint64_t SceneWork::entering(const RowKey& key, std::size_t view)
{
    const bool is_image = !traits_of(key.kernel.task).takes_rays;
    const auto [entry, is_new] = entering_.try_emplace({key.rays, is_image, view});
    if (!is_new) return entry->second;
    const Domain& domain = loaded().scene.domain;
    entry->second = is_image ? count_entering(domain, views_.at(view), width_, height_)
                             : count_entering(domain, given_rays_.set(*this, key.rays, key.ray_order, view).rays);
    return entry->second;
}

TraceJob SceneWork::job(std::size_t index, const PackedScene* packed, const Device& device) const
{
    TraceJob job;
    job.view = views_.at(index);
    job.width = width_;
    job.height = height_;
    if (packed != nullptr && structure_of(packed->layout) == Structure::cdt)
        start_in(job, *packed, loaded().scene, start_tets_[index]);
    job.max_steps = step_cap(counts().tets, device);
    return job;
}

SceneWork load_work(const SceneRequest& request, const Options& options, const std::string& label)
{
    LoadedScene loaded = load_scene(request, progress_line().callback());
    progress_line().clear();
    loaded.scene.name = label.empty() ? scene_label(request.name) : label;
    for (const std::string& message : loaded.messages)
        say(fmt::format("{}: {}", loaded.scene.name, message));
    if (loaded.no_tets)
        say(fmt::format("{}: {}; its rows of structure bvh run without tets", loaded.scene.name,
                        loaded.no_tets->what()));
    progress_line().show("preparing " + loaded.scene.name, -1);
    return {std::move(loaded), options, scene_arguments(request, options)};
}

SceneWork resized(const SceneWork& scene, const SceneRequest& request, const Options& options, const std::string& label)
{
    return {scene.shared(), options, scene_arguments(request, options), label};
}

std::vector<std::string> missing_default_scenes(const Options& options)
{
    std::vector<std::string> reasons;
    if (!options.scenes.empty()) return reasons;
    for (const char* const name : {"bunny", "armadillo"})
        if (const std::string reason = why_not_available(name); !reason.empty())
            reasons.push_back(fmt::format("{} is left out: {}", name, reason));
    return reasons;
}

unsigned resolved_threads(const Options& options)
{
    return options.threads != 0 ? options.threads : static_cast<unsigned>(omp_get_max_threads());
}

std::string scene_arguments(const SceneRequest& request, const Options& options)
{
    std::string text = "--scene " + shell_word(request.name);
    const auto add = [&](const char* option, const std::string& value, bool is_default) {
        if (!is_default) text += fmt::format(" {} {}", option, shell_word(value));
    };
    if (!options.repair.value_or(true)) text += " --no-repair";
    const Options usual;
    add("--domain", std::string(name_of(options.domains.front())), options.domains == usual.domains);
    add("--tets", std::string(name_of(options.tets.front())), options.tets == usual.tets && !options.names_tets);
    add("--effort", fmt::format("{}", options.effort), options.effort == usual.effort);
    for (const std::uint32_t divisions : options.divisions)
        add("--divisions", fmt::format("{}", divisions), false);
    for (const std::string& switches : options.switches)
        add("--switches", switches, false);
    add("--resolution", fmt::format("{}", options.resolution), options.resolution == usual.resolution);
    add("--optimise-time", fmt::format("{}", options.optimise_s), options.optimise_s == usual.optimise_s);
    add("--camera-set", options.own_cameras ? options.own_cameras->file : camera_set_name(options),
        !options.own_cameras && options.camera_set == usual.camera_set);
    add("--size", fmt::format("{}x{}", options.width, options.height), false);
    add("--tile", fmt::format("8x{}", options.tile_height), options.tile_height == 0);
    add("--packet-lanes", fmt::format("{}", options.packet_lanes), options.packet_lanes == 0);
    add("--buffer-limit", fmt::format("{}", options.buffer_limit), options.buffer_limit == 0);
    return text;
}

namespace {

ViewStarts locate_each(const Scene& scene, const std::vector<Float3>& origins)
{
    ViewStarts found;
    const Stopwatch watch;
    for (const Float3 origin : origins)
        found.starts.push_back(find_start(scene, origin));
    found.seconds = watch.seconds();
    return found;
}

} // namespace

ViewStarts find_starts(const Scene& scene, const std::vector<Float3>& origins)
{
    const ViewStarts exact = locate_each(scene, origins);
    if (scene.domain.kind != DomainKind::wide || scene.tets.tets.empty()) return exact;
    ViewStarts found;
    MovingStart camera(scene, usual_move_limit(scene.domain));
    const Stopwatch watch;
    for (const Float3 origin : origins)
        found.starts.push_back(camera.next(origin));
    found.seconds = watch.seconds();
    found.walk = StartWalk{camera.counts(), exact.seconds};
    for (std::size_t view = 0; view < origins.size(); ++view)
        if (found.starts[view] != exact.starts[view])
            throw Error(ErrorKind::internal, fmt::format("walking to the camera of view {} ends in tet {}, where exact "
                                                         "location finds tet {}",
                                                         view, found.starts[view].tet, exact.starts[view].tet));
    return found;
}

} // namespace tetrace
