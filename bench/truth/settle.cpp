#include "bench/truth/settle.h"

#include "bench/truth/hit_point.h"
#include "core/base/exact.h"

#include <algorithm>
#include <cmath>

namespace tetrace {
namespace {

constexpr double never = HUGE_VAL;

// Distance between the ray's line and the segment ab.
double line_to_segment(const ExactRay& ray, Double3 a, Double3 b)
{
    const Double3 d = normalized(to_double(ray.direction));
    const auto across = [&](Double3 p) { return p - d * dot(p, d); }; // remove the component along the ray
    const Double3 pa = across(a - to_double(ray.origin));
    const Double3 ab = across(b - a);
    const double square = dot(ab, ab);
    const double s = square > 0 ? std::clamp(-dot(pa, ab) / square, 0.0, 1.0) : 0.0;
    return length(pa + ab * s);
}

} // namespace

Settler::Settler(const TriangleMesh& mesh) : mesh_(mesh)
{
    ranges_.assign(mesh.vertices.size() + 1, 0);
    for (const auto& triangle : mesh.triangles)
        for (const auto v : triangle)
            ranges_[v + 1]++;
    for (std::size_t v = 1; v < ranges_.size(); ++v)
        ranges_[v] += ranges_[v - 1];
    incident_.resize(ranges_.back());
    auto next = ranges_;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        for (const auto v : mesh.triangles[i])
            incident_[next[v]++] = i;
}

std::vector<std::uint32_t> Settler::candidates(std::uint32_t a, std::uint32_t b) const
{
    std::vector<std::uint32_t> all;
    for (const auto triangle : {a, b}) {
        if (triangle == NO_HIT) continue;
        for (const auto v : mesh_.triangles[triangle]) {
            const auto around = triangles_at(v);
            all.insert(all.end(), around.begin(), around.end());
        }
    }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

std::array<Float3, 3> Settler::corners(std::uint32_t triangle) const
{
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
}

bool Settler::meets(const ExactRay& ray, const RayPart& part, std::uint32_t triangle) const
{
    if (triangle == part.start) return false;
    const auto [a, b, c] = corners(triangle);
    const ExactCrossing crossing = cross_exactly(ray.origin, ray.direction, a, b, c);
    return crossing.met && (part.end >= NO_END || crossing.t <= static_cast<double>(part.end));
}

// Distance from the part of the ray to a triangle that it does not meet: from the ray's line, or beyond its start or
// end; `never` where it exceeds the allowed distance.
double Settler::excess(const ExactRay& ray, const RayPart& part, std::uint32_t triangle, double bound) const
{
    const auto [a, b, c] = corners(triangle);
    const auto& side = cross_exactly(ray.origin, ray.direction, a, b, c).edge_side;
    const auto [least, most] = std::minmax({side[0], side[1], side[2]});
    const bool line_meets = least >= 0 || most <= 0;
    if (line_meets && !part.is_whole()) return distance_to_limits(ray, part, triangle, bound);
    const double distance = distance_to_outline(ray, triangle);
    return distance <= bound ? distance : never;
}

// Distance from the ray's crossing of a triangle's plane to its start or end; `never` where neither is within its
// limit.
double Settler::distance_to_limits(const ExactRay& ray, const RayPart& part, std::uint32_t triangle, double bound) const
{
    if (part.is_whole()) return never;
    const auto [a, b, c] = corners(triangle);
    const double speed = length(to_double(ray.direction));
    const double t = cross_exactly(ray.origin, ray.direction, a, b, c).t;
    const double from_start = std::abs(t) * speed;
    if (part.start != NO_HIT && from_start <= bound) return from_start;
    const double from_end = std::abs(t - static_cast<double>(part.end)) * speed;
    return part.end < NO_END && from_end <= bound * hit_condition(mesh_, ray, triangle) ? from_end : never;
}

bool Settler::is_before(const ExactRay& ray, std::uint32_t a, std::uint32_t b) const
{
    if (b == NO_HIT) return true;
    const auto pa = corners(a);
    const auto pb = corners(b);
    const Float3 first[3] = {pa[0], pa[1], pa[2]};
    const Float3 second[3] = {pb[0], pb[1], pb[2]};
    return compare_distance(ray.origin, ray.direction, first, second) == std::strong_ordering::less;
}

double Settler::distance_to_edge(const ExactRay& ray, std::uint32_t a, std::uint32_t b) const
{
    return line_to_segment(ray, to_double(mesh_.vertices[a]), to_double(mesh_.vertices[b]));
}

double Settler::distance_to_outline(const ExactRay& ray, std::uint32_t triangle) const
{
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return std::min({distance_to_edge(ray, a, b), distance_to_edge(ray, b, c), distance_to_edge(ray, c, a)});
}

bool Settler::is_silhouette(const ExactRay& ray, std::uint32_t a, std::uint32_t b) const
{
    const Double3 origin = to_double(mesh_.vertices[a]);
    const Double3 normal = cross(to_double(mesh_.vertices[b]) - origin, to_double(ray.direction));
    bool left = false, right = false;
    for (const auto triangle : triangles_at(a)) {
        const auto& v = mesh_.triangles[triangle];
        if (std::ranges::find(v, b) == v.end()) continue;
        const auto opposite = std::ranges::find_if(v, [&](auto x) { return x != a && x != b; });
        const double side = dot(normal, to_double(mesh_.vertices[*opposite]) - origin);
        left = left || side > 0;
        right = right || side < 0;
    }
    return !(left && right);
}

// Distance from the ray to the nearest edge over which it escapes `triangle`: one shared with ours, or a silhouette.
double Settler::escape_distance(const ExactRay& ray, std::uint32_t triangle, std::uint32_t ours, double bound) const
{
    double nearest = never;
    for (const auto a : mesh_.triangles[triangle]) {
        const bool at_vertex = distance_to_edge(ray, a, a) <= bound;
        for (const auto neighbour : triangles_at(a)) {
            if (neighbour != triangle && !at_vertex) continue; // edges of other triangles count only around a vertex
            for (const auto b : mesh_.triangles[neighbour]) {
                if (b == a) continue;
                const double distance = distance_to_edge(ray, a, b);
                if (distance <= bound && is_silhouette(ray, a, b)) nearest = std::min(nearest, distance);
            }
        }
        if (ours == NO_HIT) continue;
        const auto& v = mesh_.triangles[ours];
        if (std::ranges::find(v, a) == v.end()) continue;
        if (at_vertex) nearest = std::min(nearest, distance_to_edge(ray, a, a));
        for (const auto b : mesh_.triangles[triangle])
            if (b != a && std::ranges::find(v, b) != v.end() && distance_to_edge(ray, a, b) <= bound)
                nearest = std::min(nearest, distance_to_edge(ray, a, b));
    }
    return nearest;
}

Settlement Settler::settle(const ExactRay& ray, std::uint32_t ours, std::uint32_t reference, double bound) const
{
    return settle(ray, RayPart{}, ours, reference, bound);
}

Settlement Settler::settle(const ExactRay& ray, const RayPart& part, std::uint32_t ours, std::uint32_t reference,
                           double bound) const
{
    using Kind = Settlement::Kind;
    if (ours != NO_HIT && ours == part.start) return {Kind::wrong, 0, "it is the triangle that the ray starts on"};
    double distance = 0;
    const bool met = ours != NO_HIT && meets(ray, part, ours);
    if (ours != NO_HIT && !met) {
        distance = excess(ray, part, ours, bound);
        if (distance == never)
            return {Kind::wrong, distance, "the exact ray passes its triangle by more than the bound"};
    }
    bool is_nearest = true;
    for (const auto candidate : candidates(ours, reference)) {
        if (part.any_hit && ours != NO_HIT) break;
        if (candidate == ours || !meets(ray, part, candidate) || !is_before(ray, candidate, ours)) continue;
        is_nearest = false;
        const double escape =
            std::min(escape_distance(ray, candidate, ours, bound), distance_to_limits(ray, part, candidate, bound));
        if (escape == never) return {Kind::wrong, distance, "it passed through a triangle that the exact ray meets"};
        distance = std::max(distance, escape);
    }
    if (is_nearest && (met || ours == NO_HIT)) return {Kind::ours, 0, "exact arithmetic agrees"};
    return {Kind::tie, distance, "the ray passes an edge within the bound"};
}

} // namespace tetrace
