#include "scenes/load_pinned.h"

#include "core/base/error.h"
#include "core/base/hash.h"
#include "scenes/build_scene.h"
#include "scenes/cache.h"
#include "scenes/gltf_buffers.h"
#include "scenes/mesh_files.h"
#include "scenes/scene_file.h"
#include "scenes/stored_tets.h"

#include <fmt/format.h>

namespace tetrace {

namespace fs = std::filesystem;

namespace {

void require_usual_build(const PinnedScene& pinned, const BuildOptions& asked)
{
    if (!is_usual_build(asked))
        throw Error(ErrorKind::usage,
                    fmt::format("scene {0}: its tets are pinned, so no option changes how they are made; "
                                "leave out --tets, --effort, --domain and the like, or name the scene {1}",
                                pinned.name, pinned.of));
}

fs::path mesh_of(const PinnedScene& pinned)
{
    const std::string name(pinned.of);
    const auto procedural = find_procedural(name);
    return procedural ? mesh_file(*procedural) : mesh_file(*find_in_catalogue(name));
}

/// Empty if it is the pinned mesh.
std::string other_mesh(const PinnedScene& pinned, const fs::path& mesh)
{
    Hasher hasher;
    add_file(hasher, mesh);
    if (hasher.hash() == pinned.source_hash) return {};
    return fmt::format("{} is another mesh: its bytes have the hash {}, and those of {} the hash {}", mesh.string(),
                       hash_text(hasher.hash()), pinned.name, hash_text(pinned.source_hash));
}

/// The name of its file in the cache if its stored tets are used.
std::string cached_name(const PinnedScene& pinned)
{
    return fmt::format("{}-{}.tet", pinned.name, hash_text(pinned.scene_hash));
}

std::optional<LoadedScene> read_cached(const PinnedScene& pinned, const fs::path& file)
{
    std::error_code ignored; // what cannot be looked at is made again
    if (!fs::exists(file, ignored)) return std::nullopt;
    try {
        LoadedScene loaded;
        loaded.scene = read_scene(file);
        loaded.hash = scene_hash(loaded.scene);
        loaded.file = file;
        loaded.from_cache = true;
        if (loaded.hash == pinned.scene_hash) return loaded;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::unsupported) throw; // not enough memory
    }
    return std::nullopt; // damaged or foreign, and written anew
}

Scene joined_scene(const PinnedScene& pinned, const fs::path& mesh_only)
{
    const Scene placed = read_scene(mesh_only, SceneFileKind::mesh_only);
    Scene scene = with_stored_tets(placed, pinned.tets);
    scene.build.build_s = 0;
    scene.build.tool = fmt::format("{}, stored in tetrace", pinned.tool);
    scene.build.optimised = {.asked = TetsKind::rays,
                             .tets = TetsKind::rays,
                             .reason = {},
                             .effort = usual_effort,
                             .cost_before = pinned.cost_before,
                             .cost_after = pinned.cost_after};
    if (const std::uint64_t hash = scene_hash(scene); hash != pinned.scene_hash)
        throw Error(ErrorKind::internal, fmt::format("scene {}: joined with its stored tets, the mesh gives a scene of "
                                                     "hash {}, not {}",
                                                     pinned.name, hash_text(hash), hash_text(pinned.scene_hash)));
    return scene;
}

LoadedScene from_stored_tets(const PinnedScene& pinned, const SceneRequest& request, const fs::path& mesh,
                             const Progress& progress)
{
    const fs::path file = cache_directory() / cached_name(pinned);
    make_cache_folder(file.parent_path());
    const FileLock lock = FileLock::wait_for(file, [&] {
        if (progress) progress(fmt::format("waiting for another process that builds {}", pinned.name), -1, "");
    });
    clear_leftovers(file);
    if (auto cached = read_cached(pinned, file)) return std::move(*cached); // by the process that had the lock
    LoadedScene loaded;
    const BuildFolder work(file);
    const fs::path mesh_only = work.path() / "mesh.tet", joined = work.path() / "joined.tet";
    build_mesh_only(mesh, mesh_only, std::string(pinned.of), request.build, progress, loaded.messages);
    write_scene(joined, joined_scene(pinned, mesh_only));
    loaded.scene = read_scene(joined); // which checks it as any other scene
    loaded.hash = pinned.scene_hash;
    loaded.file = file;
    std::error_code failure;
    fs::rename(joined, file, failure);
    if (failure)
        throw Error(ErrorKind::invalid_input, fmt::format("loading scene {}: {} cannot be put into the cache: {}",
                                                          pinned.name, file.string(), failure.message()));
    return loaded;
}

/// Why a scene that was built here is not the pinned one.
std::string why_other(const LoadedScene& built)
{
    if (built.no_tets) return fmt::format("making them here failed: {}", built.no_tets->what());
    const OptimisedInfo& made = built.scene.build.optimised;
    if (made.end != OptimiserEnd::finished)
        return fmt::format("the optimiser was stopped early ({})", name_of(made.end));
    return fmt::format("{} makes others here", built.scene.build.tool);
}

} // namespace

LoadedScene load_pinned(const PinnedScene& pinned, const SceneRequest& request, const Progress& progress,
                        const std::function<LoadedScene(const fs::path& mesh)>& build)
{
    require_usual_build(pinned, request.build);
    const fs::path mesh = mesh_of(pinned);
    if (const std::string difference = other_mesh(pinned, mesh); !difference.empty()) {
        if (!request.is_default)
            throw Error(ErrorKind::invalid_input, fmt::format("scene {}: {}; name the scene {} to use this mesh",
                                                              pinned.name, difference, pinned.of));
        LoadedScene built = build(mesh);
        built.messages.push_back(fmt::format("not {}: {}", pinned.name, difference));
        return built;
    }
    LoadedScene loaded;
    std::string reason = "another optimiser made them";
    if (auto cached = read_cached(pinned, path_to_read(cached_name(pinned))))
        loaded = std::move(*cached);
    else {
        std::vector<std::string> messages;
        if (pinned.optimiser == optimiser_version) {
            try {
                LoadedScene built = build(mesh);
                if (built.hash == pinned.scene_hash || built.interrupted) return built;
                reason = why_other(built);
                messages = std::move(built.messages);
            } catch (const Error& error) {
                if (error.kind() == ErrorKind::interrupted || error.kind() == ErrorKind::missing) throw;
                reason = fmt::format("making them here failed: {}", error.what());
            }
        }
        loaded = from_stored_tets(pinned, request, mesh, progress);
        loaded.messages.insert(loaded.messages.begin(), messages.begin(), messages.end());
        loaded.messages.push_back(fmt::format("{} is not made here: {}", pinned.name, reason));
    }
    loaded.messages.push_back(fmt::format("the tets are those of {} that tetrace stores", pinned.name));
    return loaded;
}

} // namespace tetrace
