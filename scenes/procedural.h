#pragma once

#include "core/mesh/scene.h"

#include <cstdint>
#include <string>

namespace tetrace {

/// The conformance scene that needs no TetGen: a jittered grid of resolution^3 cubes, each cut into six tets, filling
/// its domain; the faces between cubes inside and outside a ball are occlusive. Reproducible bit for bit.
/// resolution: 2 to 128 cubes along an axis, else throws Error{usage}. The domain's divisions equal it. The ball's
/// surface is closed from 3 on; at 2 it is that of one corner cube, open towards the domain's boundary.
[[nodiscard]] Scene make_cubes(std::uint32_t resolution);

/// A scene of any size: the same grid of resolution^3 cubes, of which some are solid, scattered so that a line through
/// the grid meets one after half its length on average. 6 resolution^3 tets, so that packed forms exceed any cache;
/// made in linear time and memory, reproducible bit for bit. resolution: min_lattice to max_lattice
/// (scenes/catalogue.h), else throws Error{usage}. Throws Error{unsupported} with both numbers if the tets by
/// themselves exceed the machine's memory.
[[nodiscard]] Scene make_lattice(std::uint32_t resolution);

/// A curved, tapering, capped tube in mesh units: 25,000 triangles, closed, the same bits everywhere. Its CDT with the
/// default switches keeps them whole and has about 71,000 tets, the size of the paper's smallest scene (Table 3's
/// banana).
[[nodiscard]] TriangleMesh make_banana();

/// The same tube in about `triangles` triangles of similar size. Rings of equal numbers of vertices would have needles
/// at the tips, too thin for floats in fine meshes.
[[nodiscard]] TriangleMesh make_banana(std::uint32_t triangles);

/// Meshes in about `triangles` triangles, in mesh units, the same bits everywhere; find_procedural()
/// (scenes/catalogue.h) has the range of sizes. Their boxes and what is in them are the same at every size, so that
/// their cameras fit.

/// A court with arcades of fan vaults, walls with windows, a stair, railings and a statue; mostly open surfaces.
[[nodiscard]] TriangleMesh make_atrium(std::uint32_t triangles);
/// Blocks of houses with rooms, doors and windows, and a detailed object in the middle, 1/120 as wide as the city.
[[nodiscard]] TriangleMesh make_city(std::uint32_t triangles);
/// A fractal height field, open.
[[nodiscard]] TriangleMesh make_terrain(std::uint32_t triangles);
/// 1,000 spheres far apart, closed, with radii of 1 to 100.
[[nodiscard]] TriangleMesh make_spheres(std::uint32_t triangles);
/// Thin blades, three triangles each, close above a floor.
[[nodiscard]] TriangleMesh make_grass(std::uint32_t triangles);
/// A stem and 120 thin, open leaves that cross it and each other. Only this mesh intersects itself.
[[nodiscard]] TriangleMesh make_plant(std::uint32_t triangles);
/// Three spheres with one centre in a cube; closed surfaces, so that the tets between two of them are a region.
[[nodiscard]] TriangleMesh make_nested(std::uint32_t triangles);

/// Points in place of a mesh, as the text of TetGen's .node, the same everywhere: the corners of a cube and random
/// points in it, half of them in blobs of density. Each has a region, by its density: 0 to 3. The builder makes their
/// Delaunay tets.
[[nodiscard]] std::string make_field(std::uint32_t points);

} // namespace tetrace
