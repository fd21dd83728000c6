#pragma once

#include "core/base/hash.h"
#include "scenes/build_scene.h"
#include "scenes/cache.h"
#include "scenes/load.h"
#include "scenes/procedural.h"
#include "scenes/scene_file.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <string>

namespace tetrace::test {

/// Builders here are shell scripts: $2 is the mesh, $4 the output, $6 the name.
class Load : public ::testing::Test {
protected:
    Load()
    {
        write_file(mesh, mesh_text);
        request.name = mesh.string();
        request.build.divisions = 3;
        write_scene(prepared, expected());
        use_builder("");
    }

    /// What a builder would make of the mesh: the cubes, marked as made of it.
    [[nodiscard]] Scene expected() const
    {
        Scene scene = make_cubes(3);
        scene.name = "thing";
        scene.build.source_hash = hash_of(mesh_text);
        scene.build.switches = request.build.switches;
        scene.build.duplicate_triangles = 2;
        return scene;
    }
    /// A builder that says that it ran, does as the script says, then gives the prepared scene.
    void use_builder(const std::string& script) const
    {
        const std::string log = "echo \"$*\" >> " + (folder / "runs").string();
        write_file(builder, "#!/bin/sh\n" + log + "\n" + script + "\ncp " + prepared.string() + " \"$4\"\n");
        std::filesystem::permissions(builder, std::filesystem::perms::owner_all);
    }
    [[nodiscard]] std::size_t builder_runs() const
    {
        const std::string log = read_text(folder / "runs");
        return static_cast<std::size_t>(std::count(log.begin(), log.end(), '\n'));
    }
    [[nodiscard]] LoadedScene load() const { return load_scene(request, {}); }
    /// The error with a builder that does this.
    [[nodiscard]] std::string error_with(const std::string& script) const
    {
        use_builder(script);
        return error_of([&] { (void)load(); });
    }
    [[nodiscard]] std::filesystem::path cached() const
    {
        return cached_scene_path("thing", hash_of(mesh_text), request.build);
    }
    /// No work folder, no lock, no scene.
    [[nodiscard]] bool cache_is_clean() const
    {
        std::error_code ignored; // no folder is clean too
        return std::filesystem::is_empty(folder / "cache/tetrace", ignored) || ignored;
    }

    TemporaryFolder folder;
    ScopedVariable xdg{"XDG_CACHE_HOME", folder / "cache"};
    std::filesystem::path builder = folder / "builder.sh", prepared = folder / "prepared.tet",
                          mesh = folder / "thing.off";
    ScopedVariable chosen{"TETRACE_BUILDER", builder};
    std::string mesh_text = "OFF, as far as a shell script cares";
    SceneRequest request;
};

} // namespace tetrace::test
