#include "bench/hit_checks.h"

#include "core/error.h"
#include "core/ulps.h"

namespace tetrace {

namespace {

constexpr std::uint64_t ulps_of_division = 3;

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

} // namespace tetrace
