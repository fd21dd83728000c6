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

// One way to repair a mesh, from its triangles as they are; the passes stop where it leads nowhere.
class Way {
public:
    Way(const Scene& scene, const std::function<void(const std::string&)>& tell) : result(scene), tell_(tell) {}
    virtual ~Way() = default;

    // Whether no pair crosses at the end. pairs: those that do at first.
    bool walk(std::vector<TrianglePair> pairs, bool at_least_once)
    {
        RepairInfo& info = result.build.repair;
        info.crossing_pairs = pairs.size();
        std::size_t triangles_at_first = 0; // after the first pass
        while (!pairs.empty() || (at_least_once && info.passes == 0)) {
            left = pairs.size();
            const bool grows = info.passes > 1 && result.mesh.triangles.size() > max_growth * triangles_at_first;
            if (info.passes == max_repair_passes || left > max_pairs_of_pieces(info.crossing_pairs) || grows)
                return false;
            ++info.passes;
            if (tell_) tell_(fmt::format("repairing{}, pass {}: {} pairs cross", manner(), info.passes, left));
            pass(pairs);
            const CleanUp cleaned = clean_up(result.mesh, result.origins);
            info.dropped += cleaned.degenerate_triangles + cleaned.duplicate_triangles;
            if (info.passes == 1) triangles_at_first = result.mesh.triangles.size();
            pairs = intersecting_pairs(result.mesh);
        }
        count_pieces();
        return true;
    }

    Scene result;
    std::size_t left = 0; // pairs that cross

protected:
    virtual void pass(const std::vector<TrianglePair>& pairs) = 0;
    [[nodiscard]] virtual std::string manner() const { return ""; }

private:
    void count_pieces()
    {
        std::map<std::uint32_t, std::uint64_t> pieces;
        for (const std::uint32_t origin : result.origins)
            ++pieces[origin];
        for (const auto& [origin, count] : pieces) {
            result.build.repair.cut_triangles += count > 1 ? 1 : 0;
            result.build.repair.pieces += count > 1 ? count : 0;
        }
    }

    const std::function<void(const std::string&)>& tell_;
};

class Exactly : public Way {
public:
    using Way::Way;

protected:
    void pass(const std::vector<TrianglePair>& pairs) override
    {
        CutMesh pieces = cut_along_intersections(result.mesh, pairs);
        result.mesh = std::move(pieces.mesh);
        for (std::uint32_t& parent : pieces.parents)
            parent = result.origins[parent];
        result.origins = std::move(pieces.parents);
    }
};

class Welding : public Way {
public:
    Welding(const Scene& scene, double tolerance, const std::function<void(const std::string&)>& tell)
        : Way(scene, tell)
    {
        result.build.repair.tolerance = tolerance;
    }

protected:
    void pass(const std::vector<TrianglePair>&) override
    {
        RepairInfo& info = result.build.repair;
        weld(result.mesh, result.origins, info.tolerance);
        info.moved += 1.5 * info.tolerance;
    }
    [[nodiscard]] std::string manner() const override
    {
        return fmt::format(" with a tolerance of {:.1e}", in_mesh_units(result.build.repair.tolerance, result.build));
    }
};

} // namespace

void repair(Scene& scene, double at_least, const std::function<void(const std::string&)>& tell)
{
    const std::vector<TrianglePair> pairs = intersecting_pairs(scene.mesh);
    std::size_t left = 0;
    const auto repaired = [&](Way&& way) {
        const bool good = way.walk(pairs, at_least > 0);
        left = way.left;
        if (good) scene = std::move(way.result);
        return good;
    };
    if (at_least == 0 && repaired(Exactly(scene, tell))) return;
    for (const double tolerance : weld_tolerances)
        if (tolerance >= at_least && repaired(Welding(scene, tolerance, tell))) return;
    throw BuilderFailure(
        BUILDER_SELF_INTERSECTION,
        fmt::format("repairing {}: {} pairs of triangles cross, and {} pairs of their pieces, after cutting them "
                    "exactly and with tolerances up to {:.1e}; remove faces that nearly overlap, or merge nearly equal "
                    "vertices, in another program",
                    scene.build.source, pairs.size(), left, in_mesh_units(weld_tolerances.back(), scene.build)));
}

std::string repair_text(const BuildInfo& build)
{
    const RepairInfo& info = build.repair;
    if (info.passes == 0) return "no triangles cross: there was nothing to repair";
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
