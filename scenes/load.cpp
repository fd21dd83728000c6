#include "scenes/load.h"

#include "core/base/did_you_mean.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"
#include "scenes/build_scene.h"
#include "scenes/builder_exit.h"
#include "scenes/cache.h"
#include "scenes/gltf_buffers.h"
#include "scenes/load_pinned.h"
#include "scenes/mesh_files.h"
#include "scenes/procedural.h"
#include "scenes/raw_mesh.h"
#include "scenes/scene_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <optional>
#include <span>
#include <utility>

namespace tetrace {

namespace fs = std::filesystem;

namespace {

bool is_unfinished(const Scene& scene)
{
    return scene.build.optimised.end != OptimiserEnd::finished;
}

/// Says that the tets are not the file's, if it has some.
void tell_optimised(LoadedScene& loaded)
{
    const Scene& scene = loaded.scene;
    if (scene.source_tets.empty() || scene.build.optimised.tets != TetsKind::rays) return;
    loaded.messages.push_back(
        fmt::format("{} tets, made for rays, take the place of the file's (--tets rays): they have its regions and the "
                    "faces between these, but not its numbers, so a tally is by region",
                    scene.source_tets.size()));
}

/// Loads a scene of a mesh from the cache, or builds it into the cache first.
class MeshSceneLoader {
public:
    MeshSceneLoader(const SceneRequest& request, fs::path mesh, const Progress& progress)
        : request_(request), progress_(progress), label_(scene_label(request.name)), mesh_(std::move(mesh)),
          mesh_hash_(hash_mesh())
    {
        request_.build.optimise_own = request_.build.optimise_own && may_have_tets(mesh_);
        file_ = cached_scene_path(label_, mesh_hash_, request_.build);
    }

    [[nodiscard]] LoadedScene load()
    {
        if (!read_cached()) build_alone();
        loaded_.hash = scene_hash(loaded_.scene);
        loaded_.file = file_;
        tell_optimised(loaded_);
        return std::move(loaded_);
    }

private:
    [[nodiscard]] std::uint64_t hash_mesh() const;
    [[nodiscard]] std::string mismatch(const Scene& scene) const;
    [[nodiscard]] bool read_cached();
    void build_alone();
    void build();
    void set_apart();
    void tell(const std::string& stage) const
    {
        if (progress_) progress_(stage, -1, "");
    }

