// Where a walk starts that does not start at the domain's boundary. For methods that define WALKS_PATHS: by their
// signs, the faces that a ray crosses form one path from boundary to boundary (docs/spec/project.md, P5). Such a method
// defines is_ahead(scene, tet, face, ray).
#ifndef TETRACE_KERNELS_WALKS_PATH_H
#define TETRACE_KERNELS_WALKS_PATH_H

#include KERNEL_METHOD_HEADER
#include "kernels/walks/entry_half_faces.h"
#include "kernels/walks/entry_on_path.h"

// Instead of the triangle that a ray starts on: the walk began at the domain's boundary and is never restarted.
#define FROM_OUTSIDE 0xFFFFFFFEu

// The face of its path by which the ray leaves its start, as the half-face of the tet that it leaves; NO_HALF_FACE if
// there is no path, or no further face on it. For an origin in a tet without a face that holds the ray.
// start: the triangle that the ray starts on. The result is the face after the last face of this triangle on the path.
// If no face of the triangle is on the path, and for FREE_FACE, it is the first face crossed in front of the origin,
// else the path's last face. doubted: the first exit of a walk that may be in a circle, or NO_HALF_FACE. The path is
// then followed to its end. `doubted` is returned if it is on the path, or if the end is too far: only a walk in a
// circle starts elsewhere; others are repeated, because keeping one until then would cost registers on every ray of a
// GPU (docs/spec/project.md, P15). This is tested here because a separate loop would be slow on devices that execute a
// conditional block even if no lane needs it.
RARE_FN uint exit_ahead(SceneView scene, TraceParams params, Ray ray, uint start, uint doubted)
{
    COUNT_SEARCH(1);
    uint half_face = entry_half_face(scene, entry_anywhere(scene, ray, 0u, 0u));
    uint exit = NO_HALF_FACE;
    bool ahead = false;
    bool to_end = start != FREE_FACE || doubted != NO_HALF_FACE;
    bool is_on_path = false;
    for (uint steps = 0u; (!ahead || to_end) && half_face != NO_HALF_FACE && steps < params.max_steps; ++steps) {
        uint tet = half_face >> 2u;
        uint face = exit_face(scene, tet, half_face & 3u, ray);
        bool on_start = start != FREE_FACE && face_triangle(scene, tet, face) == start;
        bool found = ahead && exit != NO_HALF_FACE;
        exit = on_start ? NO_HALF_FACE : found ? exit : (tet << 2u) | face;
        ahead = ahead || on_start || is_ahead(scene, tet, face, ray);
        is_on_path = is_on_path || ((tet << 2u) | face) == doubted;
        half_face = opposite_half_face(scene, tet, face);
    }
    return doubted != NO_HALF_FACE && (is_on_path || half_face != NO_HALF_FACE) ? doubted : exit;
}

// A tet, or NO_TET, and the face by which the ray leaves it, or NO_EXIT.
STRUCT(Exit)
{
    uint tet;
    uint face;
};

// The same for a ray that starts on the named half-face. If the ray crosses the tet, the result is the tet's own exit,
// which follows the named face if the rounded ray enters by it. If the ray leaves the tet by the named face, the result
// is in the neighbour across that face. NO_EXIT if exit_ahead() has to find the path, NO_TET if the path has ended.
KERNEL_FN Exit exit_from_face(SceneView scene, Ray ray, uint half_face)
{
    Exit exit;
    exit.tet = half_face >> 2u;
    exit.face = start_face(scene, exit.tet, ray);
    if (exit.face != (half_face & 3u)) return exit;
    COUNT_SEARCH(2);
    uint beyond = opposite_half_face(scene, exit.tet, exit.face);
    exit.tet = beyond >> 2u; // NO_TET if beyond is NO_HALF_FACE
    if (beyond != NO_HALF_FACE) exit.face = exit_face(scene, exit.tet, beyond & 3u, ray);
    return exit;
}

#endif
