#include "scenes/catalogue.h"

#include "core/base/error.h"
#include "core/base/printable.h"
#include "scenes/build_scene.h"
#include "scenes/mesh_files.h"
#include "scenes/pinned.h"
#include "scenes/procedural.h"

#include <charconv>
#include <fmt/format.h>
#include <string_view>

namespace tetrace {

namespace {

CatalogueEntry procedural_row(const std::string& name, const std::string& description, const ProceduralMesh& mesh,
                              std::vector<Aim> views = {})
{
    return {name, SceneSource::procedural, fmt::format("{}; {}@N has about N", description, name), "", {},
            mesh, std::move(views)};
}

} // namespace

const std::vector<CatalogueEntry>& catalogue()
{
    static const std::vector<CatalogueEntry> rows = {
        {"cubes",
         SceneSource::cubes,
         "jittered grid of cubes cut into tets around a blocky ball; does not need TetGen",
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
                       {8'000, 4'000'000, [] { return make_atrium(60'000); }, make_atrium},
                       {{{0.5007, -0.1558, -0.0445}, {-0.2893, -0.1558, 0.0223}},
                        {{-0.5786, -0.1892, 0.3227}, {0.6677, -0.089, -0.4228}},
                        {{0.5898, 0.1335, -0.1113}, {-0.5119, -0.178, 0.089}},
                        {{-0.4451, -0.2114, -0.0445}, {-0.2226, -0.1669, 0.1001}}}),
        procedural_row("city", "houses with rooms and windows, and one detailed object, 80,000 triangles",
                       {4'000, 4'000'000, [] { return make_city(80'000); }, make_city},
                       {{{-0.0942, -0.1394, -0.6705}, {-0.0866, -0.0866, 0.6969}},
                        {{0.1055, 0, -0.4709}, {-0.1695, -0.1582, 0.4332}},
                        {{0.0339, -0.1488, -0.0151}, {0, -0.1537, 0}},
                        {{-0.1488, -0.1092, -0.0019}, {0, -0.1544, 0}}}),
        procedural_row("terrain", "fractal height field, open, 180,000 triangles",
                       {500, 4'000'000, [] { return make_terrain(180'000); }, make_terrain},
                       {{{-0.6158, 0.0544, -0.6158}, {0.5278, -0.0687, 0.2639}},
                        {{0.6158, 0.0808, 0.5278}, {-0.3519, -0.0951, -0.1759}},
                        {{0, 0.3623, -0.4398}, {0.044, -0.1215, 0.088}},
                        {{-0.3519, 0.0632, 0.6158}, {0, -0.0599, -0.3519}}}),
        procedural_row("spheres", "1,000 spheres of very different sizes, far apart, 128,000 triangles",
                       {8'000, 4'000'000, [] { return make_spheres(128'000); }, make_spheres},
                       {{{0.0291, 0.0289, 0.0292}, {0.5781, 0.1156, 0.1737}},
                        {{-0.5199, 0.1734, 0.5493}, {0.1736, -0.1156, -0.1731}},
                        {{0.2313, -0.3467, -0.2308}, {-0.1732, 0.2312, 0.1737}},
                        {{0.5665, 0.549, 0.0003}, {0.0002, 0, 0.0003}}}),
        procedural_row("grass", "22,500 thin blades on a floor, 68,012 triangles",
                       {2'000, 4'000'000, [] { return make_grass(68'012); }, make_grass},
                       {{{-0.4416, -0.0067, -0.3533}, {0.3533, -0.0111, 0.1767}},
                        {{0, 0.086, 0.53}, {-0.0265, -0.0376, 0.3356}},
                        {{0.1767, 0.0065, -0.4416}, {-0.53, -0.02, 0.3533}},
                        {{0.3533, 0.1567, 0.3533}, {0.212, -0.0376, 0.212}}}),
        procedural_row("plant",
                       "120 thin leaves that cross each other, cut where they do; 41,000 triangles before that",
                       {4'000, 4'000'000, [] { return make_plant(40'000); }, make_plant}),
        procedural_row("nested", "three spheres with one centre in a cube, closed, 30,000 triangles",
                       {2'000, 4'000'000, [] { return make_nested(30'000); }, make_nested}),
        {"field",
         SceneSource::points,
         "Delaunay tets of random points with blobs of density, a radiance field's stand-in, 50,000 points; field@N "
         "has N",
         "",
         {},
         ProceduralMesh{100, 4'000'000, nullptr, nullptr, make_field, 50'000}},
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

bool is_usual_build(const BuildOptions& build)
{
    const BuildOptions usual = default_build(TetsKind::rays);
    return build.tets == usual.tets && build.domain == usual.domain && build.divisions == usual.divisions &&
           build.switches == usual.switches && build.repair == usual.repair && build.effort == usual.effort &&
           build.optimise_s == usual.optimise_s;
}

namespace {

/// The number after the head of a name; empty for a name without that head, and 0 for what is not a number of 32 bits.
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
        throw Error(ErrorKind::usage, fmt::format("scene {}: after the @ must be the number of its {}, {} to {}", name,
                                                  entry->procedural->make_points == nullptr ? "triangles" : "points",
                                                  entry->procedural->least, entry->procedural->most));
    return ProceduralScene{*entry, triangles};
}

std::optional<std::uint32_t> lattice_resolution(const std::string& name)
{
    if (name == "lattice") return usual_lattice;
    const auto resolution = number_behind("lattice:", name);
    if (resolution && (*resolution < min_lattice || *resolution > max_lattice))
        throw Error(ErrorKind::usage,
                    fmt::format("scene {}: after the colon comes the number of its cubes along an axis, {} to {}", name,
                                min_lattice, max_lattice));
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
    if (const PinnedScene* const pinned = find_pinned(name)) return std::string(pinned->of);
    return find_in_catalogue(name) != nullptr ? name : printable_line(std::filesystem::path(name).stem().string());
}

std::string why_not_available(const std::string& name)
{
    const PinnedScene* const pinned = find_pinned(name);
    const CatalogueEntry* entry = find_in_catalogue(pinned != nullptr ? std::string(pinned->of) : name);
    if (entry != nullptr) return entry->source == SceneSource::file ? locate_mesh(*entry).reason : "";
    if (find_procedural(name) || lattice_resolution(name)) return "";
    std::error_code ignored; // what cannot be looked at is not there for us
    if (std::filesystem::is_regular_file(name, ignored) || is_stream(name)) return "";
    return fmt::format("scene {}: neither a name of the catalogue nor a file", name);
}

std::vector<std::string> default_scenes()
{
    const bool can_build = !find_builder().empty();
    std::vector<std::string> scenes;
    for (const char* name : {"bunny", "armadillo"})
        if (why_not_available(name).empty()) scenes.emplace_back(name);
    if (scenes.empty()) {
        scenes.emplace_back("cubes");
        if (can_build) scenes.emplace_back("banana");
    }
    if (can_build) scenes.emplace_back("atrium");
    return scenes;
}

std::vector<std::string> all_scenes()
{
    std::vector<std::string> scenes;
    for (const CatalogueEntry& entry : catalogue())
        if (entry.source != SceneSource::lattice && entry.source != SceneSource::points &&
            why_not_available(entry.name).empty())
            scenes.push_back(entry.name);
    return scenes;
}

} // namespace tetrace
