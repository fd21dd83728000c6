// From outside: where a ray meets the domain's box, and the boundary face that it enters by.
// Only products are compared, never a quotient: position <= line is |direction| (line - origin) <= |gap| direction_a,
// whose left side is monotone in the line, so that the squares of one side never contradict each other.
// What includes this brings EntryFace, the corners of a boundary face, and entry_face(scene, index).
#define NO_ENTRY 0xFFFFFFFFu

// For a build that counts how often a path is sought from its beginning: 0 entry_anywhere(), 1 exit_ahead(), 2 a ray
// that goes on beyond the face that it starts on; it is never a timed one.
#ifndef COUNT_SEARCH
#define COUNT_SEARCH(where)
#endif

// Index of the domain's line `index` along `axis`.
KERNEL_FN real domain_line(SceneView scene, uint axis, uint index)
{
    return as_real(FETCH(scene, lines, axis * (scene.divisions + 1u) + index));
}

// The interval of lines along `axis` that holds the ray's position on a side of the box; `divisions` where it is off
// the side. On the side's border the ray must be moving inwards: one that only grazes the box, in the plane of a side,
// has missed it.
KERNEL_FN uint line_interval(SceneView scene, uint axis, real origin, real direction, real slope, real reach)
{
    uint low = 0u;
    uint high = scene.divisions;
    PRECISE real first = (domain_line(scene, axis, low) - origin) * slope;
    PRECISE real last = (domain_line(scene, axis, high) - origin) * slope;
    if (first > reach || last < reach) return scene.divisions;
    if (first == reach && direction <= real(0.0f)) return scene.divisions;
    if (last == reach && direction >= real(0.0f)) return scene.divisions;
    while (high - low > 1u) {
        uint middle = (low + high) >> 1u;
        PRECISE real product = (domain_line(scene, axis, middle) - origin) * slope;
        bool below = product <= reach;
        low = below ? middle : low;
        high = below ? high : middle;
    }
    return low;
}

// The square of the box that the ray enters by, or 6 divisions^2 where it misses the box. The origin is not inside.
KERNEL_FN uint entry_square(SceneView scene, Ray ray)
{
    uint n = scene.divisions;
    uint square = 6u * n * n;
    for (uint axis = 0u; axis < 3u; axis++) {
        uint axis_a = axis == 2u ? 0u : axis + 1u;
        uint axis_b = axis == 0u ? 2u : axis - 1u;
        real direction = component(ray.direction, axis);
        bool from_high = direction < real(0.0f);
        real plane = domain_line(scene, axis, from_high ? n : 0u);
        PRECISE real gap = plane - component(ray.origin, axis);
        bool ahead = from_high ? gap < real(0.0f) : (direction > real(0.0f) && gap > real(0.0f));
        if (!ahead) continue;
        real slope = magnitude(direction);
        real direction_a = component(ray.direction, axis_a);
        real direction_b = component(ray.direction, axis_b);
        PRECISE real reach_a = magnitude(gap) * direction_a;
        PRECISE real reach_b = magnitude(gap) * direction_b;
        uint i = line_interval(scene, axis_a, component(ray.origin, axis_a), direction_a, slope, reach_a);
        uint j = line_interval(scene, axis_b, component(ray.origin, axis_b), direction_b, slope, reach_b);
        if (i < n && j < n) square = ((2u * axis + (from_high ? 1u : 0u)) * n + j) * n + i;
    }
    return square;
}

// How deep the ray is inside the boundary face `index` of the list: the smallest of its three side products, negative
// outside. They are the method's own, so that no walk begins by a face that its method would not have left by.
KERNEL_FN real depth_in_face(SceneView scene, uint index, Ray ray)
{
    EntryFace face = entry_face(scene, index);
    real ab = side_at_entry(ray, face.a, face.b);
    real bc = side_at_entry(ray, face.b, face.c);
    real ca = side_at_entry(ray, face.c, face.a);
    real least = ab < bc ? ab : bc;
    return ca < least ? ca : least;
}

#ifdef WALKS_PATHS
// The first boundary face that the ray enters by, of the square's, from first to last - 1, then of all: as its number
// in their list, or NO_ENTRY.
KERNEL_FN uint entry_anywhere(SceneView scene, Ray ray, uint first, uint last)
{
    COUNT_SEARCH(0);
    uint in_square = last - first;
    uint faces = in_square + FETCH(scene, entry_ranges, 6u * scene.divisions * scene.divisions);
    uint found = NO_ENTRY;
    for (uint i = 0u; i < faces && found == NO_ENTRY; i++) {
        uint index = i < in_square ? first + i : i - in_square;
        found = depth_in_face(scene, index, ray) < real(0.0f) ? NO_ENTRY : index;
    }
    return found;
}

// The boundary face that the ray enters by, as its number, or NO_ENTRY where it misses the domain. A walk along paths
// begins by a path's end or not at all. Float products settle nearly all; ties are decided behind the loop, since some
// devices execute what is behind a condition whether a lane meets it or not.
KERNEL_FN uint entry_index(SceneView scene, Ray ray)
{
    uint square = entry_square(scene, ray);
    if (square == 6u * scene.divisions * scene.divisions) return NO_ENTRY;
    uint first = FETCH(scene, entry_ranges, square);
    uint last = FETCH(scene, entry_ranges, square + 1u);
    uint found = NO_ENTRY;
    bool is_tie = false;
    for (uint index = first; index < last && found == NO_ENTRY && !is_tie; index++) {
        EntryFace face = entry_face(scene, index);
        uint held = roughly_held(ray, face.a, face.b, face.c);
        is_tie = held == HELD_OR_TIE;
        found = held == HELD ? index : NO_ENTRY;
    }
    if (found == NO_ENTRY) return entry_anywhere(scene, ray, first, last);
    return found;
}
#else
// The boundary face that the ray enters by, as its number, or NO_ENTRY where it misses the domain; the nearest where it
// is inside none of the square's faces.
KERNEL_FN uint entry_index(SceneView scene, Ray ray)
{
    uint square = entry_square(scene, ray);
    if (square == 6u * scene.divisions * scene.divisions) return NO_ENTRY;
    uint last = FETCH(scene, entry_ranges, square + 1u);
    uint best = FETCH(scene, entry_ranges, square);
    real depth = depth_in_face(scene, best, ray);
    for (uint index = best + 1u; index < last && depth < real(0.0f); index++) {
        real candidate = depth_in_face(scene, index, ray);
        best = candidate > depth ? index : best;
        depth = candidate > depth ? candidate : depth;
    }
    return best;
}
#endif
