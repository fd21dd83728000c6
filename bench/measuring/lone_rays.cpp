#include "bench/measuring/lone_rays.h"

#include "bench/measuring/verify.h"
#include "bench/rows/row_tracing.h"
#include "core/base/hash.h"
#include "core/device/launch.h"
#include "scenes/scramble.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace tetrace {

namespace {

constexpr std::size_t launches_of_round = 64;
constexpr std::size_t rays_of_a_thread = 32; // of one tile, whatever its height

/// Rays of one launch, and what is known of them.
struct LoneRays {
    std::vector<std::size_t> rays;
    double steps = 0;
};

/// Of a given ray that starts outside the domain: the same ray in the other direction, which misses everything.
Quad turned_away(Quad direction)
{
    constexpr std::uint32_t sign = 0x80000000u;
    return {direction.x ^ sign, direction.y ^ sign, direction.z ^ sign, direction.w};
}

/// The rays, and idle ones that fill a tile's row.
std::vector<Quad> quads_of(const std::vector<Quad>& all, const std::vector<std::size_t>& rays)
{
    const std::size_t count = all.size() / GIVEN_RAY_QUADS;
    const std::size_t width = (rays.size() + TILE_WIDTH - 1) / TILE_WIDTH * TILE_WIDTH;
    std::vector<Quad> quads(GIVEN_RAY_QUADS * width);
    for (std::size_t i = 0; i < width; ++i) {
        const std::size_t ray = rays[std::min(i, rays.size() - 1)];
        quads[i] = i < rays.size() ? all[ray] : turned_away(all[ray]);
        quads[width + i] = all[count + ray];
    }
    return quads;
}

/// A round's launches: other rays than those of earlier rounds while there are some. Rays of a launch are of similar
/// length.
std::vector<LoneRays> rays_of_round(unsigned round, std::size_t rays_per_launch, const std::vector<double>& steps)
{
    const std::size_t wanted = std::min(launches_of_round * rays_per_launch, steps.size());
    std::vector<std::size_t> rays(wanted);
    for (std::size_t i = 0; i < wanted; ++i)
        rays[i] = scramble(static_cast<std::uint32_t>(round * wanted + i)) % steps.size();
    std::ranges::sort(rays, {}, [&](std::size_t ray) { return steps[ray]; });
    std::vector<LoneRays> launches;
    for (std::size_t i = 0; i + rays_per_launch <= rays.size(); i += rays_per_launch) {
        const auto first = rays.begin() + static_cast<std::ptrdiff_t>(i);
        LoneRays& launch = launches.emplace_back();
        launch.rays.assign(first, first + static_cast<std::ptrdiff_t>(rays_per_launch));
        for (const std::size_t ray : launch.rays)
            launch.steps += steps[ray];
    }
    return launches;
}

/// In an order that does not follow their length, so that no drift looks like a cost of steps.
void mix(std::vector<LoneRays>& launches)
{
    std::vector<LoneRays> mixed;
    for (std::size_t i = 0; i < launches.size(); ++i)
        mixed.push_back(launches[i % 2 == 0 ? i / 2 : launches.size() - 1 - i / 2]);
    launches = std::move(mixed);
}

/// A session that has other rays than the row's views.
class LoneTracer {
public:
    explicit LoneTracer(RowRun& row)
        : row_(&row), view_(single_views(row).front().front()), whole_(ray_count(row, view_)),
          quads_(&row.scene->given_rays().rows(*row.scene, row.key, &row.packed->data, view_))
    {
    }

    /// Traces the whole view, whose hits must be the verified ones.
    const std::vector<Hit>& trace_all()
    {
        static_cast<void>(trace_view(*row_, view_, whole_));
        if (hash_of(std::span<const Hit>(whole_)) != traced(*row_)->view_hashes.at(view_))
            throw Error(ErrorKind::internal, "the hits changed between verifying and measuring rays alone");
        return whole_;
    }

    /// Traces these; returns device seconds.
    double trace(const std::vector<std::size_t>& rays)
    {
        const std::vector<Quad> given = quads_of(*quads_, rays);
        const std::size_t count = given.size() / GIVEN_RAY_QUADS;
        row_->views_of_rays.clear();
        row_->session->set_rays(given);
        const TraceJob whole = job_of(*row_, view_);
        const double seconds = timed_launch(*row_->session, given_job(count, whole.max_steps, false)).kernel_s;
        std::vector<Hit> hits(count, Hit{POISON, POISON, 0, 0, 0, 0});
        row_->session->read_back(hits);
        for (std::size_t i = 0; i < count; ++i)
            if (i < rays.size() ? hits[i] != whole_[rays[i]] : hits[i].face_id != NO_HIT)
                throw Error(ErrorKind::internal,
                            fmt::format("ray {} of view {} has another hit when it is traced alone",
                                        rays[std::min(i, rays.size() - 1)], row_->scene->view_numbers()[view_]));
        return seconds;
    }

private:
    RowRun* row_;
    std::size_t view_;
    std::vector<Hit> whole_;
    const std::vector<Quad>* quads_;
};

std::vector<double> steps_of(const std::vector<Hit>& hits)
{
    std::vector<double> steps;
    for (const Hit& hit : hits)
        steps.push_back(hit.steps);
    return steps;
}

double median_of(std::span<const LoneLaunch> launches, double LoneLaunch::*member)
{
    std::vector<double> values;
    for (const LoneLaunch& launch : launches)
        values.push_back(launch.*member);
    return quantile(values, 0.5);
}

} // namespace

std::optional<double> slope_of(std::vector<LoneLaunch> launches)
{
    if (launches.size() < 2) return std::nullopt;
    std::ranges::sort(launches, {}, &LoneLaunch::steps);
    const auto all = std::span<const LoneLaunch>(launches);
    const auto shorter = all.first(all.size() / 2), longer = all.last(all.size() / 2);
    const double steps = median_of(longer, &LoneLaunch::steps) - median_of(shorter, &LoneLaunch::steps);
    if (steps <= 0) return std::nullopt;
    return (median_of(longer, &LoneLaunch::seconds) - median_of(shorter, &LoneLaunch::seconds)) / steps;
}

std::vector<double> visited_nodes(const RowRun& row, std::size_t view)
{
    std::vector<double> nodes;
    for (const Visits& visits : visits_by_ray(row, view, row.scene->threads()))
        nodes.push_back(static_cast<double>(visits.nodes));
    return nodes;
}

void measure_steps(RowRun& row, StepCosts& costs, const std::vector<double>& nodes, unsigned rounds,
                   const Budget& budget)
{
    guarded(row, [&] {
        LoneTracer tracer(row);
        const std::vector<double> steps = nodes.empty() ? steps_of(tracer.trace_all()) : nodes;
        costs.steps = std::accumulate(steps.begin(), steps.end(), 0.0);
        double round_s = 0;
        for (unsigned round = 0; round < rounds && (round == 0 || budget.left_s() > round_s); ++round) {
            const double start_s = budget.now();
            static_cast<void>(tracer.trace_all());
            auto rays = rays_of_round(round, on_reference(row.key) ? rays_of_a_thread : 1, steps);
            mix(rays);
            std::vector<LoneLaunch> launches;
            for (const LoneRays& launch : rays)
                launches.push_back({launch.steps, tracer.trace(launch.rays)});
            if (const auto slope = slope_of(std::move(launches))) costs.alone_s.push_back(*slope);
            round_s = budget.now() - start_s;
        }
    });
    if (traced(row) == nullptr) costs = {};
}

} // namespace tetrace
