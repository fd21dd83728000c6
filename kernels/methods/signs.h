// The signs of method project: vertices projected across the ray, and the side of the ray at an edge between two of
// them, which is never wrong and never undecided (docs/spec/project.md, P2 and P3). For walks that read corners from
// tets (project.h) and for walks that carry them.
#ifndef TETRACE_KERNELS_METHODS_SIGNS_H
#define TETRACE_KERNELS_METHODS_SIGNS_H

#include "kernels/ray.h"
#include "kernels/shear.h"

// For a build that counts which level decides a sign: 0 float products, 1 what they lost, 2 the rule for ties;
// that build is never timed.
#ifndef COUNT_SIGN
#define COUNT_SIGN(level)
#endif

// The order that decides ties compares the vertices' positions.
STRUCT(Projected)
{
    Vec3 position;
    Sheared seen;
};

// The shear with its plane oriented so that sides have the same sign as in space.
KERNEL_FN Shear shear_of(Ray ray)
{
    Shear shear = shear_along(ray.direction);
    if (component(ray.direction, deepest_axis(ray.direction)) > real(0.0f)) return shear;
    Shear turned;
    turned.across = shear.upwards;
    turned.upwards = shear.across;
    return turned;
}

KERNEL_FN Projected projected(Ray ray, Shear shear, Vec3 position)
{
    Projected result;
    result.position = position;
    result.seen = sheared(shear, sub3(position, ray.origin));
    return result;
}

