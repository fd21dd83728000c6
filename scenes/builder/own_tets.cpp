#include "scenes/builder/own_tets.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "scenes/builder/failure.h"
#include "scenes/builder/repair/self_intersection.h"
#include "scenes/builder/triple_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <span>
#include <unordered_map>

namespace tetrace {

namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr const char* overlap_remedy =
    "mesh the parts so that tets meet only in whole faces, edges and vertices: no tet may overlap another";

/// Seen from outside a positive tet, counter-clockwise.
Corners face_of_own(const TetCorners& tet, std::uint32_t face)
{
    const auto& [a, b, c] = face_corners[face];
    return {tet[a], tet[b], tet[c]};
}

/// A face by its sorted corners. Two tets that name it alike are on its two sides if they are odd and even.
struct SortedFace {
    Corners corners;
    bool is_odd;
    std::uint32_t half_face;
};

SortedFace sorted_face_of(const TetCorners& tet, std::uint32_t face, std::uint32_t half_face)
{
    auto [a, b, c] = face_of_own(tet, face);
    bool is_odd = false;
    const auto order = [&](std::uint32_t& low, std::uint32_t& high) {
        if (low <= high) return;
        std::swap(low, high);
        is_odd = !is_odd;
    };
    order(a, b);
    order(b, c);
    order(a, b);
    return {{a, b, c}, is_odd, half_face};
}

/// Of the half-faces of tets their others, or NO_HALF_FACE on the hull.
std::vector<std::uint32_t> others_of(const std::vector<TetCorners>& tets, const std::vector<SourceTet>& numbers)
{
    std::vector<SortedFace> faces;
    faces.reserve(4 * tets.size());
    for (std::uint32_t tet = 0; tet < tets.size(); ++tet)
        for (std::uint32_t face = 0; face < 4; ++face)
            faces.push_back(sorted_face_of(tets[tet], face, make_half_face(tet, face)));
    std::ranges::sort(faces, [](const SortedFace& a, const SortedFace& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.half_face < b.half_face;
    });
    const auto number = [&](const SortedFace& face) { return numbers[half_face_tet(face.half_face)].number; };
    std::vector<std::uint32_t> others(faces.size(), NO_HALF_FACE);
    for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
        const SortedFace &a = faces[i], &b = faces[i + 1];
        if (a.corners != b.corners) continue;
        if (i + 2 < faces.size() && faces[i + 2].corners == a.corners)
            throw Error(ErrorKind::invalid_input, fmt::format("tets {}, {} and {} share one face, and a face has two",
                                                              number(a), number(b), number(faces[i + 2])));
        if (a.is_odd == b.is_odd)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("tets {} and {} are on the same side of their face, so they overlap", number(a),
                                    number(b)));
        others[a.half_face] = b.half_face;
        others[b.half_face] = a.half_face;
    }
    return others;
}

} // namespace

void keep_corners(std::vector<Float3>& vertices, std::vector<TetCorners>& tets)
{
    constexpr std::uint32_t unknown = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> places(vertices.size(), unknown);
    std::unordered_map<Corners, std::uint32_t, TripleHash> first;
    std::vector<Float3> kept;
    for (TetCorners& tet : tets) {
        for (std::uint32_t& vertex : tet) {
            std::uint32_t& place = places[vertex];
            if (place == unknown) {
                const Float3 v = vertices[vertex];
                const Corners bits{std::bit_cast<std::uint32_t>(v.x + 0.0f), std::bit_cast<std::uint32_t>(v.y + 0.0f),
                                   std::bit_cast<std::uint32_t>(v.z + 0.0f)};
                const auto [at, is_new] = first.try_emplace(bits, static_cast<std::uint32_t>(kept.size()));
                if (is_new) kept.push_back(v);
                place = at->second;
            }
            vertex = place;
        }
    }
    vertices = std::move(kept);
}

