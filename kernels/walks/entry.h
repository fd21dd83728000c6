// For rays from outside: where a ray meets the domain's box, and the boundary face by which it enters.
// Only products are compared, never quotients: position <= line is |direction| (line - origin) <= |gap| direction_a.
// The left side is monotone in the line, so that the squares of one side never contradict each other.
// Include after this: entry_links.h or entry_faces.h (the boundary faces that squares and sides list), then
// entry_nearest.h or entry_on_path.h (by which of them a ray enters).
#define NO_ENTRY 0xFFFFFFFFu // instead of a boundary face's number
#define STARTS_IN_TETS       // rays of an image may also begin inside the domain

// The corners of a boundary face, in the order of faces.h.
STRUCT(EntryFace)
{
    Vec3 a;
    Vec3 b;
    Vec3 c;
};

// Place in the array of the domain's line `index` along `axis`.
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

// The two axes other than this one, in cyclic order.
KERNEL_FN uint first_axis(uint across)
{
    return across == 2u ? 0u : across + 1u;
}

KERNEL_FN uint second_axis(uint across)
{
    return across == 0u ? 2u : across - 1u;
}

// The distance from the ray's origin to the plane of the side across this axis by which the ray could enter.
KERNEL_FN real gap_to_side(DomainBox box, Ray ray, uint across)
{
    bool from_high = component(ray.direction, across) < real(0.0f);
    PRECISE real gap = component(from_high ? box.high : box.low, across) - component(ray.origin, across);
    return gap;
}

// Where the ray meets that plane, along an axis. It is beyond a line if slope (line - origin) <= reach.
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

// Whether the ray meets the plane between the side's borders. On a border it must be moving inwards: a ray that runs in
// the plane of a side (a grazing ray) misses the box.
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

// The square of the box by which the ray enters, or 6 divisions^2 where it misses the box. The origin is not inside.
KERNEL_FN uint entry_square(SceneView scene, Ray ray)
{
    uint n = scene.divisions;
    DomainBox box = domain_box(scene);
    uint across = 3u;
    for (uint axis = 0u; axis < 3u; ++axis)
        across = enters_across(box, ray, axis) ? axis : across;
    if (across == 3u) return 6u * n * n;
    SideCrossing a = side_crossing(box, ray, across, first_axis(across));
    SideCrossing b = side_crossing(box, ray, across, second_axis(across));
    uint i = 0u; // the last line that the ray is beyond is one of `count` lines from here on
    uint j = 0u;
    for (uint count = n; count > 1u; count -= count >> 1u) {
        uint middle = count >> 1u;
        i += is_beyond_line(scene, a, i + middle) ? middle : 0u;
        j += is_beyond_line(scene, b, j + middle) ? middle : 0u;
    }
    uint side = 2u * across + (component(ray.direction, across) < real(0.0f) ? 1u : 0u);
    return (side * n + j) * n + i;
}

// How deep the ray is inside a boundary face: the smallest of its three side products, negative outside. They are the
// method's own products, so that a walk never begins at a face by which its method would not have left.
KERNEL_FN real depth_in(EntryFace face, Ray ray)
{
    real ab = side_at_entry(ray, face.a, face.b);
    real bc = side_at_entry(ray, face.b, face.c);
    real ca = side_at_entry(ray, face.c, face.a);
    real least = ab < bc ? ab : bc;
    return ca < least ? ca : least;
}