    SceneRequest request_;
    const Progress& progress_;
    std::string label_;
    fs::path mesh_;
    std::uint64_t mesh_hash_;
    fs::path file_;
    LoadedScene loaded_;
};

/// In pieces: the builder, which takes the whole file at once, has a limit of memory, and this process has none.
std::uint64_t MeshSceneLoader::hash_mesh() const
{
    Hasher hasher;
    std::string extension = lower_extension(mesh_);
    fs::path file = mesh_;
    // Tets and vertices are in both files; points without tets in one.
    std::error_code ignored; // then the points have no tets
    if (extension == ".node" && fs::exists(fs::path(mesh_).replace_extension(".ele"), ignored))
        file.replace_extension(extension = ".ele");
    if (add_file(hasher, file) == 0)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("reading mesh {}: it is empty, no regular file, or may not be read", file.string()));
    if (extension == ".ele") add_file(hasher, file.replace_extension(".node"));
    if (extension == ".gltf") add_gltf_buffers(hasher, mesh_, file_bytes(mesh_).value_or(""));
    return hasher.hash();
}

/// Empty if the scene is the one that was asked for, else what differs.
std::string MeshSceneLoader::mismatch(const Scene& scene) const
{
    const BuildOptions& asked = request_.build;
    if (scene.build.source_hash != mesh_hash_) return "it was made from another mesh";
    if (scene.domain.kind != asked.domain || scene.domain.divisions != asked.divisions)
        return "its domain is another one";
    const auto others = fallback_attempts(asked);
    if (scene.build.switches != asked.switches &&
        std::ranges::find(others, scene.build.switches, &TetsAttempt::switches) == others.end())
        return fmt::format("it was made with the switches {}, not {}", scene.build.switches, asked.switches);
    if (scene.build.repair.asked && !asked.repair) return "its mesh was to be repaired";
    const OptimisedInfo& made = scene.build.optimised;
    if (made.asked != asked.tets)
        return fmt::format("its tets are of kind {}, not {}", name_of(made.asked), name_of(asked.tets));
    if (asked.tets == TetsKind::rays && made.effort != asked.effort)
        return fmt::format("its tets were optimised with effort {}, not {}", made.effort, asked.effort);
    return "";
}

bool MeshSceneLoader::read_cached()
{
    std::error_code ignored; // what cannot be looked at is reported by the attempt to write it
    if (!fs::exists(file_, ignored)) return false;
    tell(fmt::format("reading {} from the cache", label_));
    try {
        loaded_.scene = read_scene(file_);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::unsupported) throw; // not enough memory: building would not help
        // Cleared between our look and our read: nothing to report.
        if (error.kind() != ErrorKind::missing)
            loaded_.messages.push_back(fmt::format("{}; the cache's file is built again", error.what()));
        return false;
    }
    std::string difference = mismatch(loaded_.scene);
    if (difference.empty() && is_unfinished(loaded_.scene)) difference = "its optimiser was stopped early";
    if (!difference.empty())
        loaded_.messages.push_back(
            fmt::format("reading scene {}: foreign file: {}; built again", file_.string(), difference));
    const BuildInfo& info = loaded_.scene.build;
    const bool has_own = !loaded_.scene.source_tets.empty();
    if (difference.empty() && !info.optimised.reason.empty() && (!has_own || request_.build.optimise_own))
        loaded_.messages.push_back(
            fmt::format("the tets are {}: {}", has_own ? "the file's" : "TetGen's", info.optimised.reason));
    const RepairInfo& repair = info.repair;
    if (difference.empty() && repair.crossing_pairs > 0)
        loaded_.messages.push_back(
            fmt::format("repaired when it was built: {} pairs of triangles crossed, and {} triangles were cut into {}",
                        repair.crossing_pairs, repair.cut_triangles, repair.pieces));
    if (difference.empty() && repair.tolerance > 0)
        loaded_.messages.push_back(fmt::format("the repair moved faces by up to {:.1e} to merge near layers",
                                               std::ldexp(repair.moved, -info.scale_exponent)));
    if (difference.empty() && info.switches != request_.build.switches)
        loaded_.messages.push_back(fmt::format("made {}, since TetGen's switches {} failed",
                                               info.switches == cgal_switches ? "by CGAL" : "with " + info.switches,
                                               request_.build.switches));
    if (difference.empty() && info.degenerate_triangles + info.duplicate_triangles > 0)
        loaded_.messages.push_back(
            fmt::format("{} degenerate and {} duplicate triangles were removed when it was built",
                        info.degenerate_triangles, info.duplicate_triangles));
    if (difference.empty() && info.centre != Double3{})
        loaded_.messages.push_back(fmt::format("({}, {}, {}) was subtracted from its coordinates when it was built",
                                               info.centre.x, info.centre.y, info.centre.z));
    loaded_.from_cache = difference.empty();
    return loaded_.from_cache;
}

void MeshSceneLoader::build_alone()
{
    file_ = cache_directory() / file_.filename(); // it was looked for in a cache that can only be read, too
    make_cache_folder(file_.parent_path());
    const FileLock lock =
        FileLock::wait_for(file_, [&] { tell(fmt::format("waiting for another process that builds {}", label_)); });
    clear_leftovers(file_);
    loaded_.messages.clear();    // the second look says again what is still wrong
    if (!read_cached()) build(); // another process may have built it while we waited
}

/// What the optimiser reached depends on the moment that it was stopped in, so the key does not identify it.
void MeshSceneLoader::set_apart()
{
    const OptimiserEnd end = loaded_.scene.build.optimised.end;
    file_ = cache_directory() / cached_scene_path(label_ + ".unfinished", mesh_hash_, request_.build).filename();
    loaded_.messages.push_back(fmt::format(
        "the optimiser was stopped early ({}); what it had reached is {}, which --scene takes{}", name_of(end),
        file_.string(), end == OptimiserEnd::out_of_time ? "; --optimise-time allows it more" : ""));
}