std::vector<TetSurface> surface_of(const std::vector<TetCorners>& tets, const std::vector<SourceTet>& numbers)
{
    std::vector<TetSurface> surface;
    const std::vector<std::uint32_t> others = others_of(tets, numbers);
    for (std::uint32_t half_face = 0; half_face < others.size(); ++half_face) {
        const std::uint32_t other = others[half_face], tet = half_face_tet(half_face);
        const bool is_hull = other == NO_HALF_FACE;
        if (is_hull || (other > half_face && numbers[half_face_tet(other)].region != numbers[tet].region))
            surface.push_back({face_of_own(tets[tet], half_face_index(half_face)), half_face, is_hull});
    }
    return surface;
}

namespace {

void require_volumes(const Scene& scene, const OwnTets& own)
{
    std::uint64_t count = 0;
    std::size_t first = 0;
    for (std::size_t i = own.tets.size(); i-- > 0;) {
        const auto& [a, b, c, d] = own.tets[i];
        const auto& v = scene.mesh.vertices;
        if (orientation(v[a], v[b], v[c], v[d]) > 0) continue;
        ++count;
        first = i;
    }
    if (count == 0) return;
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("checking {}: tet {} is flat or inverted once its vertices are rounded to float, and so are "
                    "{} others; remove flat tets from the mesh, for example with Gmsh's or TetGen's optimiser",
                    scene.build.source, own.numbers[first].number, count - 1));
}

void require_no_crossing(const Scene& scene, const OwnTets& own, const std::vector<TetSurface>& surface)
{
    const SelfIntersections found = find_self_intersections(scene.mesh, 1);
    if (found.count == 0) return;
    const auto number = [&](std::uint32_t triangle) {
        return own.numbers[half_face_tet(surface[triangle].half_face)].number;
    };
    const auto [a, b] = found.first.front();
    throw Error(ErrorKind::invalid_input,
                fmt::format("checking {}: the surfaces of its tets cross or touch at {} pairs of faces, the first of "
                            "tets {} and {}; {}",
                            scene.build.source, found.count, number(a), number(b), overlap_remedy));
}

} // namespace

OwnTets check_own_tets(const Scene& scene, std::vector<TetCorners> tets, std::vector<SourceTet> numbers)
{
    OwnTets own{std::move(tets), std::move(numbers), {}, {}};
    require_volumes(scene, own);
    const std::vector<TetSurface> surface = surface_of(own.tets, own.numbers);
    require_no_crossing(scene, own, surface);
    std::unordered_map<std::uint32_t, std::uint32_t> places;
    for (const TetSurface& face : surface) {
        if (!face.is_hull) continue;
        Corners& corners = own.hull.triangles.emplace_back(face.corners);
        for (std::uint32_t& vertex : corners) {
            const auto [at, is_new] = places.try_emplace(vertex, static_cast<std::uint32_t>(own.hull_vertices.size()));
            if (is_new) own.hull_vertices.push_back(vertex);
            if (is_new) own.hull.vertices.push_back(scene.mesh.vertices[vertex]);
            vertex = at->second;
        }
    }
    return own;
}

namespace {

[[noreturn]] void fail_to_fill(const RawTets& filled, const std::string& what)
{
    throw BuilderFailure(BUILDER_ABSURD_OUTPUT,
                         fmt::format("checking {}'s output: {}; {}", filled.maker, what, try_other_switches));
}

/// Joins a file's tets and those around them.
class OwnTetsJoiner {
public:
    OwnTetsJoiner(const OwnTets& own, const Scene& scene, const RawTets& filled)
        : own_(own), scene_(scene), filled_(filled), others_(others_of(own.tets, own.numbers)),
          seeds_(filled.tets.size(), NO_HALF_FACE), is_inside_(filled.tets.size())
    {
    }

    [[nodiscard]] RawTets join()
    {
        read_tets();
        find_hull();
        spread();
        put_tets();
        put_faces();
        return std::move(joined_);
    }

private:
    using Tet = std::array<std::int32_t, 4>;

