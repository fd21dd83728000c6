#include "bench/truth/crossings.h"

#include "bench/truth/absorption.h"
#include "bench/truth/judge.h"
#include "bench/truth/tube.h"
#include "core/base/exact.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

namespace tetrace {

namespace {

using Corners = std::array<Double3, 3>;

constexpr double no_gap = 0x1p-36;     // what double precision may leave between two tets, in domain units
constexpr double looser = 1 + 0x1p-20; // of a bound: far more than double precision errs

/// A signed distance that is linear along the ray: positive inside a face's plane.
struct Clearance {
    double at_origin, slope;

    [[nodiscard]] double at(double depth) const { return at_origin + slope * depth; }
};

/// A part of the ray, by distances from its origin; empty if it ends before it begins.
struct Stretch {
    double begin, end;
};

/// Where the ray is inside all planes, from a distance on.
Stretch inside_of(std::span<const Clearance> planes, double from)
{
    Stretch part{from, std::numeric_limits<double>::infinity()};
    for (const Clearance& plane : planes) {
        const double met = -plane.at_origin / plane.slope;
        if (plane.slope > 0) part.begin = std::max(part.begin, met);
        if (plane.slope < 0) part.end = std::min(part.end, met);
        if (plane.slope == 0 && plane.at_origin < 0) part.end = -std::numeric_limits<double>::infinity();
    }
    return part;
}

double least_clearance(std::span<const Clearance> planes, double depth)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Clearance& plane : planes)
        least = std::min(least, plane.at(depth));
    return least;
}

/// How deep the ray is inside all planes, at the deepest point of a part of it. The least of linear functions is
/// largest at an end of the part, or where two of them are equal.
double deepest_in(std::span<const Clearance> planes, Stretch part)
{
    double deepest = std::max(least_clearance(planes, part.begin), least_clearance(planes, part.end));
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double equal = (planes[j].at_origin - planes[i].at_origin) / (planes[i].slope - planes[j].slope);
            if (equal > part.begin && equal < part.end) deepest = std::max(deepest, least_clearance(planes, equal));
        }
    return deepest;
}

/// How far the ray passes a triangle.
double distance_across(const Corners& corners)
{
    double least = std::numeric_limits<double>::infinity();
    std::array<double, 3> sides{};
    for (std::size_t i = 0; i < 3; ++i) {
        const tube::Double2 p = tube::across(corners[i]), q = tube::across(corners[(i + 1) % 3]), pq = q - p;
        sides[i] = tube::cross(p, q);
        const double square = tube::dot(pq, pq);
        const double along = square > 0 ? std::clamp(-tube::dot(p, pq) / square, 0.0, 1.0) : 0;
        least = std::min(least, tube::length(p + pq * along));
    }
    const auto [low, high] = std::minmax({sides[0], sides[1], sides[2]});
    return low >= 0 || high <= 0 ? std::min(least, low == 0 && high == 0 ? least : 0.0) : least;
}

/// The depths of the points of a triangle that are within a radius of the ray; those of the whole triangle bound them.
/// They are largest and least on an edge, or where the plane leaves the radius farthest up and down inside the
/// triangle.
std::optional<Stretch> depths_within(const Corners& corners, double radius)
{
    std::vector<double> depths;
    for (std::size_t i = 0; i < 3; ++i)
        for (const Double3 end : tube::clipped(corners[i], corners[(i + 1) % 3], radius, tube::across))
            depths.push_back(end.z);
    const Double3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const tube::Double2 rise = tube::across(normal) * (-1 / normal.z); // of depth, per distance across
    const double steep = tube::length(rise);
    for (const double sign : {-1.0, 1.0}) {
        if (!std::isfinite(steep)) continue;
        const tube::Double2 place = steep > 0 ? rise * (sign * radius / steep) : tube::Double2{};
        if (const auto depth = tube::depth_at({0, corners}, place)) depths.push_back(*depth);
    }
    if (depths.empty()) return std::nullopt;
    const auto [low, high] = std::ranges::minmax(depths);
    return Stretch{low, high};
}

