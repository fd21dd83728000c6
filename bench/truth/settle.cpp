#include "bench/truth/settle.h"

#include "bench/truth/hit_point.h"
#include "core/base/exact.h"
#include "core/rays/ray_set.h"

#include <algorithm>
#include <cmath>

namespace tetrace {
namespace {

using Kind = Settlement::Kind;

std::array<Float3, 3> corners_of(const TriangleMesh& mesh, std::uint32_t triangle)
{
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

double distance_from_line(const ExactRay& ray, Double3 point)
{
    const Double3 direction = to_double(ray.direction);
    return length(cross(point, direction)) / length(direction);
}

} // namespace

struct Settler::Case {
    ExactRay ray;
    RayPart part;
    std::uint32_t answer;
    double bound;
    std::vector<std::uint32_t> near; // what is within the bound of the ray

    // The part's end, and the triangle's t: each may be off, but no more than the triangle and the bound allow.
    [[nodiscard]] bool is_beyond_end(const TriangleMesh& mesh, std::uint32_t triangle) const
    {
        if (!part.has_end()) return false;
        const double end = static_cast<double>(part.end), t = point_of(mesh, ray, triangle).t;
        return (std::isfinite(t) && t > end + end_error_of(mesh, ray, triangle, bound)) ||
               depths(mesh, triangle).first > end + bound / length(to_double(ray.direction));
    }
    [[nodiscard]] bool may_be_beyond_end(const TriangleMesh& mesh, std::uint32_t triangle) const
    {
        if (!part.has_end()) return false;
        const double end = static_cast<double>(part.end);
        return !(point_of(mesh, ray, triangle).t < end - end_error_of(mesh, ray, triangle, bound)) &&
               depths(mesh, triangle).second >= end - bound / length(to_double(ray.direction));
    }
    // Ray parameters of the triangle's nearest and farthest corner.
    [[nodiscard]] std::pair<double, double> depths(const TriangleMesh& mesh, std::uint32_t triangle) const
    {
        const Double3 direction = to_double(ray.direction);
        std::pair<double, double> range{HUGE_VAL, -HUGE_VAL};
        for (const Float3 corner : corners_of(mesh, triangle)) {
            const double t = dot(to_double(corner) - to_double(ray.origin), direction) / dot(direction, direction);
            range = {std::min(range.first, t), std::max(range.second, t)};
        }
        return range;
    }
};

bool Settler::is_before(const ExactRay& ray, std::uint32_t a, std::uint32_t b) const
{
    const auto p = corners_of(mesh_, a), q = corners_of(mesh_, b);
    const Float3 first[3] = {p[0], p[1], p[2]}, second[3] = {q[0], q[1], q[2]};
    return compare_distance(ray.origin, ray.direction, first, second) == std::strong_ordering::less;
}

// The triangles that the exact ray meets, and all near ones that it sees edge-on, with the least t of these.
std::vector<Settler::Met> Settler::met_by(const Case& question) const
{
    std::vector<Met> met;
    for (const std::uint32_t triangle : question.near) {
        const auto corners = corners_of(mesh_, triangle);
        const auto crossing =
            cross_exactly(question.ray.origin, question.ray.direction, corners[0], corners[1], corners[2]);
        const auto& side = crossing.edge_side;
        if (crossing.met)
            met.push_back({triangle, crossing.t, false});
        else if (side[0] == 0 && side[1] == 0 && side[2] == 0)
            met.push_back({triangle, question.depths(mesh_, triangle).first, true});
    }
    return met;
}

Settlement Settler::settle(const ExactRay& ray, const RayPart& part, std::uint32_t answer, double bound) const
{
    if (answer != NO_HIT && answer == part.start) return {.reason = "it is the triangle that the ray starts on"};
    const Case question{ray, part, answer, bound, search_.within(ray, part, bound)};
    return part.any_hit && answer != NO_HIT ? settle_any(question) : settle_first(question);
}

// One triangle that the ray meets, or a curve near it, will do.
Settlement Settler::settle_any(const Case& question) const
{
    const auto may_be = [&](std::uint32_t triangle) {
        return question.answer == SOME_HIT || triangle == question.answer;
    };
    const auto end = static_cast<double>(question.part.end);
    Settlement settlement{.reason = "the ray passes its triangle, or ends before it, by more than the bound"};
    for (const Met& met : met_by(question)) {
        if (met.is_edge_on || met.t > end) continue;
        settlement.first = met.triangle;
        if (may_be(met.triangle)) return {.kind = Kind::exact, .first = met.triangle};
    }
    for (const std::uint32_t triangle : question.near) {
        if (!may_be(triangle) || question.is_beyond_end(mesh_, triangle)) continue;
        settlement.witness =
            find_witness(mesh_, {question.ray, question.part, triangle, question.bound, {&triangle, 1}});
        if (settlement.witness.empty()) continue;
        settlement.kind = Kind::tie;
        settlement.reason = "a curve near the ray meets its triangle";
        break;
    }
    for (const Double3 corner : settlement.witness)
        settlement.distance = std::max(settlement.distance, distance_from_line(question.ray, corner));
    return settlement;
}

Settlement Settler::settle_first(const Case& question) const
{
    const auto& [ray, part, answer, bound, near] = question;
    const auto end = static_cast<double>(part.end);
    Settlement settlement;
    bool is_met = false, is_exact = true;
    const auto met = met_by(question);
    for (const Met& one : met) {
        if (one.triangle == answer) is_met = !one.is_edge_on;
        if (one.is_edge_on || one.t > end) continue;
        if (settlement.first == NO_HIT || is_before(ray, one.triangle, settlement.first))
            settlement.first = one.triangle;
    }
    const double answer_t = answer == NO_HIT ? end : point_of(mesh_, ray, answer).t;
    if (answer != NO_HIT && question.is_beyond_end(mesh_, answer)) {
        settlement.reason = "the ray ends before its triangle";
        return settlement;
    }
    for (const Met& one : met)
        if (one.triangle != answer)
            is_exact =
                is_exact && (one.is_edge_on || answer == NO_HIT || !is_met ? one.t > answer_t
                                                                           : !is_before(ray, one.triangle, answer));
    if (is_exact && (answer == NO_HIT || (is_met && answer_t <= end))) {
        settlement.kind = Kind::exact;
        return settlement;
    }
    std::vector<std::uint32_t> obstacles;
    for (const std::uint32_t triangle : near)
        if (answer != NO_HIT || !question.may_be_beyond_end(mesh_, triangle)) obstacles.push_back(triangle);
    settlement.witness = find_witness(mesh_, {ray, part, answer, bound, obstacles});
    settlement.kind = settlement.witness.empty() ? Kind::wrong : Kind::tie;
    settlement.reason = !settlement.witness.empty() ? "a curve near the ray meets that first"
                        : answer == NO_HIT          ? "all curves near the ray meet a triangle"
                                                    : "no curve near the ray meets its triangle first";
    for (const Double3 corner : settlement.witness)
        settlement.distance = std::max(settlement.distance, distance_from_line(ray, corner));
    return settlement;
}

} // namespace tetrace
