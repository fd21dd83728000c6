#include "bench/rows/best_bvh.h"

namespace tetrace {

namespace {

bool is_of(BvhKind kind, const Contender& row)
{
    if (!row.is_bvh) return false;
    return kind == BvhKind::any || (row.is_single && row.is_embree == (kind == BvhKind::embree_single));
}

} // namespace

bool is_single_ray(const KernelId& kernel)
{
    if (is_embree(kernel.layout)) return kernel.method == Method::single;
    return kernel.schedule != Schedule::packets;
}

std::optional<std::size_t> best_bvh(const std::vector<Contender>& rows, std::size_t row, BvhKind kind)
{
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].arena == rows.at(row).arena && is_of(kind, rows[i]) &&
            (!best || rows[i].mrays_per_s > rows[*best].mrays_per_s))
            best = i;
    return best;
}

std::string bvh_text(const std::vector<Contender>& rows, std::size_t bvh)
{
    return (best_bvh(rows, bvh) == bvh ? "the fastest BVH, " : "") + rows.at(bvh).name;
}

} // namespace tetrace