/// The sides of a tet by which a ray may enter or leave it, or the domain, at a place.
struct Ways {
    unsigned sides = 0;         ///< a bit each
    const char* flaw = nullptr; ///< of the last other one
};

/// One ray among the tets.
class CrossedRay {
public:
    CrossedRay(Task task, const Scene& scene, const GivenRay& ray, std::span<const std::uint32_t> mesh_of_packed)
        : absorbs_(traits_of(task).absorbs), scene_(scene), ray_(ray), mesh_of_packed_(mesh_of_packed),
          frame_({ray.origin, ray.direction}), bound_(tie_bound(ray.origin) * looser),
          from_outside_(ray.half_face == NO_HALF_FACE)
    {
        const Double3 direction = to_double(ray.direction);
        const std::array<double, 3> along = {direction.x, direction.y, direction.z};
        const auto axis = static_cast<std::size_t>(
            std::ranges::max_element(along, {}, [](double a) { return std::abs(a); }) - along.begin());
        const double stretch = length(direction) / std::abs(along[axis]);
        const double origin = std::copysign(1.0, along[axis]) * ray.origin[static_cast<int>(axis)];
        place_of_origin_ = (2 + origin) * stretch;
    }

    /// Why the answer is wrong; null: it is not.
    [[nodiscard]] const char* flaw_of(const Hit& answer, const CrossedTets& walk);
    /// Whether the exact ray crosses the walk's tets and no others, and how far the ray is from the walk's faces.
    [[nodiscard]] bool is_exact() const { return is_exact_; }
    [[nodiscard]] double distance() const { return distance_; }

private:
    [[nodiscard]] const Tet& tet(std::uint32_t number) const { return scene_.tets.tets[number]; }
    [[nodiscard]] Double3 seen(std::uint32_t vertex) const { return frame_.local(scene_.tets.vertices[vertex]); }
    [[nodiscard]] Corners face(std::uint32_t number, std::size_t face) const
    {
        const auto& corners = face_corners.at(face);
        const auto& vertices = tet(number).vertices;
        return {seen(vertices.at(corners[0])), seen(vertices.at(corners[1])), seen(vertices.at(corners[2]))};
    }
    [[nodiscard]] std::array<Clearance, 4> planes_of(std::uint32_t number) const;
    [[nodiscard]] std::array<Clearance, 6> planes_of_domain() const;
    [[nodiscard]] double depth_of(std::uint32_t place) const { return length_of(place) - place_of_origin_; }
    [[nodiscard]] const char* flaw_of_face(std::uint32_t number, std::size_t side, std::uint32_t place);
    [[nodiscard]] const char* flaw_of_step(std::uint32_t number, std::uint32_t next, std::uint32_t place);
    [[nodiscard]] Ways boundary_of(std::uint32_t number, std::uint32_t place, double sense);
    [[nodiscard]] Ways end_of(std::uint32_t number, std::uint32_t place);
    [[nodiscard]] const char* flaw_of_ends(const CrossedTets& walk);
    [[nodiscard]] const char* flaw_of_chain(const CrossedTets& walk);
    [[nodiscard]] const char* flaw_of_gaps();
    [[nodiscard]] bool leaves_out(Stretch gap) const;

    bool absorbs_;
    bool is_absorbed_ = false; ///< the walk may end inside the domain
    const Scene& scene_;
    const GivenRay& ray_;
    std::span<const std::uint32_t> mesh_of_packed_;
    tube::Frame frame_;
    double bound_;
    bool from_outside_;
    double place_of_origin_ = 0;
    std::vector<std::uint32_t> chain_; ///< the scene's numbers
    double distance_ = 0;
    double end_ = std::numeric_limits<double>::infinity(); ///< of the exact ray that is looked at
    bool is_exact_ = true;
};

