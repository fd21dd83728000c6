#pragma once

#include "backends/embree/backend.h"

#include <algorithm>
#include <cstddef>

namespace tetrace::test {

/// The rows that Embree has for a scene.
[[nodiscard]] inline std::size_t embree_rows()
{
    return static_cast<std::size_t>(
        std::ranges::count_if(all_kernels(), [](const KernelId& kernel) { return is_embree(kernel.layout); }));
}

/// Those of them that its version can trace on this processor.
[[nodiscard]] inline std::size_t traced_embree_rows()
{
    return static_cast<std::size_t>(std::ranges::count_if(all_kernels(), [](const KernelId& kernel) {
        return is_embree(kernel.layout) && embree_backend().why_not(0, kernel).empty();
    }));
}

} // namespace tetrace::test
