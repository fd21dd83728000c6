#include "bench/truth/oracle.h"

#include "backends/embree/session.h"
#include "bench/truth/hit_point.h"
#include "bench/truth/settle.h"
#include "core/base/exact.h"

#include <omp.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

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

void Verdicts::add(const Verdicts& other)
{
    for (const auto count : {&Verdicts::rays, &Verdicts::agreed, &Verdicts::ties, &Verdicts::settled, &Verdicts::offset,
                             &Verdicts::wrong, &Verdicts::lost})
        this->*count += other.*count;
    largest_tie_distance = std::max(largest_tie_distance, other.largest_tie_distance);
    if (!first_wrong) first_wrong = other.first_wrong;
}

struct Oracle::Parts {
    Parts(const TriangleMesh& triangles, unsigned thread_count)
        : mesh(triangles), threads(thread_count != 0 ? thread_count : static_cast<unsigned>(omp_get_max_threads())),
          accelerator(triangles, true, threads), settler(triangles)
    {
    }

    void trace_reference(const View& view, std::uint32_t width, std::uint32_t height)
    {
        if (!reference.empty() && reference.size() == std::size_t{width} * height && reference_width == width &&
            view == reference_view)
            return;
        reference.resize(std::size_t{width} * height);
        embree::trace_image(accelerator, Method::single, {view, width, height, NO_TET, 0}, reference, threads);
        reference_view = view;
        reference_width = width;
    }

    void judge_ray(Verdicts& verdicts, const View& view, std::uint32_t number, std::size_t pixel,
                   const Hit& ours) const;

    const TriangleMesh& mesh;
    unsigned threads;
    embree::Accelerator accelerator;
    Settler settler;
    std::vector<Hit> reference;
    View reference_view{};
    std::uint32_t reference_width = 0;
};

void Oracle::Parts::judge_ray(Verdicts& verdicts, const View& view, std::uint32_t number, std::size_t pixel,
                              const Hit& ours) const
{
    const auto x = static_cast<std::uint32_t>(pixel % reference_width);
    const auto y = static_cast<std::uint32_t>(pixel / reference_width);
    const Hit& theirs = reference[pixel];
    const auto blame = [&](std::uint64_t& count, const char* reason) {
        ++count;
        verdicts.flawed.push_back(static_cast<std::uint32_t>(pixel));
        if (!verdicts.first_wrong)
            verdicts.first_wrong = WrongRay{number, x, y, ours, theirs.face_id, theirs.t, reason};
    };
    if (ours.face_id == LOST) return blame(verdicts.lost, "the walk found no exit face, or reached its cap of steps");
    const bool is_face = ours.face_id < mesh.triangles.size();
    if (!is_face && ours.face_id != NO_HIT)
        return blame(verdicts.wrong, "it names no triangle (was the hit written at all?)");

    const ExactRay ray = exact_ray(view, x, y);
    const double bound = tie_bound(view.origin);
    if (is_face && !names_one_point(mesh, ray, ours, bound))
        return blame(verdicts.wrong, "its t, u and v do not name one point");
    if (ours.face_id == theirs.face_id) {
        ++verdicts.agreed;
        return;
    }
    const Settlement settlement = settler.settle(ray, ours.face_id, theirs.face_id, bound);
    if (settlement.kind == Settlement::Kind::wrong) return blame(verdicts.wrong, settlement.reason);
    (settlement.kind == Settlement::Kind::tie ? verdicts.ties : verdicts.settled)++;
    verdicts.largest_tie_distance = std::max(verdicts.largest_tie_distance, settlement.distance);
}

Oracle::Oracle(const TriangleMesh& mesh, unsigned threads) : parts_(std::make_unique<Parts>(mesh, threads)) {}

Oracle::~Oracle() = default;

Verdicts Oracle::judge(std::uint32_t view_number, const View& view, std::uint32_t width, std::uint32_t height,
                       std::span<const Hit> hits)
{
    assert(hits.size() == std::size_t{width} * height);
    parts_->trace_reference(view, width, height);
    std::vector<Verdicts> rows(height);
#pragma omp parallel for schedule(dynamic, 8) num_threads(static_cast <int>(parts_->threads))
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::size_t pixel = std::size_t{y} * width; pixel < std::size_t{y + 1} * width; ++pixel)
            parts_->judge_ray(rows[y], view, view_number, pixel, hits[pixel]);
    Verdicts all;
    for (const Verdicts& row : rows) {
        all.add(row);
        all.flawed.insert(all.flawed.end(), row.flawed.begin(), row.flawed.end());
    }
    all.rays = hits.size();
    return all;
}

} // namespace tetrace
