#include "scenes/builder/cavity_fill.h"

#include "core/base/exact.h"

#include <algorithm>

// Tets that are all positive and share their faces in twos cover each point as often as their outer sides wind around
// it: once in a cavity. So no test for overlap is needed.

namespace tetrace {

FaceSide face_side_of(const std::array<std::uint32_t, 4>& tet, std::size_t face)
{
    const auto& [a, b, c] = face_corners[face];
    FaceSide side = {tet[a], tet[b], tet[c]};
    std::ranges::rotate(side, std::ranges::min_element(side));
    return side;
}

FaceSide reversed(const FaceSide& side)
{
    return {side[0], side[2], side[1]};
}

bool CavityFill::find(const std::set<std::uint32_t>& needed)
{
    if (front_.empty()) return has_all(needed);
    if (tries_-- <= 0 || tests_ == 0) return false;
    FaceSide hardest{};
    std::vector<std::uint32_t> apexes;
    std::size_t fewest = vertices_.size() + 1;
    for (const FaceSide& side : front_) {
        auto possible = apexes_of(side, fewest);
        if (possible.size() >= fewest) continue;
        fewest = possible.size();
        apexes = std::move(possible);
        hardest = side;
        if (fewest == 0) return false;
    }
    for (const std::uint32_t apex : apexes) {
        if (tests_ == 0) return false;
        spend(front_.size() + closed_.size());
        const auto front = front_, closed = closed_;
        add(hardest, apex);
        if (find(needed)) return true;
        front_ = front;
        closed_ = closed;
        tets_.pop_back();
    }
    return false;
}

void CavityFill::spend(std::size_t tests)
{
    tests_ -= std::min<std::uint64_t>(tests_, tests);
}

bool CavityFill::has_all(std::set<std::uint32_t> needed) const
{
    for (const auto& tet : tets_)
        for (const std::uint32_t vertex : tet)
            needed.erase(vertex);
    return needed.empty();
}

const std::vector<std::uint32_t>& CavityFill::vertices_above(const FaceSide& side)
{
    const auto [known, is_new] = above_.try_emplace(side);
    const auto& [a, b, c] = side;
    if (!is_new) return known->second;
    spend(vertices_.size());
    for (const std::uint32_t apex : vertices_)
        if (orientation(points_[apex], points_[a], points_[b], points_[c]) < 0) known->second.push_back(apex);
    return known->second;
}

// At most `limit` of them.
std::vector<std::uint32_t> CavityFill::apexes_of(const FaceSide& side, std::size_t limit)
{
    std::vector<std::uint32_t> apexes;
    for (const std::uint32_t apex : vertices_above(side)) {
        if (apexes.size() == limit) break;
        spend(1);
        if (may_add(side, apex)) apexes.push_back(apex);
    }
    return apexes;
}

bool CavityFill::may_add(const FaceSide& side, std::uint32_t apex) const
{
    for (std::size_t face = 1; face < 4; ++face) {
        const FaceSide other = face_side_of({apex, side[0], side[1], side[2]}, face);
        if (closed_.contains(other) || (!front_.contains(other) && front_.contains(reversed(other)))) return false;
    }
    return true;
}

void CavityFill::add(const FaceSide& side, std::uint32_t apex)
{
    tets_.push_back({apex, side[0], side[1], side[2]});
    for (std::size_t face = 0; face < 4; ++face) {
        const FaceSide each = face_side_of(tets_.back(), face);
        closed_.insert(each);
        if (front_.erase(each) == 0) front_.insert(reversed(each));
    }
}

} // namespace tetrace
