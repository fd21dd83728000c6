// The boundary face by which a ray's path enters the domain. For walks along paths, which begin only at the end of a
// path.

// For a build that counts how often a path is searched from its beginning: 0 entry_anywhere(), 1 exit_ahead(), 2 a ray
// that goes on beyond the face that it starts on. That build is never timed.
#ifndef COUNT_SEARCH
#define COUNT_SEARCH(where)
#endif

// The vertex at which a product with `factors` is the smallest (or, with them negated, the largest) of all that lie in
// a box: rounding is monotone, so no vertex in the box has a smaller one.
KERNEL_FN Vec3 least_corner(DomainBox box, Vec3 factors)
{
    return VEC3(factors.x < real(0.0f) ? box.high.x : box.low.x, factors.y < real(0.0f) ? box.high.y : box.low.y,
                factors.z < real(0.0f) ? box.high.z : box.low.z);
}

// Whether the ray sees all vertices in a box on one side of a line through it: it then enters by no face with such
// vertices (docs/spec/project.md, P10).
KERNEL_FN bool sees_on_one_side(DomainBox box, Ray ray, Vec3 factors)
{
    Vec3 negated = VEC3(-factors.x, -factors.y, -factors.z);
    return dot3(sub3(least_corner(box, factors), ray.origin), factors) > real(0.0f) ||
           dot3(sub3(least_corner(box, negated), ray.origin), factors) < real(0.0f);
}

// The box of `size` squares from this one on: one square, a row of them (divisions), or a side (divisions^2).
KERNEL_FN DomainBox squares_box(SceneView scene, uint square, uint size)
{
    uint n = scene.divisions;
    uint side = square / (n * n);
    uint across = side >> 1u;
    uint j = square / n % n;
    uint i = square % n;
    real plane = domain_line(scene, across, (side & 1u) == 1u ? n : 0u);
    real low_1 = domain_line(scene, first_axis(across), i);
    real high_1 = domain_line(scene, first_axis(across), size >= n ? n : i + 1u);
    real low_2 = domain_line(scene, second_axis(across), j);
    real high_2 = domain_line(scene, second_axis(across), size == n * n ? n : j + 1u);
    DomainBox box;
    box.low = across == 0u   ? VEC3(plane, low_1, low_2)
              : across == 1u ? VEC3(low_2, plane, low_1)
                             : VEC3(low_1, low_2, plane);
    box.high = across == 0u   ? VEC3(plane, high_1, high_2)
               : across == 1u ? VEC3(high_2, plane, high_1)
                              : VEC3(high_1, high_2, plane);
    return box;
}

// The number of the first boundary face by which the ray enters, or NO_ENTRY. Faces first to last - 1, those of the
// square, are tested first. The others are passed over by sides, rows and squares where the ray enters by none of them:
// a GPU would wait for the one ray that tests them all.
KERNEL_FN uint entry_anywhere(SceneView scene, Ray ray, uint first, uint last)
{
    COUNT_SEARCH(0);
    Shear shear = shear_of(ray);
    uint n = scene.divisions;
    uint square = 0u;
    uint size = n * n;
    uint index = first;
    uint behind = last;
    uint found = NO_ENTRY;
    while (found == NO_ENTRY && (index < behind || square < 6u * n * n)) {
        if (index < behind) {
            found = depth_in(entry_face(scene, index), ray) < real(0.0f) ? NO_ENTRY : index;
            ++index;
        } else {
            DomainBox box = squares_box(scene, square, size);
            bool passed = sees_on_one_side(box, ray, shear.across) || sees_on_one_side(box, ray, shear.upwards);
            bool opened = !passed && size == 1u;
            index = opened ? FETCH(scene, entry_ranges, square) : index;
            behind = opened ? FETCH(scene, entry_ranges, square + 1u) : behind;
            square += passed || opened ? size : 0u;
            uint largest = square % (n * n) == 0u ? n * n : square % n == 0u ? n : 1u;
            size = passed || opened ? largest : size == n * n ? n : 1u;
        }
    }
    return found;
}

// The number of the boundary face by which the ray enters, or NO_ENTRY where it misses the domain. Float products
// decide nearly all cases. Ties are decided after the loop, since some devices execute a conditional block even if no
// lane needs it.
KERNEL_FN uint entry_index(SceneView scene, Ray ray)
{
    uint square = entry_square(scene, ray);
    if (square == 6u * scene.divisions * scene.divisions) return NO_ENTRY;
    uint first = FETCH(scene, entry_ranges, square);
    uint last = FETCH(scene, entry_ranges, square + 1u);
    Shear shear = shear_of(ray);
    uint found = NO_ENTRY;
    for (uint index = first;; ++index) {
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
