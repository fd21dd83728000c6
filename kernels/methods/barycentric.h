// methods/: the exit-face searches, one file each, and what several of them share.
//
// Method barycentric: exit face by the point at which the ray meets each face's plane, in double: the face that has the
// point, by its barycentric coordinates and a tolerance; if none has it, the face that the ray approaches most steeply.
// Sources of the rule, not of the text: PUMI-PIC (https://github.com/SCOREC/pumi-pic, c09ad045:
// line_triangle_intx_simple() and search_mesh_3d()), on which PUMI-Tally is built; the tolerance is HASEonGPU's
// (https://github.com/ComputationalRadiationPhysics/haseongpu, f9a24c80: barycentricTraversalTolerance).
// docs/spec/methods.md, M12, has what differs.
#ifndef TETRACE_KERNELS_METHODS_BARYCENTRIC_H
#define TETRACE_KERNELS_METHODS_BARYCENTRIC_H

#define FINDS_NO_EXIT

#include "kernels/layouts/faces.h"
#include "kernels/methods/doubles.h"
#include "kernels/methods/edge_sides.h"

#define COORDINATE_TOLERANCE 1.4210854715202004e-14 // 64 * 2^-52

// A face that the ray approaches. steepness: of the ray against the plane, the sine of the angle times the direction's
// length.
STRUCT(FacePoint)
{
    uint face;
    bool is_met;
    double steepness;
};

// The face from the apex to a and b, whose normal (a - apex) x (b - apex) points out of the tet.
KERNEL_FN FacePoint point_of_face(Ray ray, uint face, Double3 apex, Double3 a, Double3 b)
{
    Double3 origin = in_double(ray.origin);
    Double3 direction = in_double(ray.direction);
    Double3 normal = cross_of(a - apex, b - apex);
    double approach = dot_of(normal, direction);
    if (approach <= 0.0) return {NO_EXIT, false, 0.0};
    double size = dot_of(normal, normal);
    Double3 point = origin + (dot_of(normal, apex - origin) / approach) * direction;
    double least = -COORDINATE_TOLERANCE * size;
    bool is_met = dot_of(normal, cross_of(a - apex, point - apex)) >= least &&
                  dot_of(normal, cross_of(b - a, point - a)) >= least &&
                  dot_of(normal, cross_of(apex - b, point - b)) >= least;
    return {face, is_met, approach / std::sqrt(size)};
}

// The first face that is met; of others the steepest.
KERNEL_FN FacePoint better_of(FacePoint best, FacePoint next)
{
    if (best.is_met || next.face == NO_EXIT) return best;
    return next.is_met || next.steepness > best.steepness ? next : best;
}

KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Double3 apex = in_double(vertex(scene, tet, entry));
    Double3 c0 = in_double(vertex(scene, tet, corner(entry, 0u)));
    Double3 c1 = in_double(vertex(scene, tet, corner(entry, 1u)));
    Double3 c2 = in_double(vertex(scene, tet, corner(entry, 2u)));
    FacePoint best = point_of_face(ray, corner(entry, 2u), apex, c0, c1);
    best = better_of(best, point_of_face(ray, corner(entry, 0u), apex, c1, c2));
    best = better_of(best, point_of_face(ray, corner(entry, 1u), apex, c2, c0));
    return best.face;
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return start_face_by_edges(scene, tet, ray);
}

KERNEL_FN real side_at_entry(Ray ray, Vec3 from, Vec3 to)
{
    return side_of_edge(ray, from, to);
}

#endif