    [[nodiscard]] std::int32_t place_of(std::int32_t point) const
    {
        const auto hull = static_cast<std::int32_t>(own_.hull_vertices.size());
        return point < hull ? static_cast<std::int32_t>(own_.hull_vertices[static_cast<std::size_t>(point)])
                            : point - hull + static_cast<std::int32_t>(scene_.mesh.vertices.size());
    }
    /// Those of `filled`, with the joined mesh's points.
    void read_tets()
    {
        for (const Tet& tet : filled_.tets) {
            TetCorners& corners = corners_.emplace_back();
            for (std::size_t i = 0; i < 4; ++i)
                corners[i] = static_cast<std::uint32_t>(place_of(tet[i]));
        }
    }
    /// The two tets of `filled` at each face of the hull: one is inside.
    void find_hull()
    {
        std::unordered_map<Corners, SortedFace, TripleHash> hull;
        for (std::uint32_t half_face = 0; half_face < others_.size(); ++half_face)
            if (others_[half_face] == NO_HALF_FACE) {
                const auto face =
                    sorted_face_of(own_.tets[half_face_tet(half_face)], half_face_index(half_face), half_face);
                hull.emplace(face.corners, face);
            }
        hull_of_.assign(4 * corners_.size(), NO_HALF_FACE);
        std::size_t inside = 0, outside = 0;
        for (std::uint32_t tet = 0; tet < corners_.size(); ++tet)
            for (std::uint32_t face = 0; face < 4; ++face) {
                const SortedFace here = sorted_face_of(corners_[tet], face, make_half_face(tet, face));
                if (here.corners[2] >= scene_.mesh.vertices.size()) continue;
                const auto found = hull.find(here.corners);
                if (found == hull.end()) continue;
                const bool is_inside = found->second.is_odd == here.is_odd;
                hull_of_[here.half_face] = found->second.half_face;
                mark(tet, is_inside, found->second.half_face);
                (is_inside ? inside : outside)++;
            }
        if (inside != hull.size() || outside != hull.size())
            fail_to_fill(filled_, fmt::format("{} of the {} faces of the mesh's hull are not in it, or not whole",
                                              hull.size() - std::min(inside, outside), hull.size()));
    }
    void mark(std::uint32_t tet, bool is_inside, std::uint32_t seed)
    {
        if (seeds_[tet] == NO_HALF_FACE) {
            seeds_[tet] = seed;
            is_inside_[tet] = is_inside;
            pending_.push_back(tet);
        } else if (is_inside_[tet] != is_inside)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("checking {}: tets {} and {} are of parts that overlap; {}", scene_.build.source,
                                    number_of(seed), number_of(seeds_[tet]), overlap_remedy));
    }
    [[nodiscard]] std::uint32_t number_of(std::uint32_t half_face) const
    {
        return own_.numbers[half_face_tet(half_face)].number;
    }
    /// To all tets that no face of the hull separates.
    void spread()
    {
        while (!pending_.empty()) {
            const std::uint32_t tet = pending_.back();
            pending_.pop_back();
            for (std::uint32_t face = 0; face < 4; ++face) {
                const std::int32_t next = filled_.neighbours[tet][face];
                if (next >= 0 && hull_of_[make_half_face(tet, face)] == NO_HALF_FACE)
                    mark(static_cast<std::uint32_t>(next), is_inside_[tet], seeds_[tet]);
            }
        }
    }
    void put_tets()
    {
        for (std::uint32_t tet = 0; tet < own_.tets.size(); ++tet) {
            put(own_.tets[tet]);
            for (std::uint32_t face = 0; face < 4; ++face) {
                const std::uint32_t other = others_[make_half_face(tet, face)];
                if (other != NO_HALF_FACE)
                    joined_.neighbours[tet][face] = static_cast<std::int32_t>(half_face_tet(other));
            }
        }
        std::vector<std::int32_t> places(corners_.size(), -1);
        for (std::uint32_t tet = 0; tet < corners_.size(); ++tet)
            if (!is_inside_[tet]) places[tet] = put(corners_[tet]);
        for (std::uint32_t tet = 0; tet < corners_.size(); ++tet)
            for (std::uint32_t face = 0; face < 4 && places[tet] >= 0; ++face)
                join_face(tet, face, places);
    }
    std::int32_t put(const TetCorners& corners)
    {
        Tet& tet = joined_.tets.emplace_back();
        for (std::size_t i = 0; i < 4; ++i)
            tet[i] = static_cast<std::int32_t>(corners[i]);
        joined_.neighbours.push_back({-1, -1, -1, -1});
        return static_cast<std::int32_t>(joined_.tets.size() - 1);
    }
    void join_face(std::uint32_t tet, std::uint32_t face, const std::vector<std::int32_t>& places)
    {
        const std::int32_t next = filled_.neighbours[tet][face];
        const std::uint32_t hull = hull_of_[make_half_face(tet, face)];
        std::int32_t& neighbour = joined_.neighbours[static_cast<std::size_t>(places[tet])][face];
        if (hull != NO_HALF_FACE) {
            neighbour = static_cast<std::int32_t>(half_face_tet(hull));
            joined_.neighbours[half_face_tet(hull)][half_face_index(hull)] = places[tet];
        } else if (next >= 0)
            neighbour = places[static_cast<std::size_t>(next)];
    }
    void put_faces()
    {
        for (const Float3 vertex : scene_.mesh.vertices)
            joined_.points.push_back(to_double(vertex));
        joined_.points.insert(joined_.points.end(),
                              filled_.points.begin() + static_cast<std::ptrdiff_t>(own_.hull_vertices.size()),
                              filled_.points.end());
        joined_.input_points = filled_.input_points - own_.hull_vertices.size() + scene_.mesh.vertices.size();
        joined_.flat_tets = filled_.flat_tets;
        joined_.maker = filled_.maker;
        std::int32_t triangle = 0;
        for (const auto& [a, b, c] : scene_.mesh.triangles)
            joined_.surface_faces.push_back(
                {{static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)},
                 triangle++});
        for (const RawTets::SurfaceFace& face : filled_.surface_faces)
            if (face.triangle < 0) {
                const auto& [a, b, c] = face.corners;
                joined_.surface_faces.push_back({{place_of(a), place_of(b), place_of(c)}, face.triangle});
            }
    }

    const OwnTets& own_;
    const Scene& scene_;
    const RawTets& filled_;
    std::vector<std::uint32_t> others_;
    std::vector<TetCorners> corners_;    ///< of the tets of `filled`
    std::vector<std::uint32_t> hull_of_; ///< of their half-faces, the own half-face that is there
    std::vector<std::uint32_t> seeds_;   ///< the own half-face from which a tet was reached
    std::vector<bool> is_inside_;        ///< of these tets
    std::vector<std::uint32_t> pending_;
    RawTets joined_;
};

} // namespace

RawTets join_own_tets(const OwnTets& own, const Scene& scene, const RawTets& filled)
{
    return OwnTetsJoiner(own, scene, filled).join();
}

void require_own_tets(const OwnTets& own, const Scene& scene)
{
    for (std::size_t i = 0; i < own.tets.size(); ++i) {
        TetCorners corners = own.tets[i];
        std::swap(corners[0], corners[1]); // the scene's orientation
        for (std::size_t k = 0; k < 4; ++k)
            if (i >= scene.tets.tets.size() ||
                scene.tets.vertices[scene.tets.tets[i].vertices[k]] != scene.mesh.vertices[corners[k]])
                throw BuilderFailure(BUILDER_ABSURD_OUTPUT, fmt::format("checking the tets: tet {} of {} was changed",
                                                                        own.numbers[i].number, scene.build.source));
    }
}

} // namespace tetrace
