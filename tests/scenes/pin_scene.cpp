// usage: pin_scene SCENE.tet OUT.tets.xz
// Stores a scene's tets for scenes/pinned, and prints what its row of scenes/pinned.cpp needs.

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/rays/camera_set.h"
#include "scenes/cache.h"
#include "scenes/catalogue.h"
#include "scenes/scene_file.h"
#include "scenes/stored_tets.h"

#include <cstdio>

using namespace tetrace;

int main(int count, char** arguments)
{
    if (count != 3) {
        std::fprintf(stderr, "usage: pin_scene SCENE.tet OUT.tets.xz\n");
        return 2;
    }
    try {
        const Scene scene = read_scene(arguments[1]);
        const auto stored = store_tets(scene);
        write_whole(arguments[2], {reinterpret_cast<const char*>(stored.data()), stored.size()});
        const CatalogueEntry* const entry = find_in_catalogue(scene.name);
        const auto cameras =
            make_cameras(CameraSet::frame, scene.mesh, entry != nullptr ? entry->views : std::vector<Aim>());
        const OptimisedInfo& made = scene.build.optimised;
        std::printf(
            "of %s; source %s, mesh %s, scene %s, cameras %s; optimiser %u, %s, cost %.17g to %.17g; %zu bytes\n",
            scene.name.c_str(), hash_text(scene.build.source_hash).c_str(), hash_text(mesh_hash(scene.mesh)).c_str(),
            hash_text(scene_hash(scene)).c_str(), hash_text(hash_of_cameras(cameras)).c_str(), optimiser_version,
            scene.build.tool.c_str(), made.cost_before, made.cost_after, stored.size());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "pin_scene: %s\n", error.what());
        return 3;
    }
    return 0;
}
