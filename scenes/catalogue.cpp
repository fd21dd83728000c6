#include "scenes/catalogue.h"

#include "core/base/error.h"
#include "core/base/printable.h"
#include "scenes/build_scene.h"
#include "scenes/mesh_files.h"
#include "scenes/procedural.h"

#include <charconv>
#include <fmt/format.h>
#include <string_view>

namespace tetrace {

namespace {

CatalogueEntry procedural_row(const std::string& name, const std::string& description, const ProceduralMesh& mesh)
{
    return {name, SceneSource::procedural, fmt::format("{}; {}@N has about N", description, name), "", {}, mesh};
}

} // namespace

const std::vector<CatalogueEntry>& catalogue()
{
    static const std::vector<CatalogueEntry> rows = {
        {"cubes",
         SceneSource::cubes,
         "jittered grid of cubes cut into tets round a blocky ball; needs no TetGen",
         "",
         {}},
        procedural_row("banana", "curved tube, closed, 25,000 triangles",
                       {500, 4'000'000, [] { return make_banana(); }, make_banana}),
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
        procedural_row("atrium", "court with arcades, walls, stair and statue, mostly open surfaces, 60,000 triangles",
                       {8'000, 4'000'000, [] { return make_atrium(60'000); }, make_atrium}),
        procedural_row("city", "houses with rooms and windows, and one detailed object, 80,000 triangles",
                       {4'000, 4'000'000, [] { return make_city(80'000); }, make_city}),
        procedural_row("terrain", "fractal height field, open, 180,000 triangles",
                       {500, 4'000'000, [] { return make_terrain(180'000); }, make_terrain}),
        procedural_row("spheres", "1,000 spheres of very different sizes, far apart, 128,000 triangles",
                       {8'000, 4'000'000, [] { return make_spheres(128'000); }, make_spheres}),
        procedural_row("grass", "22,500 thin blades on a floor, 68,012 triangles",
                       {2'000, 4'000'000, [] { return make_grass(68'012); }, make_grass}),
        {"lattice",
         SceneSource::lattice,
         fmt::format("grid of cubes of any size with solid ones scattered in it; lattice:N has N along an axis, {} "
                     "without N; needs no TetGen",
                     usual_lattice),
         "",
         {}},
    };
    return rows;
}

BuildOptions default_build(TetsKind tets)
{
    BuildOptions build;
    build.tets = tets;
    if (tets == TetsKind::rays) build.switches = "pY";
    return build;
}

namespace {

/// The number behind the head of a name; empty for a name without that head, and 0 for what is no number of 32 bits.
std::optional<std::uint32_t> number_behind(std::string_view head, const std::string& name)
{
    if (!name.starts_with(head)) return std::nullopt;
    std::uint32_t number = 0;
    const char *first = name.data() + head.size(), *last = name.data() + name.size();
    const auto [end, error] = std::from_chars(first, last, number);
    return error == std::errc() && end == last ? number : 0;
}

} // namespace

std::optional<ProceduralScene> find_procedural(const std::string& name)
{
    const CatalogueEntry* const entry = find_in_catalogue(name.substr(0, name.find('@')));
    if (entry == nullptr || !entry->procedural) return std::nullopt;
    const auto triangles = number_behind(entry->name + "@", name);
    if (triangles && (*triangles < entry->procedural->least || *triangles > entry->procedural->most))
        throw Error(ErrorKind::usage, fmt::format("scene {}: after the @ must be the number of its triangles, {} to {}",
                                                  name, entry->procedural->least, entry->procedural->most));
    return ProceduralScene{*entry, triangles};
}

std::optional<std::uint32_t> lattice_resolution(const std::string& name)
{
    if (name == "lattice") return usual_lattice;
    const auto resolution = number_behind("lattice:", name);
    if (resolution && (*resolution < least_lattice || *resolution > most_lattice))
        throw Error(ErrorKind::usage,
                    fmt::format("scene {}: behind the colon stands the number of its cubes along an axis, {} to {}",
                                name, least_lattice, most_lattice));
    return resolution;
}

bool is_made_in_place(const std::string& name)
{
    return name == "cubes" || lattice_resolution(name);
}

const CatalogueEntry* find_in_catalogue(const std::string& name)
{
    for (const CatalogueEntry& entry : catalogue())
        if (entry.name == name) return &entry;
    return nullptr;
}

std::string scene_label(const std::string& name)
{
    return find_in_catalogue(name) != nullptr ? name : printable_line(std::filesystem::path(name).stem().string());
}

std::string why_not_available(const std::string& name)
{
    const CatalogueEntry* entry = find_in_catalogue(name);
    if (entry != nullptr) return entry->source == SceneSource::file ? locate_mesh(*entry).reason : "";
    if (find_procedural(name) || lattice_resolution(name)) return "";
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