void MeshSceneLoader::build()
{
    const BuildFolder work(file_);
    const fs::path made = work.path() / "scene.tet";
    const BuildEnd end = build_scene(mesh_, made, label_, request_.build, progress_, loaded_.messages);
    loaded_.interrupted = end.interrupted;
    loaded_.no_tets = end.no_tets;
    tell(fmt::format("checking {}", label_));
    try {
        loaded_.scene = read_scene(made, end.no_tets ? SceneFileKind::mesh_only : SceneFileKind::whole);
    } catch (const Error& error) {
        throw Error(ErrorKind::internal,
                    fmt::format("building scene {} with switches {}: the builder reported success, but "
                                "its file cannot be used: {}",
                                label_, request_.build.switches, error.what()));
    }
    if (end.no_tets) { // the next run tries again
        file_.clear();
        return;
    }
    const std::string difference = mismatch(loaded_.scene);
    if (!difference.empty())
        throw Error(ErrorKind::internal, fmt::format("building scene {}: the builder made another scene than asked: {}",
                                                     label_, difference));
    if (is_unfinished(loaded_.scene)) set_apart();
    std::error_code failure;
    fs::rename(made, file_, failure);
    if (failure)
        throw Error(ErrorKind::invalid_input, fmt::format("building scene {}: {} cannot be put into the cache: {}",
                                                          label_, file_.string(), failure.message()));
}

/// Which of these options differ from their defaults, in the options' own words.
struct Unused {
    const BuildOptions& asked;
    std::vector<std::string> options;
    const BuildOptions standard = default_build(asked.tets);

    void add_build()
    {
        if (asked.domain != standard.domain) options.emplace_back("--domain");
        if (asked.divisions != standard.divisions) options.emplace_back("--divisions");
        if (asked.switches != standard.switches) options.emplace_back("--switches");
        if (asked.effort != standard.effort) options.emplace_back("--effort");
        if (asked.repair != standard.repair) options.emplace_back("--no-repair");
    }
    void add_resolution()
    {
        if (asked.resolution != standard.resolution) options.emplace_back("--resolution");
    }
    /// why: what kind of scene it is, that it ignores them.
    void tell(const std::string& name, const std::string& why, LoadedScene& loaded) const
    {
        if (options.empty()) return;
        const bool one = options.size() == 1;
        loaded.messages.push_back(
            fmt::format("scene {}: {}: {} {} not used", name, why, fmt::join(options, ", "), one ? "is" : "are"));
    }
};

/// A scene that is made here, without a builder and without the cache.
LoadedScene made_in_place(const SceneRequest& request, const Progress& progress, const std::function<Scene()>& make)
{
    if (progress) progress("making " + request.name, -1, "");
    const Stopwatch watch;
    LoadedScene loaded;
    loaded.scene = make();
    loaded.scene.build.build_s = watch.seconds();
    loaded.hash = scene_hash(loaded.scene);
    return loaded;
}

constexpr const char* own_domain = "it is made in place, in a domain of its own";

LoadedScene load_cubes(const SceneRequest& request, const Progress& progress)
{
    LoadedScene loaded = made_in_place(request, progress, [&] { return make_cubes(request.build.resolution); });
    Unused unused{request.build, {}};
    unused.add_build();
    unused.tell(request.name, own_domain, loaded);
    return loaded;
}

LoadedScene load_lattice(const SceneRequest& request, std::uint32_t resolution, const Progress& progress)
{
    LoadedScene loaded = made_in_place(request, progress, [&] { return make_lattice(resolution); });
    Unused unused{request.build, {}};
    unused.add_build();
    unused.add_resolution();
    unused.tell(request.name, own_domain, loaded);
    return loaded;
}

/// The views of the procedural scene, in its usual size, from whose mesh a scene file was made; none of another file.
std::vector<Aim> own_views(const BuildInfo& build)
{
    for (const CatalogueEntry& entry : catalogue())
        if (entry.procedural && fs::path(build.source).stem() == entry.name &&
            build.source_hash == hash_of_mesh_file(ProceduralScene{entry, {}}))
            return entry.views;
    return {};
}

LoadedScene load_scene_file(const SceneRequest& request, const Progress& progress)
{
    if (progress) progress(fmt::format("reading {}", request.name), -1, "");
    LoadedScene loaded;
    loaded.scene = read_scene(request.name);
    loaded.hash = scene_hash(loaded.scene);
    loaded.file = request.name;
    loaded.views = own_views(loaded.scene.build);
    tell_optimised(loaded);
    Unused unused{request.build, {}};
    unused.add_build();
    unused.add_resolution();
    unused.tell(request.name, "the file is its own scene", loaded);
    return loaded;
}

