#include "scenes/builder/repair/clean.h"

#include "scenes/builder/triple_hash.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <unordered_map>
#include <unordered_set>

namespace tetrace {
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
