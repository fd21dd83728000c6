#include "bench/truth/given_oracle.h"

#include "backends/embree/accelerator.h"
#include "bench/truth/hit_point.h"
#include "bench/truth/settle.h"
#include "core/base/exact.h"
#include "core/rays/ray_offset.h"

#include <omp.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace tetrace {
namespace {

static_assert(FREE_FACE == NO_HIT, "a ray that starts on no triangle starts on none that could be hit");

constexpr std::size_t rays_at_once = 1024; // one thread judges these, one after the other

struct Reference {
    std::uint32_t face = NO_HIT;
    float t = 0;
};

// The nearest triangle except the one that the ray starts on. A filter would need another kind of scene. Other
// triangles at the place where that triangle was found are settled by exact arithmetic.
Reference embree_nearest(const embree::Accelerator& accelerator, const ExactRay& ray, const RayPart& part)
{
    float near = 0;
    while (near <= part.end) {
        RTCRayHit query = embree::query_of(ray.origin, ray.direction, near, part.end);
        accelerator.intersect(query, embree::Coherence::incoherent);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
        if (query.hit.primID != part.start) return {query.hit.primID, query.ray.tfar};
        near = std::nextafter(query.ray.tfar, HUGE_VALF);
    }
    return {};
}

struct Judged {
    GivenRay ray;
    RayPart part;
    Hit ours;
    Reference theirs;
};

} // namespace

struct GivenOracle::Parts {
    Parts(const TriangleMesh& triangles, unsigned thread_count)
        : mesh(triangles), threads(static_cast<int>(thread_count != 0 ? thread_count : omp_get_max_threads())),
          accelerator(triangles, true, static_cast<unsigned>(threads)), settler(triangles)
    {
    }

    void trace_reference(const RaySet& set);
    void judge_ray(Verdicts& verdicts, const RaySet& set, std::size_t number, const Hit& ours, Origins origins) const;
    [[nodiscard]] Settlement settle(const Judged& judged, Origins origins) const;
    [[nodiscard]] std::uint32_t some_face(const Judged& judged, Origins origins) const;
    [[nodiscard]] const char* flaw_of(const Judged& judged, Origins origins) const;
    [[nodiscard]] ExactRay exact_ray_of(const GivenRay& ray, Origins origins) const
    {
        return {origins == Origins::own ? ray.origin : offset_origin(ray, mesh), ray.direction};
    }

    const TriangleMesh& mesh;
    int threads;
    embree::Accelerator accelerator;
    Settler settler;
    std::vector<Reference> reference;
    std::uint64_t reference_hash = 0;
};

void GivenOracle::Parts::trace_reference(const RaySet& set)
{
    const std::uint64_t hash = ray_hash(set);
    if (reference.size() == set.rays.size() && reference_hash == hash) return;
    reference.resize(set.rays.size());
    reference_hash = hash;
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads)
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        const GivenRay& ray = set.rays[i];
        reference[i] =
            embree_nearest(accelerator, exact_ray_of(ray, Origins::own), {ray.triangle, ray.end, set.any_hit});
    }
}

// What is wrong with a hit, regardless of other triangles; null: nothing.
const char* GivenOracle::Parts::flaw_of(const Judged& judged, Origins origins) const
{
    const auto& [given, part, ours, theirs] = judged;
    if (ours.face_id == NO_HIT) return nullptr;
    if (ours.face_id >= mesh.triangles.size()) return "it names no triangle (was the hit written at all?)";
    if (ours.face_id == part.start) return "it is the triangle that the ray starts on";
    const ExactRay ray = exact_ray_of(given, origins);
    const double bound = tie_bound(ray.origin);
    if (!names_one_point(mesh, ray, ours, bound)) return "its t, u and v do not name one point";
    if (ours.t > part.end) return "its t lies beyond the ray's end";
    const double behind = -static_cast<double>(ours.t) * length(to_double(ray.direction));
    return behind > bound * hit_condition(mesh, ray, ours.face_id) ? "its t lies before the ray's start" : nullptr;
}

Settlement GivenOracle::Parts::settle(const Judged& judged, Origins origins) const
{
    const ExactRay ray = exact_ray_of(judged.ray, origins);
    const Reference theirs = origins == Origins::own ? judged.theirs : embree_nearest(accelerator, ray, judged.part);
    return settler.settle(ray, judged.part, judged.ours.face_id, theirs.face, tie_bound(ray.origin));
}

