#include "core/mesh/moving_start.h"

#include <algorithm>

namespace tetrace {

MoveLimit usual_move_limit(const Domain& domain)
{
    const Double3 extent = to_double(domain.high()) - to_double(domain.low());
    return {std::max({extent.x, extent.y, extent.z}) / 4, 4096};
}

bool MovingStart::is_near(Float3 point) const
{
    return last_.tet != NO_TET && length(to_double(point) - to_double(last_.origin)) <= limit_.distance;
}

std::optional<Start> MovingStart::walk(Float3 origin)
{
    bool gave_up = false;
    std::uint32_t from = last_.tet;
    const Start start = find_start(*scene_, origin, [&](Float3 point) {
        if (gave_up) return NO_TET;
        const WalkEnd end = walk_to(scene_->tets, from, point, limit_.steps);
        counts_.steps += end.steps;
        counts_.max_steps = std::max(counts_.max_steps, end.steps);
        gave_up = end.kind == WalkEnd::Kind::too_far;
        if (end.tet != NO_TET) from = end.tet; // where a camera is moved to is near
        return end.tet;
    });
    // On a face, an edge or a vertex the tet depends on the way: exact location has to choose it.
    if (gave_up || (start.tet != NO_TET && !is_inside(*scene_, start))) return std::nullopt;
    return start;
}

Start MovingStart::next(Float3 origin)
{
    const auto walked = is_near(origin) ? walk(origin) : std::nullopt;
    ++(walked ? counts_.walked : counts_.located);
    last_ = walked ? *walked : find_start(*scene_, origin);
    return last_;
}

} // namespace tetrace
