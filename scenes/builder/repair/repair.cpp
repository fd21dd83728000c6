#include "scenes/builder/repair/repair.h"

#include "scenes/builder/failure.h"
#include "scenes/builder/repair/arrangement.h"
#include "scenes/builder/repair/clean.h"

#include <fmt/format.h>

#include <set>

// Source of the method: exact arrangements of triangles, of which Zhou, Grinspun, Zorin, Jacobson, "Mesh Arrangements
// for Solid Geometry", 2016, is the best known. Nothing is removed from it here: what is inside stays.

namespace tetrace {
namespace {

// Replaces the triangles of these pairs by their pieces; returns the origins of what was cut.
std::set<std::uint32_t> cut_once(Scene& scene, const std::vector<TrianglePair>& pairs)
{
    std::set<std::uint32_t> cut;
    for (const auto& [first, second] : pairs)
        cut.insert({scene.origins[first], scene.origins[second]});
    CutMesh pieces = cut_along_intersections(scene.mesh, pairs);
    scene.mesh = std::move(pieces.mesh);
    for (std::uint32_t& parent : pieces.parents)
        parent = scene.origins[parent];
    scene.origins = std::move(pieces.parents);
    return cut;
}

[[noreturn]] void give_up(const Scene& scene, std::size_t pairs)
{
    throw BuilderFailure(
        BUILDER_SELF_INTERSECTION,
        fmt::format("repairing {}: after {} passes {} pairs of pieces cross, since rounding to float "
                    "moves them; faces that nearly overlap are the usual cause: remove one of them, or "
                    "merge nearly equal vertices, in another program",
                    scene.build.source, scene.build.repair.passes, pairs));
}

} // namespace

void repair(Scene& scene, const std::function<void(const std::string&)>& tell)
{
    RepairInfo& info = scene.build.repair;
    std::set<std::uint32_t> cut;
    for (;; ++info.passes) {
        const std::vector<TrianglePair> pairs = intersecting_pairs(scene.mesh);
        if (info.passes == 0) info.crossing_pairs = pairs.size();
        if (pairs.empty()) break;
        const bool grows = pairs.size() > max_pairs_of_pieces(info.crossing_pairs);
        if (info.passes == max_repair_passes || grows) give_up(scene, pairs.size());
        if (tell) tell(fmt::format("repairing, pass {}: {} pairs cross", info.passes + 1, pairs.size()));
        cut.merge(cut_once(scene, pairs));
        const CleanUp cleaned = clean_up(scene.mesh, scene.origins);
        info.dropped += cleaned.degenerate_triangles + cleaned.duplicate_triangles;
    }
    info.cut_triangles = cut.size();
    for (const std::uint32_t origin : scene.origins)
        info.pieces += cut.count(origin);
}

std::string repair_text(const RepairInfo& info)
{
    if (info.crossing_pairs == 0) return "no triangles cross: there was nothing to repair";
    return fmt::format("{} pairs of triangles crossed: {} triangles were cut into {} pieces in {} {}; {} others lay on "
                       "these or had no area after rounding, and were dropped",
                       info.crossing_pairs, info.cut_triangles, info.pieces, info.passes,
                       info.passes == 1 ? "pass" : "passes", info.dropped);
}

} // namespace tetrace