std::array<Clearance, 4> CrossedRay::planes_of(std::uint32_t number) const
{
    std::array<Clearance, 4> planes{};
    for (std::size_t side = 0; side < 4; ++side) {
        const auto [a, b, c] = face(number, side);
        const Double3 normal = normalized(cross(b - a, c - a)); // to the inside, by the order of the corners
        planes.at(side) = {-dot(normal, a), normal.z};
    }
    return planes;
}

std::array<Clearance, 6> CrossedRay::planes_of_domain() const
{
    const Float3 low = scene_.domain.low(), high = scene_.domain.high();
    const Double3 along = normalized(to_double(ray_.direction));
    const std::array<double, 3> slopes = {along.x, along.y, along.z};
    std::array<Clearance, 6> planes{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        const double origin = ray_.origin[axis];
        planes.at(2 * i) = {origin - low[axis], slopes.at(i)};
        planes.at(2 * i + 1) = {high[axis] - origin, -slopes.at(i)};
    }
    return planes;
}

/// The ray must pass a face within the bound, and the place must be that of a point of the face near there.
const char* CrossedRay::flaw_of_face(std::uint32_t number, std::size_t side, std::uint32_t place)
{
    const Corners corners = face(number, side);
    const double distance = distance_across(corners);
    if (distance > bound_) return "the ray passes one of its faces farther away than rounding explains";
    const auto depths = depths_within(corners, 2 * (bound_ + distance));
    const auto [low, high] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
    const double slack = 2 * bound_ + 12 * 0x1p-24 * (high - low);
    const double depth = depth_of(place);
    if (!depths || depth < depths->begin - slack || depth > depths->end + slack)
        return "a place is not where the ray meets that face";
    if (depths->end < -slack) return "one of its faces is behind the ray's origin";
    distance_ = std::max(distance_, distance);
    return nullptr;
}

const char* CrossedRay::flaw_of_step(std::uint32_t number, std::uint32_t next, std::uint32_t place)
{
    const char* flaw = "one of its tets is no neighbour of the tet before";
    for (std::size_t side = 0; side < 4; ++side) {
        const std::uint32_t across = tet(number).neighbours.at(side);
        if (across == NO_HALF_FACE || half_face_tet(across) != next) continue;
        flaw = flaw_of_face(number, side, place);
        if (flaw == nullptr) break;
    }
    return flaw;
}

/// sense: 1 to enter the domain, -1 to leave it. If the ray is far deeper in the tet than the bound, it cannot do so
/// against a face's sense.
Ways CrossedRay::boundary_of(std::uint32_t number, std::uint32_t place, double sense)
{
    const auto planes = planes_of(number);
    const Stretch part = inside_of(planes, 0);
    const bool is_deep = part.begin < part.end && deepest_in(planes, part) > 4 * bound_;
    Ways ways{0, "it does not begin and end at the domain's boundary, in the ray's sense"};
    for (std::size_t side = 0; side < 4; ++side) {
        if (tet(number).neighbours.at(side) != NO_HALF_FACE) continue;
        if (is_deep && planes.at(side).slope * sense < 0) continue;
        if (const char* const flaw = flaw_of_face(number, side, place))
            ways.flaw = flaw;
        else
            ways.sides |= 1u << side;
    }
    return ways;
}

/// The sides by which a walk that is absorbed inside the domain may leave its last tet. The exact ray matters to where
/// it may do so first.
Ways CrossedRay::end_of(std::uint32_t number, std::uint32_t place)
{
    Ways ways;
    for (std::size_t side = 0; side < 4; ++side) {
        if (const char* const flaw = flaw_of_face(number, side, place)) {
            ways.flaw = flaw;
            continue;
        }
        ways.sides |= 1u << side;
        const Corners corners = face(number, side);
        if (const auto depths = depths_within(corners, 2 * (bound_ + distance_across(corners))))
            end_ = std::min(end_, depths->begin);
    }
    return ways;
}

