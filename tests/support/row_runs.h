#pragma once

#include "bench/rows/row_run.h"
#include "scenes/load.h"
#include "scenes/procedural.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace tetrace::test {

/// `cubes`, as load_scene() would give them.
[[nodiscard]] inline LoadedScene loaded_cubes(std::uint32_t resolution = 3)
{
    LoadedScene loaded;
    loaded.scene = make_cubes(resolution);
    loaded.scene.name = "cubes";
    return loaded;
}

template <class... Rows>
[[nodiscard]] std::vector<RowRecord> list(Rows... rows)
{
    return {std::move(rows)...};
}

} // namespace tetrace::test
