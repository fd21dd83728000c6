#include "bench/truth/tally.h"

#include "bench/truth/judge.h"
#include "bench/truth/tube.h"
#include "core/base/error.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

namespace tetrace {

namespace {

/// What a ray has of a tet, whose vertices are as the ray sees them. A place is that of a point within four bounds of
/// the ray (docs/spec/volume.md, S7, rule 4), so it is off by at most that over the sine of the face's angle to the
/// ray, and by rounding. A chord has two places, and is no longer than the tet.
ExactChord exact_chord(std::uint32_t tet, const std::array<Double3, 4>& vertices, double bound)
{
    double begin = 0, end = std::numeric_limits<double>::infinity(), off = 0, extent = 0;
    for (std::size_t side = 0; side < 4; ++side) {
        const auto& corners = face_corners.at(side);
        const Double3 a = vertices.at(corners[0]), b = vertices.at(corners[1]), c = vertices.at(corners[2]);
        const Double3 normal = normalized(cross(b - a, c - a)); // to the inside
        const double from_origin = -dot(normal, a);
        if (normal.z > 0) begin = std::max(begin, -from_origin / normal.z);
        if (normal.z < 0) end = std::min(end, -from_origin / normal.z);
        if (normal.z == 0 && from_origin < 0) end = -std::numeric_limits<double>::infinity();
        off = std::max(off, normal.z == 0 ? std::numeric_limits<double>::infinity() : 4 * bound / std::abs(normal.z));
        extent = std::max({extent, length(a - b), length(b - c), length(c - a)});
    }
    return {tet,
            begin,
            {std::max(0.0, end - begin), std::min(2 * (off + 2 * bound + 12 * 0x1p-24 * extent), extent) + 0x1p-26}};
}

/// Whether the ray, from its origin on, comes within the distance of the tet's bounding box.
bool is_near(const std::array<Double3, 4>& vertices, double distance)
{
    Double3 low = vertices[0], high = low;
    for (const Double3& p : vertices) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return std::max({low.x, low.y, -high.x, -high.y, -high.z}) <= distance;
}

} // namespace

std::vector<std::uint64_t> tally_of_walks(std::size_t rays, std::size_t tets,
                                          const std::function<CrossedTets(std::size_t)>& walk_of, unsigned threads)
{
    std::vector<std::uint64_t> sums(tets);
    const int team = threads != 0 ? static_cast<int>(threads) : omp_get_max_threads();
    static_cast<void>(judge_each(team, rays, [&](Verdicts&, std::size_t ray) {
        const CrossedTets walk = walk_of(ray);
        std::uint32_t farthest = walk.tets.empty() ? 0 : walk.places.front();
        for (std::size_t i = 0; i < walk.tets.size(); ++i) {
            const std::uint32_t next = std::max(farthest, walk.places.at(i + 1));
            std::atomic_ref(sums.at(walk.tets[i])).fetch_add(next - farthest, std::memory_order_relaxed);
            farthest = next;
        }
    }));
    return sums;
}

void require_total(std::span<const std::uint64_t> tally, std::span<const Hit> answers)
{
    const std::uint64_t sum = std::accumulate(tally.begin(), tally.end(), std::uint64_t{0});
    const std::uint64_t expected = count_segments(answers).length_units;
    if (sum == expected) return;
    throw Error(ErrorKind::wrong_result,
                fmt::format("the sums of the tets add up to {} units, the lengths of the rays to {}", sum, expected));
}

void require_sums(std::span<const std::uint64_t> tally, std::span<const std::uint64_t> expected)
{
    if (tally.size() != expected.size()) throw Error(ErrorKind::internal, "require_sums: tallies of different scenes");
    std::size_t wrong = 0, first = 0;
    for (std::size_t tet = tally.size(); tet-- > 0;)
        if (tally[tet] != expected[tet]) ++wrong, first = tet;
    if (wrong == 0) return;
    throw Error(ErrorKind::wrong_result,
                fmt::format("the sums of {} of {} tets are not those of their rays, the first that of tet {}: {} "
                            "units instead of {}",
                            wrong, tally.size(), first, tally[first], expected[first]));
}

std::vector<ExactChord> exact_chords(const Scene& scene, const GivenRay& ray)
{
    std::vector<ExactChord> chords;
    const tube::Frame frame({ray.origin, ray.direction});
    const double bound = tie_bound(ray.origin);
    for (std::uint32_t tet = 0; tet < scene.tets.tets.size(); ++tet) {
        std::array<Double3, 4> vertices{};
        for (std::size_t i = 0; i < 4; ++i)
            vertices.at(i) = frame.local(scene.tets.vertices[scene.tets.tets[tet].vertices[i]]);
        if (is_near(vertices, 2 * bound)) chords.push_back(exact_chord(tet, vertices, bound));
    }
    return chords;
}

std::vector<ExactLength> exact_tally(const Scene& scene, const RaySet& set)
{
    std::vector<ExactLength> sums(scene.tets.tets.size());
    for (const GivenRay& ray : set.rays)
        for (const ExactChord& chord : exact_chords(scene, ray)) {
            sums[chord.tet].length += chord.share.length;
            sums[chord.tet].bound += chord.share.bound;
        }
    return sums;
}

} // namespace tetrace