const char* CrossedRay::flaw_of_ends(const CrossedTets& walk)
{
    const std::uint32_t place = walk.places.back();
    const Ways last = is_absorbed_ ? end_of(chain_.back(), place) : boundary_of(chain_.back(), place, -1);
    if (last.sides == 0) return last.flaw;
    if (!from_outside_)
        return std::abs(depth_of(walk.places.front())) <= 0x1p-26 ? nullptr : "it does not begin at the ray's origin";
    const Ways first = boundary_of(chain_.front(), walk.places.front(), 1);
    if (first.sides == 0) return first.flaw;
    const bool is_one_side = first.sides == last.sides && std::has_single_bit(first.sides);
    return chain_.size() == 1 && is_one_side ? "it leaves its only tet by the face by which it enters" : nullptr;
}

const char* CrossedRay::flaw_of_chain(const CrossedTets& walk)
{
    chain_.clear();
    for (const std::uint32_t tet : walk.tets) {
        if (tet >= mesh_of_packed_.size()) return "it names a tet that does not exist";
        chain_.push_back(mesh_of_packed_[tet]);
    }
    if (std::set(chain_.begin(), chain_.end()).size() != chain_.size()) return "it crosses a tet twice";
    for (std::size_t i = 1; i < chain_.size(); ++i)
        if (const char* const flaw = flaw_of_step(chain_[i - 1], chain_[i], walk.places[i])) return flaw;
    return flaw_of_ends(walk);
}

