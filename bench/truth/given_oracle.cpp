#include "bench/truth/given_oracle.h"

#include "bench/truth/judge.h"
#include "core/rays/ray_offset.h"

#include <cassert>
#include <vector>

namespace tetrace {
namespace {

static_assert(FREE_FACE == NO_HIT, "a ray that starts on no triangle starts on none that could be hit");

} // namespace

struct GivenOracle::Parts {
    Parts(const TriangleMesh& mesh, unsigned threads) : judge(mesh, threads) {}

    [[nodiscard]] JudgedRay ray_of(const RaySet& set, std::size_t number, Origins origins) const
    {
        const GivenRay& ray = set.rays[number];
        const ExactRay own{ray.origin, ray.direction};
        return {.ray = own,
                .traced = origins == Origins::own ? own : ExactRay{offset_origin(ray, judge.mesh()), ray.direction},
                .part = {ray.triangle, ray.end, set.any_hit},
                .first = {},
                .view = set.view,
                .x = ray.pixel % set.width,
                .y = ray.pixel / set.width,
                .pixel = ray.pixel};
    }

    void find_first_hits(const RaySet& set)
    {
        const std::uint64_t hash = ray_hash(set);
        if (first.size() == set.rays.size() && first_hash == hash) return;
        first.resize(set.rays.size());
        first_hash = hash;
        static_cast<void>(judge.for_each(set.rays.size(), [&](Verdicts&, std::size_t i) {
            const JudgedRay ray = ray_of(set, i, Origins::own);
            first[i] = judge.first(ray.ray, ray.part);
        }));
    }

    // Whether the answer is right for the origin that it was traced from.
    [[nodiscard]] bool is_right_as_traced(JudgedRay ray, const Hit& hit, HitFormula formula) const
    {
        ray.ray = ray.traced;
        ray.first = judge.first(ray.ray, ray.part);
        Verdicts unused;
        return !judge.judge(unused, ray, hit, formula);
    }

    Judge judge;
    std::vector<FirstHit> first; ///< of the last set
    std::uint64_t first_hash = 0;
};

GivenOracle::GivenOracle(const TriangleMesh& mesh, unsigned threads) : parts_(std::make_unique<Parts>(mesh, threads)) {}

GivenOracle::~GivenOracle() = default;

Verdicts GivenOracle::judge(const RaySet& set, std::span<const Hit> hits, Origins origins, HitFormula formula)
{
    assert(hits.size() == set.rays.size());
    parts_->find_first_hits(set);
    const Judge& judge = parts_->judge;
    return judge.for_each(hits.size(), [&](Verdicts& verdicts, std::size_t i) {
        JudgedRay ray = parts_->ray_of(set, i, origins);
        ray.first = parts_->first[i];
        const auto flaw = judge.judge(verdicts, ray, hits[i], formula);
        if (!flaw) return;
        if (origins == Origins::offset && parts_->is_right_as_traced(ray, hits[i], formula))
            ++verdicts.offset;
        else
            judge.blame(verdicts, ray, hits[i], *flaw);
    });
}

} // namespace tetrace
