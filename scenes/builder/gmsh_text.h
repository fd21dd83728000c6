#pragma once

#include "scenes/builder/mesh_source.h"

#include <string>

namespace tetrace {

/// The nodes, elements and entities of a binary .msh file, as its ASCII form has them; empty if the file is not binary.
/// Throws Error{invalid_input} if it is cut short, or its bytes are in another order.
[[nodiscard]] std::string gmsh_text(const MeshSource& source);

} // namespace tetrace
