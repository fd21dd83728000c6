#pragma once

#include "core/pack/kernel_id.h"

#include <cstdint>
#include <string_view>
#include <type_traits>
#include <variant>

namespace tetrace {

struct Bvh;
struct PackedScene;
struct TetMesh;
struct TriangleMesh;

/// The properties of a method, from its row in kernels/kernel_list.inc.
struct MethodTraits {
    std::string_view name;
    int year;        ///< of its first source; 0 for BVHs
    double vertices; ///< that a step loads, on average
};
[[nodiscard]] const MethodTraits& traits_of(Method method);

/// Layouts of a family share their arrays and their walk. foreign: not ours, see FOREIGN_LAYOUT of the list.
enum class Family { cdt, compact, bvh, foreign };

/// Fills `tets` of a packed scene, and the arrays of its family, from tets in packed order.
/// packed: its layout, triangles, lines and entry half-faces are set. mesh: the scene's tets in packed order, with
/// half-faces in that numbering.
using PackTets = void(PackedScene& packed, const TetMesh& mesh);
/// Packs a BVH of the mesh: nodes and leaf triangles.
using PackBvh = PackedScene(const TriangleMesh& mesh, const Bvh& bvh);

// pack_<layout>() of each layout of ours, in pack_<layout>.cpp.
#define LAYOUT(name, family, ...) std::conditional_t<Family::family == Family::bvh, PackBvh, PackTets> pack_##name;
#include "kernels/kernel_list.inc"

/// The properties of a layout, from its row in kernels/kernel_list.inc.
struct LayoutTraits {
    std::string_view name;
    Family family;
    std::uint32_t most;  ///< tets, or references of a BVH's leaves to triangles
    double vertex_bytes; ///< that a step loads for each vertex that its method asks for
    double step_bytes;   ///< of its tet that a step loads in addition
    std::variant<std::monostate, PackTets*, PackBvh*> pack;
};
[[nodiscard]] const LayoutTraits& traits_of(Layout layout);

} // namespace tetrace
