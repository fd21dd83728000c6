#include "bench/hit_checks.h"

#include "core/error.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace tetrace {

namespace {

constexpr double unit_roundoff = 0x1p-24;
constexpr double roundings = 64;
constexpr std::uint64_t ulps_of_division = 3;

Double3 pixel_direction(const View& view, std::size_t x, std::size_t y)
{
    return to_double(view.corner) + to_double(view.step_x) * static_cast<double>(x) +
           to_double(view.step_y) * static_cast<double>(y);
}

bool misplaced(const TriangleMesh& mesh, Double3 origin, Double3 direction, const Hit& hit)
{
    if (hit.face_id >= mesh.triangles.size()) return true;
    const auto& corners = mesh.triangles[hit.face_id];
    const Double3 v0 = to_double(mesh.vertices[corners[0]]);
    const Double3 e1 = to_double(mesh.vertices[corners[1]]) - v0;
    const Double3 e2 = to_double(mesh.vertices[corners[2]]) - v0;
    const Double3 gap = origin + direction * double{hit.t} - (v0 + e1 * double{hit.u} + e2 * double{hit.v});
    const double det = std::abs(dot(direction, cross(e1, e2)));
    const double lengths = length(origin - v0) + length(e1) + length(e2);
    // Both sides times det: no division, and a triangle seen edge-on is bounded by nothing, as it must be.
    return !(length(gap) * det <= roundings * unit_roundoff * lengths * length(direction) * length(e1) * length(e2));
}

} // namespace

void RayTotals::add(const RayTotals& other)
{
    rays += other.rays;
    hits += other.hits;
    misses += other.misses;
    lost += other.lost;
    unwritten += other.unwritten;
    hit_steps += other.hit_steps;
    miss_steps += other.miss_steps;
    lost_steps += other.lost_steps;
}

RayTotals count_rays(std::span<const Hit> hits)
{
    RayTotals totals;
    totals.rays = hits.size();
    for (const Hit& hit : hits) {
        if (hit.face_id == POISON)
            ++totals.unwritten;
        else if (hit.face_id == LOST)
            ++totals.lost, totals.lost_steps += hit.steps;
        else if (hit.face_id == NO_HIT)
            ++totals.misses, totals.miss_steps += hit.steps;
        else
            ++totals.hits, totals.hit_steps += hit.steps;
    }
    return totals;
}

std::uint64_t ulps_between(float a, float b)
{
    if (a == b) return 0;
    if (!std::isfinite(a) || !std::isfinite(b) || std::signbit(a) != std::signbit(b))
        return std::numeric_limits<std::uint64_t>::max();
    const std::int64_t distance = std::int64_t{std::bit_cast<std::int32_t>(a)} - std::bit_cast<std::int32_t>(b);
    return static_cast<std::uint64_t>(std::abs(distance));
}

Differences compare_hits(std::span<const Hit> hits, std::span<const Hit> reference)
{
    if (hits.size() != reference.size()) throw Error(ErrorKind::internal, "compare_hits: images of different sizes");
    Differences differences;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit &ours = hits[i], &theirs = reference[i];
        if (ours.face_id == theirs.face_id && ours.tet == theirs.tet && ours.steps == theirs.steps &&
            ulps_between(ours.t, theirs.t) <= ulps_of_division && ulps_between(ours.u, theirs.u) <= ulps_of_division &&
            ulps_between(ours.v, theirs.v) <= ulps_of_division)
            continue;
        ++differences.count;
        if (!differences.first) differences.first = i;
    }
    return differences;
}

std::uint64_t count_misplaced(const TriangleMesh& mesh, const View& view, std::uint32_t width,
                              std::span<const Hit> hits)
{
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].face_id >= POISON) continue; // no face: counted by count_rays()
        if (misplaced(mesh, to_double(view.origin), pixel_direction(view, i % width, i / width), hits[i])) ++count;
    }
    return count;
}

} // namespace tetrace
