#include "scenes/builder/repair/repair.h"

#include "scenes/builder/failure.h"
#include "scenes/builder/repair/arrangement.h"
#include "scenes/builder/repair/weld.h"
#include "scenes/builder/triple_hash.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <unordered_set>

// Source of the method: exact arrangements of triangles, of which Zhou, Grinspun, Zorin, Jacobson, "Mesh Arrangements
// for Solid Geometry", 2016, is the best known. Nothing is removed from it here: what is inside stays.

namespace tetrace {

namespace {

double in_mesh_units(double length, const BuildInfo& build)
{
    return std::ldexp(length, -build.scale_exponent);
}

constexpr std::size_t max_growth = 4; // passes that more than cut what is new lead nowhere

// Whether passes lead away from an end: their cuts make slivers that cross again.
bool is_growing(std::size_t pairs, std::size_t pairs_at_first)
{
    return pairs > max_growth * pairs_at_first + 1000;
}

// A mesh on the way to be repaired.
struct Stage {
    Scene scene;
    std::vector<TrianglePair> pairs; // that cross
};

void cut(Stage& stage)
{
    Scene& scene = stage.scene;
    CutMesh pieces = cut_along_intersections(scene.mesh, stage.pairs);
    scene.mesh = std::move(pieces.mesh);
    for (std::uint32_t& parent : pieces.parents)
        parent = scene.origins[parent];
    scene.origins = std::move(pieces.parents);
}

void weld(Stage& stage, const std::vector<bool>& chosen)
{
    RepairInfo& info = stage.scene.build.repair;
    weld(stage.scene.mesh, stage.scene.origins, info.tolerance, chosen);
    info.moved += 1.5 * info.tolerance;
}

std::vector<bool> crossing_triangles(const Stage& stage)
{
    std::vector<bool> chosen(stage.scene.mesh.triangles.size());
    for (const auto& [a, b] : stage.pairs)
        chosen[a] = chosen[b] = true;
    return chosen;
}

void cut_and_weld_in_turn(Stage& stage)
{
    if (stage.scene.build.repair.passes % 2 == 1)
        cut(stage);
    else
        weld(stage, crossing_triangles(stage));
}

void weld_all(Stage& stage)
{
    weld(stage, std::vector<bool>(stage.scene.mesh.triangles.size(), true));
}

using Corners = std::array<std::array<float, 3>, 3>;

// A triangle as a set of points, which keeps when vertices are numbered anew.
Corners corners_of(const TriangleMesh& mesh, std::uint32_t triangle)
{
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const Float3 v = mesh.vertices[mesh.triangles[triangle][i]];
        corners[i] = {v.x, v.y, v.z};
    }
    std::ranges::sort(corners);
    return corners;
}

// The triangles that cross none.
std::vector<Corners> sound_triangles(const Stage& stage)
{
    const std::vector<bool> crossing = crossing_triangles(stage);
    std::vector<Corners> sound;
    for (std::uint32_t i = 0; i < crossing.size(); ++i)
        if (!crossing[i]) sound.push_back(corners_of(stage.scene.mesh, i));
    std::ranges::sort(sound);
    return sound;
}

// Two triangles that a pass left as they were, and that crossed none, cross none after it.
std::vector<TrianglePair> pairs_after_pass(const TriangleMesh& mesh, const std::vector<Corners>& sound)
{
    std::vector<bool> is_new(mesh.triangles.size());
    for (std::uint32_t i = 0; i < is_new.size(); ++i)
        is_new[i] = !std::ranges::binary_search(sound, corners_of(mesh, i));
    return intersecting_pairs(mesh, is_new);
}

// A pass, and what pairs cross after it.
void make_pass(Stage& stage, void (*change)(Stage&), const std::function<void(const std::string&)>& tell)
{
    RepairInfo& info = stage.scene.build.repair;
    ++info.passes;
    if (tell)
        tell(fmt::format("repairing{}, pass {}: {} pairs cross",
                         info.tolerance == 0 ? ""
                                             : fmt::format(" with a tolerance of {:.1e}",
                                                           in_mesh_units(info.tolerance, stage.scene.build)),
                         info.passes, stage.pairs.size()));
    const std::vector<Corners> sound = sound_triangles(stage);
    change(stage);
    const CleanUp cleaned = clean_up(stage.scene.mesh, stage.scene.origins);
    info.dropped += cleaned.degenerate_triangles + cleaned.duplicate_triangles;
    stage.pairs = pairs_after_pass(stage.scene.mesh, sound);
}

// Passes until no pair crosses, or until they lead nowhere. is_worth_it: whether one more is, after a pass at whose
// begin so many pairs crossed.
template <class IsWorthIt>
void make_passes(Stage& stage, void (*change)(Stage&), const std::function<void(const std::string&)>& tell,
                 const IsWorthIt& is_worth_it)
{
    const RepairInfo& info = stage.scene.build.repair;
    const std::size_t pairs_at_first = stage.pairs.size();
    std::size_t triangles_at_first = 0;
    while (!stage.pairs.empty() && info.passes < max_repair_passes) {
        const std::size_t before = stage.pairs.size();
        make_pass(stage, change, tell);
        if (triangles_at_first == 0) triangles_at_first = stage.scene.mesh.triangles.size();
        if (stage.scene.mesh.triangles.size() > max_growth * triangles_at_first ||
            stage.pairs.size() > max_pairs_of_pieces(info.crossing_pairs) ||
            is_growing(stage.pairs.size(), pairs_at_first) || !is_worth_it(before))
            return;
    }
}

void count_pieces(Scene& scene)
{
    std::map<std::uint32_t, std::uint64_t> pieces;
    for (const std::uint32_t origin : scene.origins)
        ++pieces[origin];
    for (const auto& [origin, count] : pieces) {
        scene.build.repair.cut_triangles += count > 1 ? 1 : 0;
        scene.build.repair.pieces += count > 1 ? count : 0;
    }
}

} // namespace

