// Method project: exit face by the signs of two 2D cross products of projected vertices. A vertex has the same position
// across the ray in every tet, and a sign is never wrong and never zero, so that no two tets disagree and no walk gets
// lost (docs/spec/project.md, P6). Sources: the walk, Aman, Demirci, Guedukbay, "Compact Tetrahedralization-Based
// Acceleration Structures for Ray Tracing", Journal of Visualization 25, 2022; the projection, see shear.h; ties,
// Edelsbrunner and Muecke, "Simulation of Simplicity", ACM Transactions on Graphics 9(1), 1990. 46 operations per step:
// 3 for the shear, 13 a vertex (3 + 5 + 5), 2 a sign; a sign at a tie 32 more.
#ifndef TETRACE_KERNELS_METHODS_PROJECT_H
#define TETRACE_KERNELS_METHODS_PROJECT_H

#include KERNEL_LAYOUT_HEADER
#include "kernels/layouts/faces.h"
#include "kernels/methods/signs.h"

#define TAKES_RAYS
#define WALKS_PATHS // its walk follows a path that begins at a boundary face that holds the ray, if there is one

// The two tests of maria, at edges that end in the apex: the edge from c2, then the edge from c0 or c1.
KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Shear shear = shear_of(ray);
    Sheared apex = sheared(shear, sub3(vertex(scene, tet, entry), ray.origin));
    Sheared p2 = sheared(shear, sub3(vertex(scene, tet, corner(entry, 2u)), ray.origin));
    uint outcome = is_apex_left(p2, apex) ? 1u : 0u;
    Sheared other = sheared(shear, sub3(vertex(scene, tet, corner(entry, outcome)), ray.origin));
    outcome += is_apex_left(other, apex) ? 0u : 1u;
    return other_face(entry, outcome);
}

// The same if float products decide, else TIE_AT | entry.
#define TIE_AT 4u
KERNEL_FN uint rough_exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Shear shear = shear_of(ray);
    Sheared apex = sheared(shear, sub3(vertex(scene, tet, entry), ray.origin));
    Sheared p2 = sheared(shear, sub3(vertex(scene, tet, corner(entry, 2u)), ray.origin));
    PRECISE real plus = p2.x * apex.y;
    PRECISE real minus = p2.y * apex.x;
    uint outcome = plus > minus ? 1u : 0u;
    Sheared other = sheared(shear, sub3(vertex(scene, tet, corner(entry, outcome)), ray.origin));
    PRECISE real other_plus = other.x * apex.y;
    PRECISE real other_minus = other.y * apex.x;
    outcome += other_plus > other_minus ? 0u : 1u;
    return plus == minus || other_plus == other_minus ? TIE_AT | entry : other_face(entry, outcome);
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return face_left_by(ray, vertex(scene, tet, 0u), vertex(scene, tet, 1u), vertex(scene, tet, 2u),
                        vertex(scene, tet, 3u));
}

KERNEL_FN bool is_ahead(SceneView scene, uint tet, uint face, Ray ray)
{
    return is_face_ahead(ray, vertex(scene, tet, corner(face, 0u)), vertex(scene, tet, corner(face, 1u)),
                         vertex(scene, tet, corner(face, 2u)));
}

#endif
