#include "bench/truth/hit_checks.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/rays/absorbed.h"
#include "core/rays/segments.h"

#include <algorithm>
#include <cstring>

namespace tetrace {

namespace {

/// Unlike ==, distinguishes 0 from -0.
bool has_same_bits(const Hit& a, const Hit& b)
{
    return std::memcmp(&a, &b, sizeof(Hit)) == 0;
}

bool is_triangle(const Hit& hit)
{
    return hit.face_id < POISON; // NO_HIT, LOST and POISON are the largest
}

std::uint64_t max_ulps(const Hit& a, const Hit& b)
{
    return std::max({ulps_between(a.t, b.t), ulps_between(a.u, b.u), ulps_between(a.v, b.v)});
}

} // namespace

void RayTotals::add(const RayTotals& other)
{
    for (const auto count : counts_of_totals)
        this->*count += other.*count;
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

RayTotals count_segments(std::span<const Hit> answers)
{
    RayTotals totals = count_rays(answers);
    for (const Hit& answer : answers) {
        const Segments segments = segments_of(answer);
        if (segments.first == POISON) continue;
        totals.reversed += segments.reversed;
        totals.length_units += segments.length;
    }
    return totals;
}

RayTotals count_absorbed(std::span<const Hit> answers)
{
    RayTotals totals = count_rays(answers);
    for (const Hit& answer : answers) {
        const Absorbed absorbed = absorbed_of(answer);
        if (absorbed.first == POISON) continue;
        totals.absorbed += absorbed.transmittance < MIN_TRANSMITTANCE ? 1 : 0;
        totals.light_units += absorbed.light;
    }
    return totals;
}

bool is_same_hit(const Hit& a, const Hit& b, Allowance allowed)
{
    if (has_same_bits(a, b)) return true;
    if (allowed.any_triangle && is_triangle(a) && is_triangle(b)) return true;
    return allowed.ulps > 0 && a.face_id == b.face_id && a.tet == b.tet && a.steps == b.steps &&
           max_ulps(a, b) <= allowed.ulps;
}

Differences compare_hits(std::span<const Hit> hits, std::span<const Hit> reference, Allowance allowed)
{
    if (hits.size() != reference.size()) throw Error(ErrorKind::internal, "compare_hits: images of different sizes");
    Differences differences;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (has_same_bits(hits[i], reference[i])) continue;
        ++differences.inexact;
        if (!is_same_hit(hits[i], reference[i], allowed)) {
            ++differences.count;
            if (!differences.first) differences.first = i;
        } else if (hits[i].face_id == reference[i].face_id) {
            differences.max_ulps = std::max(differences.max_ulps, max_ulps(hits[i], reference[i]));
        }
    }
    return differences;
}

} // namespace tetrace
