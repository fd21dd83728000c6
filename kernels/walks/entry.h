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

STRUCT(DomainBox)
{
    Vec3 low;
    Vec3 high;
};

KERNEL_FN DomainBox domain_box(SceneView scene)
{
    uint n = scene.divisions;
    DomainBox box;
    box.low = VEC3(domain_line(scene, 0u, 0u), domain_line(scene, 1u, 0u), domain_line(scene, 2u, 0u));
    box.high = VEC3(domain_line(scene, 0u, n), domain_line(scene, 1u, n), domain_line(scene, 2u, n));
    return box;
}

// The axes of the sides across another one.
KERNEL_FN uint first_axis(uint across)
{
    return across == 2u ? 0u : across + 1u;
}

KERNEL_FN uint second_axis(uint across)
{
    return across == 0u ? 2u : across - 1u;
}

// How far the ray is from the plane of the side that it enters by if by one across this axis.
KERNEL_FN real gap_to_side(DomainBox box, Ray ray, uint across)
{
    bool from_high = component(ray.direction, across) < real(0.0f);
    PRECISE real gap = component(from_high ? box.high : box.low, across) - component(ray.origin, across);
    return gap;
}

// Where the ray meets that plane, along an axis: beyond a line where slope (line - origin) <= reach.
STRUCT(SideCrossing)
{
    uint axis;
    real origin;
    real direction;
    real slope;
    real reach;
};

KERNEL_FN SideCrossing side_crossing(DomainBox box, Ray ray, uint across, uint axis)
{
    SideCrossing at;
    at.axis = axis;
    at.origin = component(ray.origin, axis);
    at.direction = component(ray.direction, axis);
    at.slope = magnitude(component(ray.direction, across));
    PRECISE real reach = magnitude(gap_to_side(box, ray, across)) * at.direction;
    at.reach = reach;
    return at;
}

KERNEL_FN bool is_beyond_line(SceneView scene, SideCrossing at, uint index)
{
    PRECISE real product = (domain_line(scene, at.axis, index) - at.origin) * at.slope;
    return product <= at.reach;
}

// Whether the ray meets the plane between the side's borders. On a border it must be moving inwards: a ray that only
// grazes the box, in the plane of a side, has missed it.
KERNEL_FN bool is_on_side(DomainBox box, SideCrossing at)
{
    PRECISE real first = (component(box.low, at.axis) - at.origin) * at.slope;
    PRECISE real last = (component(box.high, at.axis) - at.origin) * at.slope;
    if (first > at.reach || last < at.reach) return false;
    if (first == at.reach && at.direction <= real(0.0f)) return false;
    return last != at.reach || at.direction < real(0.0f);
}

KERNEL_FN bool enters_across(DomainBox box, Ray ray, uint across)
{
    real direction = component(ray.direction, across);
    real gap = gap_to_side(box, ray, across);
    bool ahead = direction < real(0.0f) ? gap < real(0.0f) : (direction > real(0.0f) && gap > real(0.0f));
    return ahead && is_on_side(box, side_crossing(box, ray, across, first_axis(across))) &&
           is_on_side(box, side_crossing(box, ray, across, second_axis(across)));
}

// The square of the box that the ray enters by, or 6 divisions^2 where it misses the box. The origin is not inside.
KERNEL_FN uint entry_square(SceneView scene, Ray ray)
{
    uint n = scene.divisions;
    DomainBox box = domain_box(scene);
    uint across = 3u;
    for (uint axis = 0u; axis < 3u; axis++)
        across = enters_across(box, ray, axis) ? axis : across;
    if (across == 3u) return 6u * n * n;
    SideCrossing a = side_crossing(box, ray, across, first_axis(across));
    SideCrossing b = side_crossing(box, ray, across, second_axis(across));
    uint i = 0u; // the last line that the ray is beyond is one of so many from here on
    uint j = 0u;
    for (uint count = n; count > 1u; count -= count >> 1u) {
        uint middle = count >> 1u;
        i += is_beyond_line(scene, a, i + middle) ? middle : 0u;
        j += is_beyond_line(scene, b, j + middle) ? middle : 0u;
    }
    uint side = 2u * across + (component(ray.direction, across) < real(0.0f) ? 1u : 0u);
    return (side * n + j) * n + i;
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
    Shear shear = shear_of(ray);
    uint found = NO_ENTRY;
    for (uint index = first;; index++) {
        EntryFace face = entry_face(scene, index);
        uint held = roughly_held(ray, shear, face.a, face.b, face.c);
        if (held == HELD) {
            found = index;
            break;
        }
        if (held == HELD_OR_TIE || index + 1u == last) break;
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
