#pragma once

#include "scenes/builder/mesh_source.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// What is compressed in a buffer view of glTF's extension KHR_draco_mesh_compression.
struct DracoMesh {
    std::vector<Double3> positions;
    std::vector<std::array<std::size_t, 3>> triangles;
};

/// attribute: the positions' unique number. Throws as MeshSource::fail does if the data are damaged, and if this was
/// built without libdraco.
[[nodiscard]] DracoMesh read_draco(const MeshSource& source, std::string_view bytes, std::uint64_t attribute,
                                   const std::string& place);

} // namespace tetrace