LoadedScene load_mesh_scene(const SceneRequest& request, const fs::path& mesh, const Progress& progress)
{
    LoadedScene loaded = MeshSceneLoader(request, mesh, progress).load();
    Unused unused{request.build, {}};
    unused.add_resolution();
    unused.tell(request.name, "it is made of a mesh, and only cubes have a resolution", loaded);
    Unused optimiser{request.build, {}};
    if (!loaded.scene.source_tets.empty() && !request.build.optimise_own &&
        request.build.effort != unused.standard.effort)
        optimiser.options.emplace_back("--effort");
    optimiser.tell(request.name, "the tets of its file are kept without --tets rays", loaded);
    return loaded;
}

[[noreturn]] void refuse_name(const std::string& name)
{
    std::vector<std::string> names;
    for (const CatalogueEntry& entry : catalogue())
        names.push_back(entry.name);
    for (const PinnedScene& pinned : pinned_scenes())
        names.emplace_back(pinned.name);
    const bool is_path = name.find('/') != std::string::npos || fs::path(name).has_extension();
    throw Error(
        is_path ? ErrorKind::missing : ErrorKind::usage,
        fmt::format(
            "scene {}: neither a name of the catalogue ({}) nor a file; give one of these names, or the "
            "path of a mesh (.ply, .obj, .off, .stl, .glb, .gltf; of tets: .mesh, .msh, .ele, .vtk, .vtu) or of a "
            ".tet file{}",
            name, fmt::join(names, ", "), did_you_mean(name, names)));
}

} // namespace

LoadedScene load_scene(const SceneRequest& request, const Progress& progress)
{
    if (const PinnedScene* const pinned = find_pinned(request.name)) {
        LoadedScene loaded = load_pinned(*pinned, request, progress, [&](const fs::path& mesh) {
            return MeshSceneLoader(request, mesh, progress).load();
        });
        loaded.views = find_in_catalogue(std::string(pinned->of))->views;
        return loaded;
    }
    if (const auto resolution = lattice_resolution(request.name)) return load_lattice(request, *resolution, progress);
    if (const auto procedural = find_procedural(request.name)) {
        LoadedScene loaded = load_mesh_scene(request, mesh_file(*procedural), progress);
        loaded.views = procedural->entry.views;
        return loaded;
    }
    if (const CatalogueEntry* entry = find_in_catalogue(request.name)) {
        if (entry->source == SceneSource::cubes) return load_cubes(request, progress);
        return load_mesh_scene(request, mesh_file(*entry), progress);
    }
    const fs::path path = request.name;
    std::error_code ignored; // what cannot be looked at is not a file for us
    if (!fs::exists(path, ignored)) refuse_name(request.name);
    if (path.extension() == ".tet") return load_scene_file(request, progress);
    return load_mesh_scene(request, is_stream(path) ? spooled_mesh(path) : path, progress);
}

namespace {

ReadMesh read_mesh_file(const std::string& name, const fs::path& file, const Progress& progress)
{
    ReadMesh read{{}, file, {}};
    const BuildFolder folder(cache_directory() / (scene_label(name) + ".read"));
    const fs::path raw = folder.path() / "mesh";
    read_mesh_only(file, raw, scene_label(name), progress, read.messages);
    read.mesh = read_raw_mesh(raw);
    return read;
}

} // namespace

ReadMesh read_mesh_of(const std::string& name, const Progress& progress)
{
    if (is_made_in_place(name)) return {load_scene({name, {}}, progress).scene.mesh, {}, {}};
    if (const auto procedural = find_procedural(name)) return read_mesh_file(name, mesh_file(*procedural), progress);
    if (const CatalogueEntry* entry = find_in_catalogue(name)) return read_mesh_file(name, mesh_file(*entry), progress);
    const fs::path path = name;
    if (find_pinned(name) != nullptr || path.extension() == ".tet")
        throw Error(ErrorKind::usage,
                    fmt::format("scene {}: its mesh has been cleaned and placed, and rays in the coordinates of a mesh "
                                "file would not fit it; name the mesh file, or a scene without -1",
                                name));
    std::error_code ignored; // as above
    if (!fs::exists(path, ignored)) refuse_name(name);
    return read_mesh_file(name, is_stream(path) ? spooled_mesh(path) : path, progress);
}

} // namespace tetrace
