#include "bench/truth/oracle.h"

#include "bench/truth/judge.h"
#include "core/pack/packed_scene.h"

#include <cassert>

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

} // namespace tetrace