void repair(Scene& scene, double at_least, const std::function<void(const std::string&)>& tell)
{
    Stage start{scene, intersecting_pairs(scene.mesh)};
    start.scene.build.repair.crossing_pairs = start.pairs.size();
    if (start.pairs.empty() && at_least == 0) return;
    Stage stage = start;
    const auto is_repaired = [&] {
        if (!stage.pairs.empty()) return false;
        scene = std::move(stage.scene);
        count_pieces(scene);
        return true;
    };
    const auto always = [](std::size_t) { return true; };
    if (at_least == 0) {
        make_pass(stage, cut, tell);
        const Stage cut_once = stage;
        const bool is_shattered = is_growing(stage.pairs.size(), start.pairs.size());
        if (!is_shattered)
            make_passes(stage, cut, tell, [&](std::size_t before) { return 2 * stage.pairs.size() < before; });
        if (is_repaired()) return;
        for (const double tolerance : local_tolerances) {
            if (is_shattered) break; // what is left of these cuts only makes more
            stage = cut_once;
            stage.scene.build.repair.tolerance = tolerance;
            make_passes(stage, cut_and_weld_in_turn, tell, always);
            if (is_repaired()) return;
        }
    }
    for (const double tolerance : weld_tolerances) {
        if (tolerance < at_least) continue;
        stage = start;
        stage.scene.build.repair.tolerance = tolerance;
        make_pass(stage, weld_all, tell);
        const Stage welded_once = stage;
        for (const auto change : {cut_and_weld_in_turn, weld_all}) { // the first takes less time
            stage = welded_once;
            make_passes(stage, change, tell, always);
            if (is_repaired()) return;
        }
    }
    throw BuilderFailure(
        BUILDER_SELF_INTERSECTION,
        fmt::format("repairing {}: {} pairs of triangles cross, and {} pairs of their pieces, after cutting them "
                    "exactly and with tolerances up to {:.1e}; remove faces that nearly overlap, or merge nearly equal "
                    "vertices, in another program",
                    scene.build.source, start.pairs.size(), stage.pairs.size(),
                    in_mesh_units(weld_tolerances.back(), scene.build)));
}

