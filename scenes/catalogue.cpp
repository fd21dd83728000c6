#include "scenes/catalogue.h"

#include "scenes/build_scene.h"
#include "scenes/mesh_files.h"

#include <fmt/format.h>

namespace tetrace {

const std::vector<CatalogueEntry>& catalogue()
{
    static const std::vector<CatalogueEntry> rows = {
        {"cubes",
         SceneSource::cubes,
         "jittered grid of cubes cut into tets round a blocky ball; needs no TetGen",
         "",
         {}},
        {"banana", SceneSource::banana, "procedural curved tube, 25,000 triangles", "", {}},
        {"bunny",
         SceneSource::file,
         "Stanford's bunny, 75,408 triangles as Debian's libcgal-demo has it",
         "data/meshes/bunny00.off",
         {"bunny00.off", "bunny.ply", "bun_zipper.ply"}},
        {"armadillo",
         SceneSource::file,
         "Stanford's armadillo, 52,000 triangles as Debian's libcgal-demo has it",
         "data/meshes/armadillo.off",
         {"armadillo.off", "armadillo.ply", "Armadillo.ply"}},
    };
    return rows;
}

const CatalogueEntry* find_in_catalogue(const std::string& name)
{
    for (const CatalogueEntry& entry : catalogue())
        if (entry.name == name) return &entry;
    return nullptr;
}

std::string scene_label(const std::string& name)
{
    return find_in_catalogue(name) != nullptr ? name : std::filesystem::path(name).stem().string();
}

std::string why_not_available(const std::string& name)
{
    const CatalogueEntry* entry = find_in_catalogue(name);
    if (entry != nullptr) return entry->source == SceneSource::file ? locate_mesh(*entry).reason : "";
    std::error_code ignored; // what cannot be looked at is not there for us
    if (std::filesystem::is_regular_file(name, ignored)) return "";
    return fmt::format("scene {}: neither a name of the catalogue nor a file", name);
}

std::vector<std::string> default_scenes()
{
    std::vector<std::string> scenes;
    for (const char* name : {"bunny", "armadillo"})
        if (why_not_available(name).empty()) scenes.emplace_back(name);
    if (!scenes.empty()) return scenes;
    scenes.emplace_back("cubes");
    if (!find_builder().empty()) scenes.emplace_back("banana");
    return scenes;
}

} // namespace tetrace
