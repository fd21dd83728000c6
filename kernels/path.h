// Where a path begins that does not begin at the domain's boundary: for methods that define WALKS_PATHS, whose signs
// make the faces that a ray crosses one path from boundary to boundary (SPEC.md, Method project). Such a method brings
// is_ahead(scene, tet, face, ray).
#ifdef WALKS_PATHS

// The face of the ray's path that it leaves its start by, as tet << 2 | face of the tet that it leaves there; NO_LINK
// where it has no path, or none is left. For an origin in a tet none of whose faces hold the ray.
// start: the triangle that the ray starts on: what comes behind the last of its faces on the path. Where none of them
// is on the path, and with FREE_FACE: the first face that is crossed in front of the origin, else the path's last one.
KERNEL_FN uint exit_ahead(SceneView scene, TraceParams params, Ray ray, uint start)
{
    COUNT_SEARCH(1);
    uint entry = entry_anywhere(scene, ray, 0u, 0u);
    uint link = entry == NO_ENTRY ? NO_LINK : FETCH(scene, entry_links, entry);
    uint exit = NO_LINK;
    bool ahead = false;
    for (uint steps = 0u; (!ahead || start != FREE_FACE) && link != NO_LINK && steps < params.max_steps; steps++) {
        uint tet = link >> 2u;
        uint face = exit_face(scene, tet, link & 3u, ray);
        bool on_start = start != FREE_FACE && face_triangle(scene, tet, face) == start;
        bool found = ahead && exit != NO_LINK;
        exit = on_start ? NO_LINK : found ? exit : (tet << 2u) | face;
        ahead = ahead || on_start || is_ahead(scene, tet, face, ray);
        link = face_link(scene, tet, face);
    }
    return exit;
}

// The same for a ray that starts on the face that a link names. The tet's own exit, where the ray crosses the tet: it
// is the one that follows the named face, where the rounded ray enters by that. Where the ray leaves by the named face,
// it goes on beyond it.
KERNEL_FN uint exit_from_face(SceneView scene, TraceParams params, Ray ray, uint link)
{
    uint tet = link >> 2u;
    uint face = start_face(scene, tet, ray);
    if (face == NO_EXIT) return exit_ahead(scene, params, ray, face_triangle(scene, tet, link & 3u));
    if (face != (link & 3u)) return (tet << 2u) | face;
    COUNT_SEARCH(2);
    uint beyond = face_link(scene, tet, face);
    if (beyond == NO_LINK) return NO_LINK;
    return (beyond & ~3u) | exit_face(scene, beyond >> 2u, beyond & 3u, ray);
}
#endif
