// Method plucker64: exit face by Pluecker products in double, with a tolerance, as XDG walks through elements.
// Sources: Platis and Theoharis, "Fast Ray-Tetrahedron Intersection Using Pluecker Coordinates", Journal of Graphics
// Tools 8(4), 2003. The rule, not the text, is that of XDG (https://github.com/xdg-org/xdg, e1d57e17:
// plucker_ray_tri_intersect() and next_element()), which has the test from DAGMC: products below the tolerance are 0,
// the ray does not meet a face all of whose products are 0, and leaves by the nearest face of those that it meets.
// docs/spec/methods.md, M11, has what differs.
#ifndef TETRACE_KERNELS_METHODS_PLUCKER64_H
#define TETRACE_KERNELS_METHODS_PLUCKER64_H

#define FINDS_NO_EXIT

#include "kernels/layouts/faces.h"
#include "kernels/methods/doubles.h"
#include "kernels/methods/edge_sides.h"

#define ZERO_PRODUCT 4.440892098500626e-15 // 20 * 2^-52

STRUCT(Line64)
{
    Double3 origin;
    Double3 direction;
    Double3 moment;
};

KERNEL_FN Line64 line64_of(Ray ray)
{
    Double3 origin = in_double(ray.origin);
    Double3 direction = in_double(ray.direction);
    return {origin, direction, cross_of(origin, direction)};
}

// Exactly the opposite if the edge's ends change places, so its two tets agree.
KERNEL_FN double edge_product64(Line64 line, Double3 from, Double3 to)
{
    double product = dot_of(line.moment, to - from) + dot_of(line.direction, cross_of(from, to));
    return std::fabs(product) < ZERO_PRODUCT ? 0.0 : product;
}

KERNEL_FN double component64(Double3 a, uint axis)
{
    return axis == 0u ? a.x : axis == 1u ? a.y : a.z;
}

// How far along the line its point with these weights is, by the axis along which the direction is largest.
KERNEL_FN double distance64(Line64 line, Double3 weighted, double sum)
{
    Double3 d = line.direction;
    uint axis = std::fabs(d.x) >= std::fabs(d.y) ? 0u : 1u;
    axis = std::fabs(d.z) > std::fabs(component64(d, axis)) ? 2u : axis;
    double along = component64(weighted, axis) / sum - component64(line.origin, axis);
    double distance = along / component64(d, axis);
    return distance > 0.0 ? distance : 0.0;
}

STRUCT(Nearest64)
{
    uint face;
    double distance;
};

// a, b: two corners of the face, in the order in which its tet's entry face has them. of_a, of_b: products of the edges
// across from them, not negative where the line leaves by the face.
KERNEL_FN Nearest64 nearer64(Line64 line, Nearest64 nearest, uint face, Double3 apex, Double3 a, Double3 b, double of_a,
                             double of_b)
{
    if (of_a < 0.0 || of_b < 0.0) return nearest;
    double of_apex = edge_product64(line, a, b);
    double sum = of_a + of_b + of_apex;
    if (of_apex < 0.0 || sum == 0.0) return nearest;
    double distance = distance64(line, of_apex * apex + of_a * a + of_b * b, sum);
    if (nearest.face != NO_EXIT && distance >= nearest.distance) return nearest;
    return {face, distance};
}

KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Line64 line = line64_of(ray);
    Double3 apex = in_double(vertex(scene, tet, entry));
    Double3 c0 = in_double(vertex(scene, tet, corner(entry, 0u)));
    Double3 c1 = in_double(vertex(scene, tet, corner(entry, 1u)));
    Double3 c2 = in_double(vertex(scene, tet, corner(entry, 2u)));
    double s0 = edge_product64(line, c0, apex);
    double s1 = edge_product64(line, c1, apex);
    double s2 = edge_product64(line, c2, apex);
    Nearest64 nearest = {NO_EXIT, 0.0};
    nearest = nearer64(line, nearest, corner(entry, 2u), apex, c0, c1, s1, -s0);
    nearest = nearer64(line, nearest, corner(entry, 0u), apex, c1, c2, s2, -s1);
    nearest = nearer64(line, nearest, corner(entry, 1u), apex, c2, c0, s0, -s2);
    return nearest.face;
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return start_face_by_edges(scene, tet, ray);
}

KERNEL_FN real side_at_entry(Ray ray, Vec3 from, Vec3 to)
{
    return static_cast<real>(edge_product64(line64_of(ray), in_double(from), in_double(to)));
}

#endif
