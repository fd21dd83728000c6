#include "bench/truth/oracle.h"

#include "bench/truth/judge.h"
#include "core/pack/packed_scene.h"
#include "core/rays/ray_start.h"

#include <cassert>
#include <vector>

namespace tetrace {

namespace {
namespace kernel {
#include "kernels/rays_cpp.h"

Ray pixel_ray(const View& view, std::uint32_t x, std::uint32_t y)
{
    return primary_ray(params_of(view), x, y);
}
} // namespace kernel

ExactRay exact_ray(const View& view, std::uint32_t x, std::uint32_t y)
{
    const auto ray = kernel::pixel_ray(view, x, y);
    return {{ray.origin.x, ray.origin.y, ray.origin.z}, {ray.direction.x, ray.direction.y, ray.direction.z}};
}

} // namespace

struct Oracle::Parts {
    Parts(const TriangleMesh& mesh, unsigned threads) : judge(mesh, threads) {}

    [[nodiscard]] JudgedRay ray_of(std::uint32_t number, const View& view, std::uint32_t wide, std::size_t pixel) const
    {
        const auto x = static_cast<std::uint32_t>(pixel % wide), y = static_cast<std::uint32_t>(pixel / wide);
        const ExactRay ray = exact_ray(view, x, y);
        return {ray, ray, {}, {}, number, x, y, static_cast<std::uint32_t>(pixel)};
    }

    void find_first_hits(const View& view, std::uint32_t wide, std::size_t rays)
    {
        if (first.size() == rays && width == wide && view == seen) return;
        first.resize(rays);
        seen = view;
        width = wide;
        static_cast<void>(judge.for_each(rays, [&](Verdicts&, std::size_t pixel) {
            first[pixel] = judge.first(ray_of(0, view, wide, pixel).ray, {});
        }));
    }

    Judge judge;
    std::vector<FirstHit> first; ///< of the last view
    View seen{};
    std::uint32_t width = 0;
};

Oracle::Oracle(const TriangleMesh& mesh, unsigned threads) : parts_(std::make_unique<Parts>(mesh, threads)) {}

Oracle::~Oracle() = default;

Verdicts Oracle::judge(std::uint32_t view_number, const View& view, std::uint32_t width,
                       [[maybe_unused]] std::uint32_t height, std::span<const Hit> hits, HitFormula formula)
{
    assert(hits.size() == std::size_t{width} * height);
    parts_->find_first_hits(view, width, hits.size());
    const Judge& judge = parts_->judge;
    return judge.for_each(hits.size(), [&](Verdicts& verdicts, std::size_t pixel) {
        JudgedRay ray = parts_->ray_of(view_number, view, width, pixel);
        ray.first = parts_->first[pixel];
        if (const auto flaw = judge.judge(verdicts, ray, hits[pixel], formula))
            judge.blame(verdicts, ray, hits[pixel], *flaw);
    });
}

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
