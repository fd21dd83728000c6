// Method project: exit face by the signs of two 2D cross products of projected vertices. A vertex has one position
// across the ray, whichever tet asks, and a sign is never wrong and never zero, so that no two tets disagree and no
// walk gets lost (SPEC.md, Method project). Sources: the walk, Aman, Demirci, Guedukbay, "Compact
// Tetrahedralization-Based Acceleration Structures for Ray Tracing", Journal of Visualization 25, 2022; the projection,
// see shear.h; ties, Edelsbrunner and Muecke, "Simulation of Simplicity", ACM Transactions on Graphics 9(1), 1990. 46
// operations a step: 3 for the shear, 13 a vertex (3 + 5 + 5), 2 a sign; a sign at a tie 32 more.
#define WALKS_PATHS

// For a build that counts which level decides a sign: 0 float products, 1 what they lost, 2 the order of the vertices;
// it is never a timed one.
#ifndef COUNT_SIGN
#define COUNT_SIGN(level)
#endif

#include "kernels/shear.h"

// The order that decides ties needs to know which vertex is where.
STRUCT(Projected)
{
    Vec3 position;
    Sheared seen;
};

// The shear with its plane turned so that sides have the sign that they have in space.
KERNEL_FN Shear shear_of(Ray ray)
{
    Shear shear = shear_along(ray.direction);
    if (component(ray.direction, deepest_axis(ray.direction)) > real(0.0f)) return shear;
    Shear turned;
    turned.across = shear.upwards;
    turned.upwards = shear.across;
    turned.along = shear.along;
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

// Whether p x q is positive, where it is zero and p is the earlier vertex: both moved by infinitesimals.
KERNEL_FN bool is_left_when_moved(Sheared p, Sheared q)
{
    real zero = real(0.0f);
    if (q.y != zero) return q.y > zero;
    if (q.x != zero) return q.x < zero;
    if (p.y != zero) return p.y < zero;
    return p.x > zero;
}

// Whether p x q is positive, where both of its products are rounded to `product`.
KERNEL_FN bool is_left_at_tie(Projected p, Projected q, real product)
{
    real plus = lost_by(p.seen.x, q.seen.y, product);
    real minus = lost_by(p.seen.y, q.seen.x, product);
    if (plus != minus) {
        COUNT_SIGN(1);
        return plus > minus;
    }
    COUNT_SIGN(2);
    if (is_before(p.position, q.position)) return is_left_when_moved(p.seen, q.seen);
    return !is_left_when_moved(q.seen, p.seen);
}

// A test replaces the rule for ties to see that it is needed.
#ifndef SIDE_AT_TIE
#define SIDE_AT_TIE(p, q, product) is_left_at_tie(p, q, product)
#endif

// Whether the ray's side at the edge from p to q is positive, else it is negative: what rounds to different products
// was as different before, since rounding is monotone.
KERNEL_FN bool is_left(Projected p, Projected q)
{
    PRECISE real plus = p.seen.x * q.seen.y;
    PRECISE real minus = p.seen.y * q.seen.x;
    if (plus == minus) return SIDE_AT_TIE(p, q, plus);
    COUNT_SIGN(0);
    return plus > minus;
}

// The two tests of maria: of the edges that end in the apex, that from c2, then that from c0 or c1.
KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Shear shear = shear_of(ray);
    Projected apex = projected(ray, shear, vertex(scene, tet, entry));
    bool left = is_left(projected(ray, shear, vertex(scene, tet, corner(entry, 2u))), apex);
    uint outcome = left ? 1u : 0u;
    left = is_left(projected(ray, shear, vertex(scene, tet, corner(entry, outcome))), apex);
    outcome += left ? 0u : 1u;
    return other_face(entry, outcome);
}

// The face whose edges all have the ray on their negative side; NO_EXIT where the ray crosses none.
KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    Shear shear = shear_of(ray);
    Projected v0 = projected(ray, shear, vertex(scene, tet, 0u));
    Projected v1 = projected(ray, shear, vertex(scene, tet, 1u));
    Projected v2 = projected(ray, shear, vertex(scene, tet, 2u));
    Projected v3 = projected(ray, shear, vertex(scene, tet, 3u));
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

// Whether the ray crosses a face that holds it in front of its origin: the depths of its vertices weighed by the sides,
// as in nearer_triangle() of bvh.h; all alike where it is seen from its edge.
KERNEL_FN bool is_ahead(SceneView scene, uint tet, uint face, Ray ray)
{
    Shear shear = shear_of(ray);
    Vec3 v0 = sub3(vertex(scene, tet, corner(face, 0u)), ray.origin);
    Vec3 v1 = sub3(vertex(scene, tet, corner(face, 1u)), ray.origin);
    Vec3 v2 = sub3(vertex(scene, tet, corner(face, 2u)), ray.origin);
    Sheared a = sheared(shear, v0);
    Sheared b = sheared(shear, v1);
    Sheared c = sheared(shear, v2);
    real u = fine_side(b, c);
    real v = fine_side(c, a);
    real w = fine_side(a, b);
    PRECISE real determinant = u + v + w;
    bool is_edge_on = determinant == real(0.0f);
    u = is_edge_on ? real(1.0f) : u;
    v = is_edge_on ? real(1.0f) : v;
    w = is_edge_on ? real(1.0f) : w;
    PRECISE real weighted = u * dot3(v0, shear.along) + v * dot3(v1, shear.along) + w * dot3(v2, shear.along);
    return determinant < real(0.0f) ? weighted < real(0.0f) : weighted > real(0.0f);
}
