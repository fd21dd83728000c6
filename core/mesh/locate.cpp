#include "core/mesh/locate.h"

#include "core/base/exact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tetrace {

namespace {

std::array<Float3, 4> corners_of(const TetMesh& mesh, const Tet& tet)
{
    return {mesh.vertices[tet.vertices[0]], mesh.vertices[tet.vertices[1]], mesh.vertices[tet.vertices[2]],
            mesh.vertices[tet.vertices[3]]};
}

// Sign of the point's position at a face: negative inside, as the tet's own orientation is.
int side_of_face(std::array<Float3, 4> corners, std::size_t face, Float3 point)
{
    corners[face] = point;
    return orientation(corners[0], corners[1], corners[2], corners[3]);
}

bool holds(const TetMesh& mesh, const Tet& tet, Float3 point)
{
    const auto corners = corners_of(mesh, tet);
    for (std::size_t face = 0; face < 4; ++face)
        if (side_of_face(corners, face, point) > 0) return false;
    return true;
}

std::uint32_t search_all(const TetMesh& mesh, Float3 point)
{
    for (std::uint32_t i = 0; i < mesh.tets.size(); ++i)
        if (holds(mesh, mesh.tets[i], point)) return i;
    return NO_TET;
}

double distance_to_face(std::array<Float3, 4> corners, std::size_t face, Float3 point)
{
    const Double3 a = to_double(corners[(face + 1) % 4]);
    const Double3 normal = cross(to_double(corners[(face + 2) % 4]) - a, to_double(corners[(face + 3) % 4]) - a);
    return std::abs(dot(normal, to_double(point) - a)) / length(normal);
}

// Distance to the nearest face of the tet; 0 on a face.
double clearance(const TetMesh& mesh, std::uint32_t tet, Float3 point)
{
    const auto corners = corners_of(mesh, mesh.tets[tet]);
    double least = HUGE_VAL;
    for (std::size_t face = 0; face < 4; ++face) {
        if (side_of_face(corners, face, point) == 0) return 0;
        least = std::min(least, distance_to_face(corners, face, point));
    }
    return least;
}

constexpr double enough = 0x1p-16; // several times tie_bound() for a camera in the domain
constexpr float nudges[] = {0x1p-15f, 0x1p-13f, 0x1p-12f};

Float3 nudged(Float3 point, int choice, float by)
{
    // 26 neighbours in a cube, as digits of base 3.
    const int digit[3] = {choice % 3 - 1, choice / 3 % 3 - 1, choice / 9 - 1};
    for (int axis = 0; axis < 3; ++axis)
        point[axis] += static_cast<float>(digit[axis]) * by;
    return snap_to_grid(point);
}

} // namespace

WalkEnd walk_to(const TetMesh& mesh, std::uint32_t from, Float3 point, std::uint32_t max_steps)
{
    WalkEnd end{WalkEnd::Kind::too_far, NO_TET, 0};
    std::uint32_t tet = from;
    std::uint32_t turn = 0; // which face is asked first changes from tet to tet, so that no cycle repeats for ever
    for (;; ++end.steps) {
        const auto corners = corners_of(mesh, mesh.tets[tet]);
        turn = turn * 1664525u + 1013904223u;
        std::uint32_t beyond = 4;
        for (std::uint32_t k = 0; k < 4 && beyond == 4; ++k) {
            const std::uint32_t face = (k + (turn >> 30)) & 3u;
            if (side_of_face(corners, face, point) > 0) beyond = face;
        }
        if (beyond == 4) return {WalkEnd::Kind::arrived, tet, end.steps};
        const std::uint32_t half_face = mesh.tets[tet].neighbours[beyond];
        if (half_face == NO_HALF_FACE) return {WalkEnd::Kind::outside, NO_TET, end.steps}; // the domain is convex
        if (end.steps == max_steps) return end;
        tet = half_face_tet(half_face);
    }
}

std::uint32_t locate(const TetMesh& mesh, Float3 point)
{
    const std::size_t max_steps = std::min<std::size_t>(2 * mesh.tets.size() + 16, UINT32_MAX);
    const WalkEnd end = walk_to(mesh, 0, point, static_cast<std::uint32_t>(max_steps));
    return end.kind == WalkEnd::Kind::too_far ? search_all(mesh, point) : end.tet;
}

bool is_inside(const Scene& scene, const Start& start)
{
    return start.tet != NO_TET && clearance(scene.tets, start.tet, start.origin) > 0;
}

Start find_start(const Scene& scene, Float3 origin)
{
    return find_start(scene, origin, [&](Float3 point) { return locate(scene.tets, point); });
}

Start find_start(const Scene& scene, Float3 origin, const Locator& locator)
{
    if (!scene.domain.contains(origin) || scene.tets.tets.empty()) return {origin, NO_TET};
    const std::uint32_t tet = locator(origin);
    Start best{origin, tet};
    double most = tet == NO_TET ? 0 : clearance(scene.tets, tet, origin);
    for (const float by : nudges) {
        if (most >= enough) break;
        for (int choice = 0; choice < 27; ++choice) {
            const Float3 candidate = nudged(origin, choice, by);
            if (!scene.domain.contains(candidate)) continue;
            const std::uint32_t at = locator(candidate);
            const double room = at == NO_TET ? 0 : clearance(scene.tets, at, candidate);
            if (room > most) best = {candidate, at};
            most = std::max(most, room);
        }
    }
    return best;
}

MoveLimit usual_move_limit(const Domain& domain)
{
    const Double3 extent = to_double(domain.high()) - to_double(domain.low());
    return {std::max({extent.x, extent.y, extent.z}) / 4, 4096};
}

bool MovingStart::is_near(Float3 point) const
{
    return last_.tet != NO_TET && length(to_double(point) - to_double(last_.origin)) <= limit_.distance;
}

std::optional<Start> MovingStart::walk(Float3 origin)
{
    bool gave_up = false;
    std::uint32_t from = last_.tet;
    const Start start = find_start(*scene_, origin, [&](Float3 point) {
        if (gave_up) return NO_TET;
        const WalkEnd end = walk_to(scene_->tets, from, point, limit_.steps);
        counts_.steps += end.steps;
        counts_.max_steps = std::max(counts_.max_steps, end.steps);
        gave_up = end.kind == WalkEnd::Kind::too_far;
        if (end.tet != NO_TET) from = end.tet; // where a camera is moved to is near
        return end.tet;
    });
    // On a face, an edge or a vertex the tet depends on the way: exact location has to choose it.
    if (gave_up || (start.tet != NO_TET && !is_inside(*scene_, start))) return std::nullopt;
    return start;
}

Start MovingStart::next(Float3 origin)
{
    const auto walked = is_near(origin) ? walk(origin) : std::nullopt;
    ++(walked ? counts_.walked : counts_.located);
    last_ = walked ? *walked : find_start(*scene_, origin);
    return last_;
}

} // namespace tetrace
