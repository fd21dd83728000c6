#include "scenes/builder/repair/repair.h"

#include "scenes/builder/failure.h"
#include "scenes/builder/repair/arrangement.h"
#include "scenes/builder/triple_hash.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <set>
#include <unordered_map>
#include <unordered_set>

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
