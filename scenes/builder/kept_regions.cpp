#include "scenes/builder/kept_regions.h"

#include "core/base/exact.h"
#include "core/mesh/tet_mesh.h"

#include <algorithm>
#include <limits>

namespace tetrace {

namespace {

/// A region of 32 bits, or one of these.
using Label = std::int64_t;
constexpr Label unknown = std::numeric_limits<Label>::min(), fills_box = unknown + 1, mixed = unknown + 2;

void add_label(Label& label, Label seen)
{
    if (label == unknown)
        label = seen;
    else if (label != seen)
        label = mixed;
}

/// The parts of a tet mesh that occlusive faces are around, and what is at each side of each triangle.
class LabelledParts {
public:
    LabelledParts(const TriangleMesh& triangles, const TetMesh& tets) : triangles_(triangles), tets_(tets) {}

    /// Per side of each triangle, 2 triangle + side: the label of its tet.
    [[nodiscard]] std::vector<Label> sides(const std::vector<Label>& labels) const
    {
        std::vector<Label> sides(2 * triangles_.triangles.size(), unknown);
        for (std::uint32_t tet = 0; tet < tets_.tets.size(); ++tet)
            for (std::uint32_t face = 0; face < 4; ++face)
                if (tets_.tets[tet].faces[face] != FREE_FACE) add_label(sides[side_of(tet, face)], labels[tet]);
        return sides;
    }
    /// Per tet: the label that all sides of triangles around its part have.
    [[nodiscard]] std::vector<Label> labels(const std::vector<Label>& sides) const
    {
        std::vector<Label> labels(tets_.tets.size());
        std::vector<bool> is_done(labels.size());
        for (std::uint32_t first = 0; first < labels.size(); ++first) {
            if (is_done[first]) continue;
            is_done[first] = true;
            std::vector<std::uint32_t> part{first};
            Label label = unknown;
            for (std::size_t i = 0; i < part.size(); ++i)
                for (std::uint32_t face = 0; face < 4; ++face) {
                    const Tet& tet = tets_.tets[part[i]];
                    if (tet.faces[face] != FREE_FACE) {
                        add_label(label, sides[side_of(part[i], face)]);
                    } else if (tet.neighbours[face] != NO_HALF_FACE && !is_done[half_face_tet(tet.neighbours[face])]) {
                        part.push_back(half_face_tet(tet.neighbours[face]));
                        is_done[part.back()] = true;
                    }
                }
            for (const std::uint32_t tet : part)
                labels[tet] = label;
        }
        return labels;
    }

private:
    [[nodiscard]] std::size_t side_of(std::uint32_t tet, std::uint32_t face) const
    {
        const std::uint32_t triangle = tets_.tets[tet].faces[face];
        const auto& [a, b, c] = triangles_.triangles[triangle];
        const auto& v = triangles_.vertices;
        const bool is_above = orientation(v[a], v[b], v[c], tets_.vertices[tets_.tets[tet].vertices[face]]) > 0;
        return 2 * std::size_t{triangle} + (is_above ? 1 : 0);
    }

    const TriangleMesh& triangles_;
    const TetMesh& tets_;
};

/// Tets for which `is_first` holds come first; both kinds keep their order.
void put_first(TetMesh& mesh, const std::vector<bool>& is_first)
{
    std::vector<std::uint32_t> place(mesh.tets.size());
    std::uint32_t next = 0;
    for (const bool wanted : {true, false})
        for (std::size_t i = 0; i < place.size(); ++i)
            if (is_first[i] == wanted) place[i] = next++;
    std::vector<Tet> tets(mesh.tets.size());
    for (std::size_t i = 0; i < place.size(); ++i) {
        Tet tet = mesh.tets[i];
        for (std::uint32_t& half_face : tet.neighbours)
            if (half_face != NO_HALF_FACE)
                half_face = make_half_face(place[half_face_tet(half_face)], half_face_index(half_face));
        tets[place[i]] = tet;
    }
    mesh.tets = std::move(tets);
}

} // namespace

std::vector<SourceTet> keep_regions(const Scene& scene, TetMesh& optimised)
{
    std::vector<Label> before(scene.tets.tets.size(), fills_box);
    std::ranges::transform(scene.source_tets, before.begin(), &SourceTet::region);
    const std::vector<Label> sides = LabelledParts(scene.mesh, scene.tets).sides(before);
    const std::vector<Label> labels = LabelledParts(scene.mesh, optimised).labels(sides);
    std::vector<SourceTet> regions;
    std::vector<bool> is_own(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i] == unknown || labels[i] == mixed) return {};
        is_own[i] = labels[i] != fills_box;
        if (is_own[i]) regions.push_back({0, static_cast<std::int32_t>(labels[i])});
    }
    put_first(optimised, is_own);
    return regions;
}

} // namespace tetrace