std::string repair_text(const BuildInfo& build)
{
    const RepairInfo& info = build.repair;
    const std::string done =
        fmt::format("{} pairs of triangles crossed: {} triangles were cut into {} pieces in {} {}; {} others lay on "
                    "these or had no area after rounding, and were dropped",
                    info.crossing_pairs, info.cut_triangles, info.pieces, info.passes,
                    info.passes == 1 ? "pass" : "passes", info.dropped);
    if (info.tolerance == 0) return done;
    return fmt::format("{}; what was nearer than {:.1e} was merged, and nothing moved by more than {:.1e}", done,
                       in_mesh_units(info.tolerance, build), in_mesh_units(info.moved, build));
}

namespace {

using Triple = std::array<std::uint32_t, 3>;

Triple bits_of(Float3 v)
{
    return {std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y), std::bit_cast<std::uint32_t>(v.z)};
}

std::uint64_t merge_vertices(TriangleMesh& mesh)
{
    std::unordered_map<Triple, std::uint32_t, TripleHash> first;
    std::vector<std::uint32_t> merged(mesh.vertices.size());
    first.reserve(mesh.vertices.size());
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
        Float3& v = mesh.vertices[i];
        v = {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f}; // -0 becomes 0
        merged[i] = first.try_emplace(bits_of(v), i).first->second;
    }
    for (Triple& triangle : mesh.triangles)
        for (std::uint32_t& vertex : triangle)
            vertex = merged[vertex];
    return mesh.vertices.size() - first.size();
}

bool is_degenerate(const TriangleMesh& mesh, const Triple& triangle)
{
    const auto [a, b, c] = triangle;
    if (a == b || b == c || c == a) return true;
    using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
    const auto point = [&](std::uint32_t i) {
        const Double3 v = to_double(mesh.vertices[i]);
        return Point(v.x, v.y, v.z);
    };
    return CGAL::collinear(point(a), point(b), point(c));
}

// Returns how many went.
template <class Unwanted>
std::uint64_t remove_triangles(TriangleMesh& mesh, std::vector<std::uint32_t>& origins, const Unwanted& is_unwanted)
{
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (is_unwanted(mesh.triangles[i])) continue;
        mesh.triangles[kept] = mesh.triangles[i];
        origins[kept++] = origins[i];
    }
    const std::uint64_t removed = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    origins.resize(kept);
    return removed;
}

std::uint64_t remove_degenerate(TriangleMesh& mesh, std::vector<std::uint32_t>& origins)
{
    return remove_triangles(mesh, origins, [&](const Triple& triangle) { return is_degenerate(mesh, triangle); });
}

std::uint64_t remove_duplicates(TriangleMesh& mesh, std::vector<std::uint32_t>& origins)
{
    std::unordered_set<Triple, TripleHash> seen;
    seen.reserve(mesh.triangles.size());
    return remove_triangles(mesh, origins, [&](Triple triangle) {
        std::sort(triangle.begin(), triangle.end());
        return !seen.insert(triangle).second;
    });
}

// Returns how many vertices went, those that were merged away included.
std::uint64_t remove_unused(TriangleMesh& mesh)
{
    constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> place(mesh.vertices.size(), unused);
    for (const Triple& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            place[vertex] = 0;
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (place[i] == unused) continue;
        mesh.vertices[kept] = mesh.vertices[i];
        place[i] = kept++;
    }
    const std::uint64_t removed = mesh.vertices.size() - kept;
    mesh.vertices.resize(kept);
    for (Triple& triangle : mesh.triangles)
        for (std::uint32_t& vertex : triangle)
            vertex = place[vertex];
    return removed;
}

} // namespace

CleanUp clean_up(TriangleMesh& mesh, std::vector<std::uint32_t>& origins)
{
    CleanUp result;
    result.merged_vertices = merge_vertices(mesh);
    result.degenerate_triangles = remove_degenerate(mesh, origins);
    result.duplicate_triangles = remove_duplicates(mesh, origins);
    result.unused_vertices = remove_unused(mesh) - result.merged_vertices;
    return result;
}

CleanUp clean_up(TriangleMesh& mesh)
{
    std::vector<std::uint32_t> origins(mesh.triangles.size());
    return clean_up(mesh, origins);
}

} // namespace tetrace
