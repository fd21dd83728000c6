// From outside: where a ray meets the domain's box, and the boundary face that it enters by.
// Only products are compared, never a quotient: position <= line is |direction| (line - origin) <= |gap| direction_a,
// whose left side is monotone in the line, so that the squares of one side never contradict each other.

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

// How deep the ray is inside a boundary face: the smallest of its three side products, negative outside. They are the
// method's own, so that no walk begins by a face that its method would not have left by.
KERNEL_FN real depth_in_face(SceneView scene, uint link, Ray ray)
{
    uint tet = link >> 2u;
    uint face = link & 3u;
    Vec3 a = vertex(scene, tet, corner(face, 0u));
    Vec3 b = vertex(scene, tet, corner(face, 1u));
    Vec3 c = vertex(scene, tet, corner(face, 2u));
    real ab = side_at_entry(ray, a, b);
    real bc = side_at_entry(ray, b, c);
    real ca = side_at_entry(ray, c, a);
    real least = ab < bc ? ab : bc;
    return ca < least ? ca : least;
}

// The first of all boundary faces that the ray enters by, or NO_LINK.
KERNEL_FN uint entry_anywhere(SceneView scene, Ray ray)
{
    uint last = FETCH(scene, entry_ranges, 6u * scene.divisions * scene.divisions);
    uint found = NO_LINK;
    for (uint index = 0u; index < last && found == NO_LINK; index++) {
        uint link = FETCH(scene, entry_links, index);
        found = depth_in_face(scene, link, ray) < real(0.0f) ? NO_LINK : link;
    }
    return found;
}

// The boundary face that the ray enters by, as a link, or NO_LINK where it misses the domain. Where it is inside none
// of the square's faces, most methods begin by the nearest; one that walks paths begins by its end or not at all.
KERNEL_FN uint entry_link(SceneView scene, Ray ray)
{
    uint square = entry_square(scene, ray);
    if (square == 6u * scene.divisions * scene.divisions) return NO_LINK;
    uint last = FETCH(scene, entry_ranges, square + 1u);
    uint index = FETCH(scene, entry_ranges, square);
    uint best = FETCH(scene, entry_links, index);
    real depth = depth_in_face(scene, best, ray);
    for (index++; index < last && depth < real(0.0f); index++) {
        uint link = FETCH(scene, entry_links, index);
        real candidate = depth_in_face(scene, link, ray);
        best = candidate > depth ? link : best;
        depth = candidate > depth ? candidate : depth;
    }
#ifdef WALKS_PATHS
    if (depth < real(0.0f)) return entry_anywhere(scene, ray);
#endif
    return best;
}
