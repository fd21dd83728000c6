#include "bench/measuring/figures.h"

#include "bench/rows/physical_device.h"

namespace tetrace {

namespace {

std::optional<double> quotient(std::uint64_t steps, std::uint64_t rays)
{
    if (steps == 0 || rays == 0) return std::nullopt;
    return static_cast<double>(steps) / static_cast<double>(rays);
}

/// On average; those that ask for one face after the other load the fourth where the first, one of three, is not it.
double vertices_per_step(Method method)
{
    switch (method) {
    case Method::plane: return 4;
    case Method::plucker:
    case Method::stp:
    case Method::ms06: return 3 + 2.0 / 3;
    case Method::maria:
    case Method::project: return 3;
    case Method::single:
    case Method::packet16: return 0;
    }
    throw Error(ErrorKind::internal, "vertices_per_step: no such method");
}

/// Nothing where the wall clock was not read for every sample.
void add_wall(Figures& figures, const RowRun& row)
{
    if (row.wall_samples_s.size() != row.samples_s.size()) return;
    std::vector<double> overheads;
    for (std::size_t i = 0; i < row.samples_s.size(); ++i)
        overheads.push_back(row.wall_samples_s[i] - row.samples_s[i]);
    figures.wall_s = quantile(row.wall_samples_s, 0.5);
    figures.overhead_s = quantile(std::move(overheads), 0.5);
}

} // namespace

double bytes_per_step(const KernelId& kernel)
{
    const double vertices = vertices_per_step(kernel.method);
    switch (kernel.layout) {
    case Layout::tet80: return vertices * 12 + 8;
    case Layout::tet96: return vertices * 16 + 16;
    case Layout::half32: return 16 * HALF32_QUADS;
    case Layout::tet20: return 16 + 8;
    case Layout::tet16: return 16 + 16;
    case Layout::bvh2:
    case Layout::cwbvh:
    case Layout::embree:
    case Layout::rt: return 0;
    }
    throw Error(ErrorKind::internal, "bytes_per_step: no such layout");
}

MeanSteps mean_steps(const RayTotals& totals)
{
    return {quotient(totals.steps(), totals.rays), quotient(totals.hit_steps, totals.hits),
            quotient(totals.miss_steps, totals.misses)};
}

std::optional<Figures> figures_of(const RowRun& row)
{
    const Status status = status_of(row);
    if ((status != Status::ok && status != Status::flawed) || row.samples_s.empty()) return std::nullopt;
    const RayTotals& totals = traced(row)->totals;
    Figures figures;
    figures.kernel_s = statistics_of(row.samples_s);
    const double seconds = figures.kernel_s.median;
    add_wall(figures, row);
    figures.mrays_per_s = 1e-6 * static_cast<double>(totals.rays) / seconds;
    if (totals.steps() == 0) return figures;
    figures.msteps_per_s = 1e-6 * static_cast<double>(totals.steps()) / seconds;
    if (const double bytes = bytes_per_step(row.key.kernel); bytes > 0)
        figures.gb_per_s = 1e-3 * *figures.msteps_per_s * bytes;
    return figures;
}

std::optional<double> ratio_to_single(const RowRun& row, const std::vector<RowRun>& rows)
{
    if (!runs_on_host(row.device)) return std::nullopt;
    const auto figures = figures_of(row);
    for (const RowRun& other : rows)
        if (other.key.scene == row.key.scene && other.key.rays == row.key.rays &&
            other.key.kernel.layout == Layout::embree && other.key.kernel.method == Method::single)
            if (const auto single = figures_of(other); figures && single)
                return figures->mrays_per_s / single->mrays_per_s;
    return std::nullopt;
}

} // namespace tetrace
