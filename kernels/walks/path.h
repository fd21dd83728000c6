// Where a path begins that does not begin at the domain's boundary: for methods that define WALKS_PATHS, whose signs
// make the faces that a ray crosses one path from boundary to boundary (docs/spec/project.md, P5). Such a method brings
// is_ahead(scene, tet, face, ray).

// Instead of the triangle that a ray starts on: its walk began at the domain's boundary and is never begun anew.
#define FROM_OUTSIDE 0xFFFFFFFEu

// The face of the ray's path that it leaves its start by, as tet << 2 | face of the tet that it leaves there; NO_LINK
// where it has no path, or none is left. For an origin in a tet none of whose faces hold the ray.
// start: the triangle that the ray starts on: what comes behind the last of its faces on the path. Where none of them
// is on the path, and with FREE_FACE: the first face that is crossed in front of the origin, else the path's last one.
// lost: the exit by which a walk began that was lost, or NO_LINK. The path is then followed to its end, and `lost` is
// returned where it is on it, or where the end is too far: only a walk that goes in circles is begun anew. That is
// asked here since a loop of its own would cost devices that execute what is behind a condition whether a lane meets it
// or not.
KERNEL_FN uint exit_ahead(SceneView scene, TraceParams params, Ray ray, uint start, uint lost)
{
    COUNT_SEARCH(1);
    uint link = entry_link(scene, entry_anywhere(scene, ray, 0u, 0u));
    uint exit = NO_LINK;
    bool ahead = false;
    bool to_end = start != FREE_FACE || lost != NO_LINK;
    bool is_on_path = false;
    for (uint steps = 0u; (!ahead || to_end) && link != NO_LINK && steps < params.max_steps; ++steps) {
        uint tet = link >> 2u;
        uint face = exit_face(scene, tet, link & 3u, ray);
        bool on_start = start != FREE_FACE && face_triangle(scene, tet, face) == start;
        bool found = ahead && exit != NO_LINK;
        exit = on_start ? NO_LINK : found ? exit : (tet << 2u) | face;
        ahead = ahead || on_start || is_ahead(scene, tet, face, ray);
        is_on_path = is_on_path || ((tet << 2u) | face) == lost;
        link = face_link(scene, tet, face);
    }
    return lost != NO_LINK && (is_on_path || link != NO_LINK) ? lost : exit;
}

// A tet, or NO_TET, and the face that the ray leaves it by, or NO_EXIT.
STRUCT(Exit)
{
    uint tet;
    uint face;
};

// The same for a ray that starts on the face that a link names. The tet's own exit, where the ray crosses the tet: it
// is the one that follows the named face, where the rounded ray enters by that. Where the ray leaves by the named face,
// it goes on beyond it. NO_EXIT where exit_ahead() has to find its path, NO_TET where that is at its end.
KERNEL_FN Exit exit_from_face(SceneView scene, Ray ray, uint link)
{
    Exit exit;
    exit.tet = link >> 2u;
    exit.face = start_face(scene, exit.tet, ray);
    if (exit.face != (link & 3u)) return exit;
    COUNT_SEARCH(2);
    uint beyond = face_link(scene, exit.tet, exit.face);
    exit.tet = beyond >> 2u; // NO_TET of NO_LINK
    if (beyond != NO_LINK) exit.face = exit_face(scene, exit.tet, beyond & 3u, ray);
    return exit;
}
