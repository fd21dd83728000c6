#pragma once

#include <string_view>

namespace tetrace {

/// The exit codes of tetrace-builder. With them its parent distinguishes a bad mesh, a missing file and TetGen's
/// failures. The text of a failure is on stderr, in lines that begin with "error: ".
enum BuilderExit : int {
    BUILDER_GOOD = 0,
    BUILDER_USAGE = 2,              ///< an option or its value is not accepted; the text lists what is
    BUILDER_MISSING_FILE = 3,       ///< the mesh, or the folder of the output, is missing
    BUILDER_INTERNAL = 4,           ///< our own fault
    BUILDER_BAD_MESH = 5,           ///< a mesh that cannot be used: the text names file, element and remedy
    BUILDER_SELF_INTERSECTION = 10, ///< triangles cross or overlap; the text lists the first pairs
    BUILDER_TETGEN_REFUSED = 11,    ///< TetGen, or CGAL in its place, gave up
    BUILDER_ABSURD_OUTPUT = 12,     ///< the tets fail a check: asymmetric, inverted, flat, triangles missing
    BUILDER_OUT_OF_MEMORY = 13,     ///< an allocation failed
};

/// In the place of TetGen's switches: CGAL makes the tets.
inline constexpr std::string_view cgal_switches = "cgal";

/// Remedies: the builder prints them; its parent does where the builder was killed first.
inline constexpr std::string_view try_other_switches = "try other --switches (pq5YMT1e-13, pq5, p, pMT1e-13)";
inline constexpr std::string_view allow_more_memory = "allow more with tetrace's --memory-limit, or simplify the mesh";

} // namespace tetrace
