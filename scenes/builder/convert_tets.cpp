#include "scenes/builder/convert_tets.h"

#include "core/base/exact.h"
#include "scenes/builder/failure.h"
#include "scenes/builder/triple_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tetrace {

namespace {

constexpr double on_side = 1e-9; // Steiner points on a side are this near to its plane, and no others
constexpr std::uint32_t surface_steps =
    2; // a Steiner point on an input triangle stays where rounding could have put it
constexpr std::uint32_t interior_steps = 1 << 12; // one that only free faces share may go further

[[noreturn]] void absurd(const RawTets& output, const std::string& what)
{
    throw BuilderFailure(BUILDER_ABSURD_OUTPUT, fmt::format("checking {}'s output: {}; {}, or repair the mesh",
                                                            output.maker, what, try_other_switches));
}

using Triple = std::array<std::int32_t, 3>;

Triple sorted(Triple corners)
{
    std::sort(corners.begin(), corners.end());
    return corners;
}

Triple face_of(const std::array<std::int32_t, 4>& tet, std::size_t face)
{
    Triple corners{};
    for (std::size_t i = 0, n = 0; i < 4; ++i)
        if (i != face) corners[n++] = tet[i];
    return sorted(corners);
}

void require_indices(const RawTets& output)
{
    const auto points = static_cast<std::int32_t>(output.points.size());
    const auto tets = static_cast<std::int32_t>(output.tets.size());
    if (output.tets.empty()) absurd(output, "it is without tets");
    if (output.tets.size() > MAX_TETS)
        absurd(output, fmt::format("{} tets are more than a link of 30 bits can name", tets));
    for (const auto& face : output.surface_faces)
        for (const std::int32_t corner : face.corners)
            if (corner < 0 || corner >= points)
                absurd(output, fmt::format("a face of triangle {} names a vertex that is not there", face.triangle));
    for (std::size_t i = 0; i < output.tets.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k)
            if (output.tets[i][k] < 0 || output.tets[i][k] >= points || output.neighbours[i][k] < -1 ||
                output.neighbours[i][k] >= tets)
                absurd(output, fmt::format("tet {} names a vertex or a neighbour that is not there", i));
}

std::uint32_t half_face_across(const RawTets& output, std::size_t tet, std::size_t face)
{
    const std::int32_t neighbour = output.neighbours[tet][face];
    if (neighbour < 0) return NO_HALF_FACE;
    const auto other = static_cast<std::size_t>(neighbour);
    for (std::uint32_t i = 0; i < 4; ++i)
        if (output.neighbours[other][i] == static_cast<std::int32_t>(tet) &&
            face_of(output.tets[other], i) == face_of(output.tets[tet], face))
            return make_half_face(static_cast<std::uint32_t>(neighbour), i);
    absurd(output,
           fmt::format("asymmetric neighbours: tet {} has neighbour {} over face {}, which does not name it back", tet,
                       neighbour, face));
}

std::vector<Tet> connect(const RawTets& output)
{
    std::vector<Tet> tets(output.tets.size());
    for (std::size_t i = 0; i < tets.size(); ++i) {
        tets[i].faces.fill(FREE_FACE);
        for (std::size_t k = 0; k < 4; ++k) {
            tets[i].vertices[k] = static_cast<std::uint32_t>(output.tets[i][k]);
            tets[i].neighbours[k] = half_face_across(output, i, k);
        }
    }
    return tets;
}

std::vector<bool> surface_points(const RawTets& output)
{
    std::vector<bool> found(output.points.size(), false);
    for (const auto& face : output.surface_faces)
        if (face.triangle >= 0)
            for (const std::int32_t corner : face.corners)
                found[static_cast<std::size_t>(corner)] = true;
    return found;
}

void mark_faces(const RawTets& output, std::vector<Tet>& tets)
{
    std::unordered_map<Triple, std::int32_t, TripleHash> triangles;
    triangles.reserve(output.surface_faces.size());
    for (const auto& face : output.surface_faces)
        if (face.triangle >= 0) triangles.emplace(sorted(face.corners), face.triangle);
    const std::vector<bool> on_surface = surface_points(output);
    std::uint64_t sides = 0;
    const auto look_up = [&](std::uint32_t tet, std::uint32_t face) {
        const std::uint32_t half_face = tets[tet].neighbours[face];
        if (half_face != NO_HALF_FACE && half_face < make_half_face(tet, face)) return; // looked up from its other side
        const Triple corners = face_of(output.tets[tet], face);
        for (const std::int32_t corner : corners)
            if (!on_surface[static_cast<std::size_t>(corner)]) return;
        const auto found = triangles.find(corners);
        if (found == triangles.end()) return;
        const auto triangle = static_cast<std::uint32_t>(found->second);
        tets[tet].faces[face] = triangle;
        ++sides;
        if (half_face == NO_HALF_FACE) return;
        tets[half_face_tet(half_face)].faces[half_face_index(half_face)] = triangle;
        ++sides;
    };
    for (std::uint32_t tet = 0; tet < tets.size(); ++tet)
        for (std::uint32_t face = 0; face < 4; ++face)
            look_up(tet, face);
    if (sides != 2 * triangles.size())
        absurd(output, fmt::format("{} faces lie on input triangles, but tets have {} sides of them instead of {}",
                                   triangles.size(), sides, 2 * triangles.size()));
}

double area(const RawTets& output, const Triple& corners)
{
    const auto point = [&](std::size_t i) { return output.points[static_cast<std::size_t>(corners[i])]; };
    return length(cross(point(1) - point(0), point(2) - point(0))) / 2;
}

// In double coordinates, in which a needle's area is not yet blurred by rounding.
void require_coverage(const RawTets& output, const TriangleMesh& triangles)
{
    std::vector<double> covered(triangles.triangles.size(), 0.0);
    for (const auto& face : output.surface_faces)
        if (face.triangle >= 0) covered[static_cast<std::size_t>(face.triangle)] += area(output, face.corners);
    std::uint64_t count = 0;
    std::size_t first = 0;
    for (std::size_t i = covered.size(); i-- > 0;) {
        const auto& [a, b, c] = triangles.triangles[i];
        const double wanted =
            area(output, {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)});
        if (covered[i] > 0 && std::abs(covered[i] - wanted) <= 1e-6 * wanted + 1e-15) continue;
        ++count;
        first = i;
    }
    if (count > 0)
        absurd(
            output,
            fmt::format("missing input triangles: the faces on {} triangles do not add up to their areas (first: {})",
                        count, first));
}

