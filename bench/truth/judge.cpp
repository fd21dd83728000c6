#include "bench/truth/judge.h"

#include "core/base/exact.h"
#include "core/rays/ray_set.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace tetrace {

void Verdicts::add(const Verdicts& other)
{
    for (const auto count : {&Verdicts::rays, &Verdicts::agreed, &Verdicts::ties, &Verdicts::settled, &Verdicts::offset,
                             &Verdicts::wrong, &Verdicts::lost})
        this->*count += other.*count;
    max_tie_distance = std::max(max_tie_distance, other.max_tie_distance);
    if (!first_wrong) first_wrong = other.first_wrong;
}

Judge::Judge(const TriangleMesh& mesh, unsigned threads)
    : mesh_(mesh), threads_(static_cast<int>(threads != 0 ? threads : omp_get_max_threads())), search_(mesh),
      settler_(mesh, search_)
{
}

FirstHit Judge::first(const ExactRay& ray, const RayPart& part) const
{
    return search_.first(ray, part, tie_bound(ray.origin));
}

// What is wrong with a hit, regardless of other triangles; null: nothing.
const char* Judge::flaw_of(const JudgedRay& judged, const Hit& hit, HitFormula formula) const
{
    if (hit.face_id == LOST) return "the walk found no exit face, or reached its cap of steps";
    if (hit.face_id == NO_HIT || (hit.face_id == SOME_HIT && judged.part.any_hit)) return nullptr;
    if (hit.face_id >= mesh_.triangles.size()) return "it names no triangle (was the hit written at all?)";
    if (hit.face_id == judged.part.start) return "it is the triangle that the ray starts on";
    const double bound = tie_bound(judged.traced.origin);
    if (!names_right_point(mesh_, judged.traced, hit, formula, bound))
        return "its t, u and v are not those of the point";
    const bool is_beyond = hit.t > judged.part.end && !point_of(mesh_, judged.traced, hit.face_id).may_be_edge_on;
    return is_beyond ? "its t is past the ray's end" : nullptr;
}

std::optional<Flaw> Judge::judge(Verdicts& verdicts, const JudgedRay& judged, const Hit& hit, HitFormula formula) const
{
    const auto [first, is_clear] = judged.first;
    if (const char* flaw = flaw_of(judged, hit, formula)) return Flaw{flaw, first};
    if (is_clear && (hit.face_id == first || (hit.face_id == SOME_HIT && first != NO_HIT))) {
        ++verdicts.agreed;
        return std::nullopt;
    }
    const bool may_be_another = judged.part.any_hit && hit.face_id != NO_HIT && first != NO_HIT;
    if (is_clear && !may_be_another)
        return Flaw{hit.face_id == NO_HIT ? "the exact ray meets a triangle" : "the exact ray does not meet that first",
                    first};
    const Settlement settlement = settler_.settle(judged.ray, judged.part, hit.face_id, tie_bound(judged.ray.origin));
    switch (settlement.kind) {
    case Settlement::Kind::wrong: return Flaw{settlement.reason, settlement.first};
    case Settlement::Kind::exact: ++(is_clear ? verdicts.agreed : verdicts.settled); break;
    case Settlement::Kind::tie:
        ++verdicts.ties;
        verdicts.max_tie_distance = std::max(verdicts.max_tie_distance, settlement.distance);
        break;
    }
    return std::nullopt;
}

void Judge::blame(Verdicts& verdicts, const JudgedRay& judged, const Hit& hit, Flaw flaw) const
{
    ++(hit.face_id == LOST ? verdicts.lost : verdicts.wrong);
    verdicts.flawed.push_back(judged.pixel);
    if (verdicts.first_wrong) return;
    const double t = flaw.first == NO_HIT ? 0 : point_of(mesh_, judged.ray, flaw.first).t;
    verdicts.first_wrong = WrongRay{
        judged.view, judged.x, judged.y, hit, flaw.first, std::isfinite(t) ? static_cast<float>(t) : 0, flaw.reason};
}

Verdicts sum_of(std::span<const Verdicts> blocks, std::size_t rays)
{
    Verdicts all;
    for (const Verdicts& block : blocks) {
        all.add(block);
        all.flawed.insert(all.flawed.end(), block.flawed.begin(), block.flawed.end());
    }
    std::ranges::sort(all.flawed);
    all.rays = rays;
    return all;
}

} // namespace tetrace
