// kernels/: the kernels, one source for every language; here what all structures share. This file: a ray's hit.
#ifndef TETRACE_KERNELS_HIT_H
#define TETRACE_KERNELS_HIT_H

#include "kernels/ray.h"

// Whether a ray is in a triangle's plane to within rounding error: the determinant may be off by 7 * 2^-24 times the
// sum of its products' magnitudes; the limit is 16 * 2^-24 (docs/spec/numbers.md, N3).
KERNEL_FN bool is_seen_edge_on(real determinant, Vec3 direction, Vec3 edge_1, Vec3 edge_2)
{
    real size = dot3(magnitudes(edge_1), cross3_size(magnitudes(direction), magnitudes(edge_2)));
    PRECISE real least = size * real(9.5367431640625e-7f); // 2^-20
    return magnitude(determinant) <= least;
}

// t, u, v on the input triangle with corners v0, v0 + edge_1, v0 + edge_2 (Moeller and Trumbore 1997). A triangle that
// is seen edge-on gives its centroid.
KERNEL_FN Hit make_hit(Ray ray, uint triangle, Vec3 v0, Vec3 edge_1, Vec3 edge_2, uint tet, uint steps)
{
    Vec3 offset = sub3(ray.origin, v0);
    Vec3 p = cross3(ray.direction, edge_2);
    Vec3 q = cross3(offset, edge_1);
    real determinant = dot3(edge_1, p);

    Hit hit;
    hit.face_id = triangle;
    hit.tet = tet;
    hit.steps = steps;
    if (is_seen_edge_on(determinant, ray.direction, edge_1, edge_2)) {
        Vec3 diagonal = sub3(edge_2, sub3(VEC3(real(0.0f), real(0.0f), real(0.0f)), edge_1));
        PRECISE real along = dot3(diagonal, ray.direction) / real(3.0f) - dot3(offset, ray.direction);
        PRECISE real t = along / dot3(ray.direction, ray.direction);
        hit.t = t;
        hit.u = real(0.333333343f);
        hit.v = real(0.333333343f);
        return hit;
    }
    PRECISE real t = dot3(edge_2, q) / determinant;
    PRECISE real u = dot3(offset, p) / determinant;
    PRECISE real v = dot3(ray.direction, q) / determinant;
    hit.t = t;
    hit.u = u;
    hit.v = v;
    return hit;
}

// Whether a ray ends before it meets a triangle's plane, using only products; false for a ray in the plane.
KERNEL_FN bool is_beyond(Ray ray, Vec3 v0, Vec3 edge_1, Vec3 edge_2, real end)
{
    if (end >= real(NO_END)) return false;
    real determinant = dot3(edge_1, cross3(ray.direction, edge_2));
    real along = dot3(edge_2, cross3(sub3(ray.origin, v0), edge_1));
    PRECISE real limit = end * determinant;
    return determinant > real(0.0f) ? along > limit : along < limit && determinant < real(0.0f);
}

KERNEL_FN Hit make_no_hit(uint face_id, uint tet, uint steps)
{
    Hit hit;
    hit.face_id = face_id;
    hit.tet = tet;
    hit.t = real(0.0f);
    hit.u = real(0.0f);
    hit.v = real(0.0f);
    hit.steps = steps;
    return hit;
}

#endif
