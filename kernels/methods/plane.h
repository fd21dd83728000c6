// Method plane: exit face by the nearest intersection with the planes of the faces by which the ray can leave. Sources:
// Garrity, "Raytracing Irregular Volume Data", Computer Graphics 24(5), 1990; Lagae and Dutre, "Accelerating Ray
// Tracing using Constrained Tetrahedralizations", EGSR 2008. Three planes per step, without the entry face's; four at
// the start.
#ifndef TETRACE_KERNELS_METHODS_PLANE_H
#define TETRACE_KERNELS_METHODS_PLANE_H

#define FINDS_NO_EXIT

#include KERNEL_LAYOUT_HEADER
#include "kernels/layouts/faces.h"
#include "kernels/methods/edge_sides.h"
#include "kernels/ray.h"

// A face's plane is met at distance / approach along the ray; approach is positive where the ray leaves the tet there.
STRUCT(PlaneCrossing)
{
    uint face;
    real distance;
    real approach;
};

// Larger than every denormal, and smaller than the rounding of any product of a tet's own size. Added to this, a
// denormal product that one device flushes and another keeps is rounded away.
#define CROSSING_DUST real(7.88860905e-31f) // 2^-100

// Quotients compared by products, since APIs divide differently. Approaches that are compared are positive; a face
// without a competitor is nearest.
KERNEL_FN PlaneCrossing nearer(PlaneCrossing nearest, PlaneCrossing next)
{
    if (next.approach <= real(0.0f)) return nearest;
    if (nearest.face == NO_EXIT) return next;
    PRECISE real own = next.distance * nearest.approach + CROSSING_DUST;
    PRECISE real other = nearest.distance * next.approach + CROSSING_DUST;
    if (own < other) return next;
    return nearest;
}

// The plane through `point` with the directions a and b; a x b points out of the tet. offset: from the ray's origin to
// the point.
KERNEL_FN PlaneCrossing crossing(Ray ray, uint face, Vec3 offset, Vec3 a, Vec3 b)
{
    Vec3 normal = cross3(a, b);
    PlaneCrossing found;
    found.face = face;
    found.distance = real(0.0f);
    found.approach = dot3(normal, ray.direction);
    if (found.approach > real(0.0f)) found.distance = dot3(normal, offset);
    return found;
}

KERNEL_FN PlaneCrossing no_crossing()
{
    PlaneCrossing none;
    none.face = NO_EXIT;
    none.distance = real(0.0f);
    none.approach = real(0.0f);
    return none;
}

// The apex is a point of all three planes, and two of the three edges that meet there span each.
KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Vec3 apex = vertex(scene, tet, entry);
    Vec3 e0 = sub3(vertex(scene, tet, corner(entry, 0u)), apex);
    Vec3 e1 = sub3(vertex(scene, tet, corner(entry, 1u)), apex);
    Vec3 e2 = sub3(vertex(scene, tet, corner(entry, 2u)), apex);
    Vec3 offset = sub3(apex, ray.origin);
    PlaneCrossing nearest = nearer(no_crossing(), crossing(ray, corner(entry, 2u), offset, e0, e1));
    nearest = nearer(nearest, crossing(ray, corner(entry, 0u), offset, e1, e2));
    nearest = nearer(nearest, crossing(ray, corner(entry, 1u), offset, e2, e0));
    return nearest.face;
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    PlaneCrossing nearest = no_crossing();
    for (uint face = 0u; face < 4u; ++face) {
        Vec3 c0 = vertex(scene, tet, corner(face, 0u));
        Vec3 a = sub3(vertex(scene, tet, corner(face, 2u)), c0);
        Vec3 b = sub3(vertex(scene, tet, corner(face, 1u)), c0);
        nearest = nearer(nearest, crossing(ray, face, sub3(c0, ray.origin), a, b));
    }
    return nearest.face;
}

KERNEL_FN real side_at_entry(Ray ray, Vec3 from, Vec3 to)
{
    return side_of_edge(ray, from, to);
}

#endif