/// Whether a tet that is not in the chain has the ray, in a part of it, deeper inside than the bound. Goes from tet to
/// tet near that part.
bool CrossedRay::leaves_out(Stretch gap) const
{
    const auto is_near = [&](std::uint32_t number) {
        Stretch depths{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        tube::Double2 low{depths.begin, depths.begin}, high{depths.end, depths.end};
        for (const std::uint32_t vertex : tet(number).vertices) {
            const Double3 p = seen(vertex);
            depths = {std::min(depths.begin, p.z), std::max(depths.end, p.z)};
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        return depths.begin <= gap.end + bound_ && depths.end >= gap.begin - bound_ &&
               std::max({low.x, low.y, -high.x, -high.y}) <= bound_;
    };
    std::vector<std::uint32_t> next;
    std::set<std::uint32_t> seen_tets;
    for (const std::uint32_t number : chain_)
        if (is_near(number) && seen_tets.insert(number).second) next.push_back(number);
    const std::set<std::uint32_t> own(chain_.begin(), chain_.end());
    while (!next.empty()) {
        const std::uint32_t number = next.back();
        next.pop_back();
        if (!own.contains(number)) {
            const auto planes = planes_of(number);
            const Stretch part = inside_of(planes, gap.begin);
            const Stretch inside{part.begin, std::min(part.end, gap.end)};
            if (inside.begin < inside.end && deepest_in(planes, inside) > bound_) return true;
        }
        for (const std::uint32_t across : tet(number).neighbours)
            if (across != NO_HALF_FACE && is_near(half_face_tet(across)) &&
                seen_tets.insert(half_face_tet(across)).second)
                next.push_back(half_face_tet(across));
    }
    return false;
}

/// The exact ray, in the domain, less what the chain's tets have of it.
const char* CrossedRay::flaw_of_gaps()
{
    const auto domain = planes_of_domain();
    Stretch rest = inside_of(domain, 0);
    rest.end = std::min(rest.end, end_);
    std::vector<Stretch> parts;
    for (const std::uint32_t number : chain_) {
        const Stretch part = inside_of(planes_of(number), 0);
        if (part.end < part.begin - no_gap) is_exact_ = false;
        if (part.begin < part.end) parts.push_back(part);
    }
    std::ranges::sort(parts, {}, &Stretch::begin);
    parts.push_back({rest.end, rest.end});
    for (const Stretch& part : parts) {
        if (part.begin > rest.begin + no_gap && rest.begin + no_gap < rest.end) {
            const bool is_start = rest.begin == 0 && part.begin <= bound_; // of an origin that is rounded off a face
            is_exact_ = is_exact_ && is_start;
            if (leaves_out({rest.begin, std::min(part.begin, rest.end)}))
                return "it leaves out a tet in which the ray is deeper than rounding explains";
        }
        rest.begin = std::max(rest.begin, part.end);
    }
    return nullptr;
}

const char* CrossedRay::flaw_of(const Hit& answer, const CrossedTets& walk)
{
    if (absorbs_) {
        const Absorbed absorbed = absorbed_of(answer);
        if (absorbed != absorption_of(walk)) return "its tets, hash, light or transmittance are not those of its walk";
        if (absorbed.crossings != walk.tets.size()) return "its walk goes on where too little light passes";
        is_absorbed_ = absorbed.transmittance < MIN_TRANSMITTANCE;
    } else if (segments_of(answer) != summary_of(walk)) {
        return "its tets, hash or length are not those of its walk";
    }
    if (!walk.tets.empty()) {
        if (const char* const flaw = flaw_of_chain(walk)) return flaw;
        return flaw_of_gaps();
    }
    const auto domain = planes_of_domain();
    const Stretch part = inside_of(domain, 0);
    const bool is_inside = part.begin < part.end && deepest_in(domain, part) > bound_;
    return is_inside ? "it crosses no tet, but the ray crosses the domain" : nullptr;
}

} // namespace

Segments summary_of(const CrossedTets& walk)
{
    if (walk.tets.empty()) return {NO_HIT, NO_TET, 0, 0, 0, 0};
    Segments sum{walk.tets.front(), walk.tets.back(), 0, 0, 0, static_cast<std::uint32_t>(walk.tets.size())};
    const auto add = [&](std::uint32_t word) {
        sum.hash = (sum.hash ^ word) * 0x9E3779B1u;
        sum.hash ^= sum.hash >> 15u;
    };
    std::uint32_t farthest = walk.places.front();
    for (std::size_t i = 0; i < walk.tets.size(); ++i) {
        const std::uint32_t place = walk.places.at(i + 1);
        add(walk.tets[i]);
        add(place);
        if (place < farthest) ++sum.reversed;
        farthest = std::max(farthest, place);
    }
    sum.length = farthest - walk.places.front();
    return sum;
}

Verdicts judge_crossings(Task task, const Scene& scene, const RaySet& set, std::span<const Hit> answers,
                         std::span<const std::uint32_t> mesh_of_packed,
                         const std::function<CrossedTets(std::size_t)>& walk_of, unsigned threads)
{
    const int team = threads != 0 ? static_cast<int>(threads) : omp_get_max_threads();
    const bool absorbs = traits_of(task).absorbs;
    return judge_each(team, answers.size(), [&](Verdicts& verdicts, std::size_t i) {
        const GivenRay& ray = set.rays[i];
        const bool is_lost = answers[i].face_id == LOST;
        CrossedRay crossed(task, scene, ray, mesh_of_packed);
        const char* const flaw =
            is_lost ? "the walk reached its cap of steps" : crossed.flaw_of(answers[i], walk_of(i));
        if (flaw == nullptr) {
            ++(crossed.is_exact() ? verdicts.agreed : verdicts.ties);
            if (!crossed.is_exact())
                verdicts.max_tie_distance = std::max(verdicts.max_tie_distance, crossed.distance());
            return;
        }
        ++(is_lost ? verdicts.lost : verdicts.wrong);
        verdicts.flawed.push_back(ray.pixel);
        if (verdicts.first_wrong) return;
        verdicts.first_wrong = WrongRay{.view = set.view,
                                        .x = ray.pixel % set.width,
                                        .y = ray.pixel / set.width,
                                        .ours = answers[i],
                                        .reason = flaw,
                                        .task = absorbs ? Task::absorb : Task::segments};
    });
}

} // namespace tetrace
