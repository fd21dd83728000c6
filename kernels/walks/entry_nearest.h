// The boundary face by which a ray enters the domain, for walks by half-faces.
#ifndef TETRACE_KERNELS_WALKS_ENTRY_NEAREST_H
#define TETRACE_KERNELS_WALKS_ENTRY_NEAREST_H

#include "kernels/walks/entry_half_faces.h"

// The position of the domain's line `index` along `axis`.
KERNEL_FN real domain_line(SceneView scene, uint axis, uint index)
{
    return as_real(FETCH(scene, lines, axis * (scene.divisions + 1u) + index));
}

KERNEL_FN bool is_beyond_line(SceneView scene, SideCrossing at, uint index)
{
    PRECISE real product = (domain_line(scene, at.axis, index) - at.origin) * at.slope;
    return product <= at.reach;
}

// The last line that the ray is past; that is the number of its column or row.
KERNEL_FN uint line_passed(SceneView scene, SideCrossing at)
{
    uint first = 0u; // the line is one of `count` lines from here on
    for (uint count = scene.divisions; count > 1u; count -= count >> 1u)
        first += is_beyond_line(scene, at, first + (count >> 1u)) ? count >> 1u : 0u;
    return first;
}

// The square of the box by which the ray enters, or 6 divisions^2 if it misses the box.
KERNEL_FN uint entry_square(SceneView scene, Ray ray)
{
    Entry entry = entry_of(scene.domain, ray);
    if (entry.side == 6u) return 6u * scene.divisions * scene.divisions;
    return square_at(scene, entry, line_passed(scene, entry.a), line_passed(scene, entry.b));
}

// The number of the first of the square's faces that the ray is inside; if it is inside none, of the nearest one;
// NO_ENTRY if the ray misses the domain.
KERNEL_FN uint entry_index(SceneView scene, Ray ray)
{
    uint square = entry_square(scene, ray);
    if (square == 6u * scene.divisions * scene.divisions) return NO_ENTRY;
    uint last = FETCH(scene, entry_ranges, square + 1u);
    uint best = FETCH(scene, entry_ranges, square);
    real depth = depth_in(entry_face(scene, best), ray);
    for (uint index = best + 1u; index < last && depth < real(0.0f); ++index) {
        real candidate = depth_in(entry_face(scene, index), ray);
        best = candidate > depth ? index : best;
        depth = candidate > depth ? candidate : depth;
    }
    return best;
}

#endif
