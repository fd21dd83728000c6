#pragma once

#include "core/base/exact.h"
#include "core/mesh/domain.h"

namespace tetrace::test {

/// The same box with other squares, of equal sizes but for rounding.
[[nodiscard]] inline Domain cut_anew(const Domain& domain, std::uint32_t divisions)
{
    Domain cut{domain.kind, divisions, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double first = domain.lines[axis].front(), last = domain.lines[axis].back();
        for (std::uint32_t i = 0; i <= divisions; ++i)
            cut.lines[axis].push_back(snap_to_grid(static_cast<float>(first + (last - first) * i / divisions)));
    }
    return cut;
}

} // namespace tetrace::test