// Lexicographic: a total order, since distinct vertices differ in a coordinate.
KERNEL_FN bool is_before(Vec3 a, Vec3 b)
{
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

// Whether p x q, which is zero, becomes positive when both vertices are moved by infinitesimals; p is the earlier
// vertex.
KERNEL_FN bool is_left_when_perturbed(Sheared p, Sheared q)
{
    real zero = real(0.0f);
    if (q.y != zero) return q.y > zero;
    if (q.x != zero) return q.x < zero;
    if (p.y != zero) return p.y < zero;
    return p.x > zero;
}

// Whether p x q is positive, if both of its products are rounded to `product`. p_is_first: in the order of vertices.
KERNEL_FN bool is_left_at_tie(Sheared p, Sheared q, bool p_is_first, real product)
{
    real plus = lost_by(p.x, q.y, product);
    real minus = lost_by(p.y, q.x, product);
    if (plus != minus) {
        COUNT_SIGN(1);
        return plus > minus;
    }
    COUNT_SIGN(2);
    return p_is_first ? is_left_when_perturbed(p, q) : !is_left_when_perturbed(q, p);
}

// A test replaces the rule for ties, to show that the rule is needed.
#ifndef SIDE_AT_TIE
#define SIDE_AT_TIE(p, q, p_is_first, product) is_left_at_tie(p, q, p_is_first, product)
#endif

// Whether the ray's side at the edge from p to q is positive; else it is negative. Rounding is monotone: products that
// differ after rounding differed in the same sense before.
KERNEL_FN bool is_left(Projected p, Projected q)
{
    PRECISE real plus = p.seen.x * q.seen.y;
    PRECISE real minus = p.seen.y * q.seen.x;
    if (plus == minus) return SIDE_AT_TIE(p.seen, q.seen, is_before(p.position, q.position), plus);
    COUNT_SIGN(0);
    return plus > minus;
}

// The same for the edge from a vertex of the face that a walk enters a tet by to the tet's apex. Where only the order
// of these two could decide, both answers lead to the same exit (docs/spec/project.md, P16), so it is not asked for.
KERNEL_FN bool is_apex_left(Sheared p, Sheared apex)
{
    PRECISE real plus = p.x * apex.y;
    PRECISE real minus = p.y * apex.x;
    if (plus == minus) return SIDE_AT_TIE(p, apex, true, plus);
    COUNT_SIGN(0);
    return plus > minus;
}

// Whether a ray enters by a face with these corners, in the order of faces.h, as far as float products tell.
#define HELD 0u
#define NOT_HELD 1u
#define HELD_OR_TIE 2u
KERNEL_FN uint roughly_held(Sheared p0, Sheared p1, Sheared p2)
{
    PRECISE real plus_01 = p0.x * p1.y;
    PRECISE real minus_01 = p0.y * p1.x;
    PRECISE real plus_12 = p1.x * p2.y;
    PRECISE real minus_12 = p1.y * p2.x;
    PRECISE real plus_20 = p2.x * p0.y;
    PRECISE real minus_20 = p2.y * p0.x;
    bool is_outside = plus_01 < minus_01 || plus_12 < minus_12 || plus_20 < minus_20;
    bool is_inside = plus_01 > minus_01 && plus_12 > minus_12 && plus_20 > minus_20;
    return is_outside ? NOT_HELD : is_inside ? HELD : HELD_OR_TIE;
}

// The face of a tet all of whose edges have the ray on their negative side; NO_EXIT if the ray crosses no face.
KERNEL_FN uint face_left_by(Ray ray, Vec3 a, Vec3 b, Vec3 c, Vec3 d)
{
    Shear shear = shear_of(ray);
    Projected v0 = projected(ray, shear, a);
    Projected v1 = projected(ray, shear, b);
    Projected v2 = projected(ray, shear, c);
    Projected v3 = projected(ray, shear, d);
    bool s01 = is_left(v0, v1);
    bool s02 = is_left(v0, v2);
    bool s03 = is_left(v0, v3);
    bool s12 = is_left(v1, v2);
    bool s13 = is_left(v1, v3);
    bool s23 = is_left(v2, v3);
    if (!s12 && !s23 && s13) return 0u;
    if (!s03 && s23 && s02) return 1u;
    if (!s01 && !s13 && s03) return 2u;
    return !s02 && s12 && s01 ? 3u : NO_EXIT;
}

KERNEL_FN real side_at_entry(Ray ray, Vec3 from, Vec3 to)
{
    Shear shear = shear_of(ray);
    bool left = is_left(projected(ray, shear, from), projected(ray, shear, to));
    return left ? real(1.0f) : real(-1.0f);
}

// Whether the ray crosses a face in front of its origin, for a face that holds the ray. The depths of the vertices are
// weighted by the sides, as in nearer_triangle() of bvh.h, and equally where the face is seen edge-on. The sum is in
// the order of the vertices, so rounding does not depend on the order of the corners.
KERNEL_FN bool is_face_ahead(Ray ray, Vec3 a, Vec3 b, Vec3 c)
{
    bool ab = is_before(a, b);
    Vec3 low = ab ? a : b;
    Vec3 high = ab ? b : a;
    bool is_lowest = is_before(c, low);
    bool is_highest = is_before(high, c);
    Shear shear = shear_of(ray);
    Vec3 v0 = sub3(is_lowest ? c : low, ray.origin);
    Vec3 v1 = sub3(is_lowest ? low : (is_highest ? high : c), ray.origin);
    Vec3 v2 = sub3(is_highest ? c : high, ray.origin);
    uint axis = deepest_axis(ray.direction);
    bool is_towards = component(ray.direction, axis) > real(0.0f);
    real along = is_towards ? real(1099511627776.0f) : real(-1099511627776.0f); // 2^40: no product below is denormal
    PRECISE real depth_0 = component(v0, axis) * along;
    PRECISE real depth_1 = component(v1, axis) * along;
    PRECISE real depth_2 = component(v2, axis) * along;
    Sheared p0 = sheared(shear, v0);
    Sheared p1 = sheared(shear, v1);
    Sheared p2 = sheared(shear, v2);
    real u = fine_side(p1, p2);
    real v = fine_side(p2, p0);
    real w = fine_side(p0, p1);
    PRECISE real determinant = u + v + w;
    bool is_edge_on = determinant == real(0.0f);
    u = is_edge_on ? real(1.0f) : u;
    v = is_edge_on ? real(1.0f) : v;
    w = is_edge_on ? real(1.0f) : w;
    PRECISE real weighted = u * depth_0 + v * depth_1 + w * depth_2;
    return determinant < real(0.0f) ? weighted < real(0.0f) : weighted > real(0.0f);
}

#endif