// The triangle that an any-hit answer may stand for: one that the ray meets, or meets when moved by the bound in one of
// four directions, or slightly past its end. Exact arithmetic then decides whether it is acceptable.
std::uint32_t GivenOracle::Parts::some_face(const Judged& judged, Origins origins) const
{
    if (judged.theirs.face != NO_HIT) return judged.theirs.face;
    const ExactRay ray = exact_ray_of(judged.ray, origins);
    const Double3 along = to_double(ray.direction);
    const double bound = tie_bound(ray.origin);
    RayPart longer = judged.part;
    longer.end += static_cast<float>(16 * bound / length(along));
    const Double3 a =
        normalized(cross(along, std::abs(along.x) > std::abs(along.y) ? Double3{0, 1, 0} : Double3{1, 0, 0}));
    const Double3 b = normalized(cross(along, a));
    for (const Double3 shift : {Double3{}, a * bound, a * -bound, b * bound, b * -bound}) {
        const ExactRay moved{to_float(to_double(ray.origin) + shift), ray.direction};
        const std::uint32_t face = embree_nearest(accelerator, moved, longer).face;
        if (face != NO_HIT) return face;
    }
    return NO_HIT;
}

void GivenOracle::Parts::judge_ray(Verdicts& verdicts, const RaySet& set, std::size_t number, const Hit& ours,
                                   Origins origins) const
{
    using Kind = Settlement::Kind;
    const GivenRay& ray = set.rays[number];
    Judged judged{ray, {ray.triangle, ray.end, set.any_hit}, ours, reference[number]};
    const auto blame = [&](std::uint64_t& count, const char* reason) {
        ++count;
        verdicts.flawed.push_back(ray.pixel);
        if (!verdicts.first_wrong)
            verdicts.first_wrong = WrongRay{set.view, ray.pixel % set.width, ray.pixel / set.width,
                                            ours,     judged.theirs.face,    judged.theirs.t,
                                            reason};
    };
    if (ours.face_id == LOST) return blame(verdicts.lost, "the walk found no exit face, or reached its cap of steps");
    if (ours.face_id == SOME_HIT && set.any_hit) {
        judged.ours.face_id = some_face(judged, origins);
        if (judged.ours.face_id == NO_HIT)
            return blame(verdicts.wrong, "it says that something is hit, and nothing is near");
    } else if (const char* flaw = flaw_of(judged, origins))
        return blame(verdicts.wrong, flaw);
    if (judged.ours.face_id == judged.theirs.face) {
        ++verdicts.agreed;
        return;
    }
    const Settlement settlement = settle(judged, Origins::own);
    const bool both_hit = ours.face_id != NO_HIT && judged.theirs.face != NO_HIT;
    if (settlement.kind == Kind::tie) {
        ++verdicts.ties;
        verdicts.largest_tie_distance = std::max(verdicts.largest_tie_distance, settlement.distance);
    } else if (settlement.kind == Kind::ours)
        (set.any_hit && both_hit ? verdicts.agreed : verdicts.settled)++;
    else if (origins == Origins::offset && settle(judged, origins).kind != Kind::wrong)
        ++verdicts.offset;
    else
        blame(verdicts.wrong, settlement.reason);
}

GivenOracle::GivenOracle(const TriangleMesh& mesh, unsigned threads) : parts_(std::make_unique<Parts>(mesh, threads)) {}

GivenOracle::~GivenOracle() = default;

Verdicts GivenOracle::judge(const RaySet& set, std::span<const Hit> hits, Origins origins)
{
    assert(hits.size() == set.rays.size());
    parts_->trace_reference(set);
    std::vector<Verdicts> blocks((hits.size() + rays_at_once - 1) / rays_at_once);
#pragma omp parallel for schedule(dynamic, 1) num_threads(parts_->threads)
    for (std::size_t block = 0; block < blocks.size(); ++block)
        for (std::size_t i = block * rays_at_once; i < std::min((block + 1) * rays_at_once, hits.size()); ++i)
            parts_->judge_ray(blocks[block], set, i, hits[i], origins);
    Verdicts all;
    for (const Verdicts& block : blocks) {
        all.add(block);
        all.flawed.insert(all.flawed.end(), block.flawed.begin(), block.flawed.end());
    }
    std::ranges::sort(all.flawed);
    all.rays = hits.size();
    return all;
}

} // namespace tetrace