// Raw tets are all of one orientation; core wants det < 0.
void orient(std::vector<Tet>& tets)
{
    const auto moved = [](std::uint32_t half_face) {
        if (half_face == NO_HALF_FACE || half_face_index(half_face) > 1) return half_face;
        return make_half_face(half_face_tet(half_face), 1 - half_face_index(half_face));
    };
    for (Tet& tet : tets) {
        std::swap(tet.vertices[0], tet.vertices[1]);
        std::swap(tet.neighbours[0], tet.neighbours[1]);
        std::swap(tet.faces[0], tet.faces[1]);
        for (std::uint32_t& half_face : tet.neighbours)
            half_face = moved(half_face);
    }
}

// Rounded points, and how far each may move.
class Points {
public:
    Points(const RawTets& output, const Domain& domain, const std::vector<Tet>& tets) : freedom(output.points.size())
    {
        for (const Double3 point : output.points)
            rounded.push_back(snap_to_grid(to_float(point)));
        for (std::size_t i = output.input_points; i < rounded.size(); ++i)
            freedom[i] = {{true, true, true}, interior_steps};
        for (const Tet& tet : tets)
            for (std::size_t face = 0; face < 4; ++face)
                for (std::size_t corner = 0; corner < 4; ++corner)
                    if (corner != face) restrict_vertex(domain, tet, face, tet.vertices[corner]);
    }

    std::vector<Float3> rounded;
    std::vector<Freedom> freedom;

private:
    void restrict_vertex(const Domain& domain, const Tet& tet, std::size_t face, std::uint32_t vertex)
    {
        if (freedom[vertex].steps == 0) return;
        if (tet.faces[face] != FREE_FACE) freedom[vertex].steps = surface_steps;
        if (tet.neighbours[face] != NO_HALF_FACE) return;
        for (int axis = 0; axis < 3; ++axis)
            for (const float plane : {domain.low()[axis], domain.high()[axis]})
                hold_on_side(vertex, axis, plane);
    }
    void hold_on_side(std::uint32_t vertex, int axis, float plane)
    {
        float& coordinate = rounded[vertex][axis];
        if (std::abs(static_cast<double>(coordinate) - static_cast<double>(plane)) > on_side) return;
        coordinate = plane;
        freedom[vertex].axes[static_cast<std::size_t>(axis)] = false;
    }
};

// Drops points that no tet has (TetGen's J keeps them), in order.
void drop_unused(TetMesh& mesh)
{
    std::vector<std::uint32_t> place(mesh.vertices.size(), 0);
    for (const Tet& tet : mesh.tets)
        for (const std::uint32_t vertex : tet.vertices)
            place[vertex] = 1;
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (place[i] == 0) continue;
        mesh.vertices[kept] = mesh.vertices[i];
        place[i] = kept++;
    }
    mesh.vertices.resize(kept);
    for (Tet& tet : mesh.tets)
        for (std::uint32_t& vertex : tet.vertices)
            vertex = place[vertex];
}

} // namespace

TetMesh convert_tets(const RawTets& output, const TriangleMesh& triangles, const Domain& domain, Rounding& rounding)
{
    require_indices(output);
    require_coverage(output, triangles);
    TetMesh mesh;
    mesh.tets = connect(output);
    mark_faces(output, mesh.tets);
    Points points(output, domain, mesh.tets);
    orient(mesh.tets);
    mesh.vertices = std::move(points.rounded);
    rounding = mend_tets(mesh, points.freedom);
    drop_unused(mesh);
    return mesh;
}

} // namespace tetrace
