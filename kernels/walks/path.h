// Where a walk begins that does not begin at the domain's boundary. For methods that define WALKS_PATHS: by their
// signs, the faces that a ray crosses form one path from boundary to boundary (docs/spec/project.md, P5). Such a method
// defines is_ahead(scene, tet, face, ray).

// Instead of the triangle that a ray starts on: the walk began at the domain's boundary and is never restarted.
#define FROM_OUTSIDE 0xFFFFFFFEu

// The face of its path by which the ray leaves its start, as tet << 2 | face of the tet that it leaves; NO_LINK where
// the ray has no path, or no face of it is left. For an origin in a tet none of whose faces hold the ray.
// start: the triangle that the ray starts on. The result is the face after the last face of this triangle on the path.
// If the triangle has no face on the path, and for FREE_FACE, it is the first face crossed in front of the origin, else
// the path's last face. doubted: the first exit of a walk that may be in a circle, or NO_LINK. The path is then
// followed to its end. `doubted` is returned if it is on the path, or if the end is too far: only a walk in a circle
// begins elsewhere; others are made once more, because to keep one until then would cost all rays a GPU's registers
// (docs/spec/project.md, P15). This is tested here because a separate loop would be slow on devices that execute a
// conditional block even if no lane needs it.
RARE_FN uint exit_ahead(SceneView scene, TraceParams params, Ray ray, uint start, uint doubted)
{
    COUNT_SEARCH(1);
    uint link = entry_link(scene, entry_anywhere(scene, ray, 0u, 0u));
    uint exit = NO_LINK;
    bool ahead = false;
    bool to_end = start != FREE_FACE || doubted != NO_LINK;
    bool is_on_path = false;
    for (uint steps = 0u; (!ahead || to_end) && link != NO_LINK && steps < params.max_steps; ++steps) {
        uint tet = link >> 2u;
        uint face = exit_face(scene, tet, link & 3u, ray);
        bool on_start = start != FREE_FACE && face_triangle(scene, tet, face) == start;
        bool found = ahead && exit != NO_LINK;
        exit = on_start ? NO_LINK : found ? exit : (tet << 2u) | face;
        ahead = ahead || on_start || is_ahead(scene, tet, face, ray);
        is_on_path = is_on_path || ((tet << 2u) | face) == doubted;
        link = face_link(scene, tet, face);
    }
    return doubted != NO_LINK && (is_on_path || link != NO_LINK) ? doubted : exit;
}

// A tet, or NO_TET, and the face by which the ray leaves it, or NO_EXIT.
STRUCT(Exit)
{
    uint tet;
    uint face;
};

// The same for a ray that starts on the face that a link names. Where the ray crosses the tet, the result is the tet's
// own exit, which follows the named face if the rounded ray enters by it. Where the ray leaves the tet by the named
// face, the result is in the tet beyond that face. NO_EXIT where exit_ahead() has to find the path, NO_TET where the
// path has ended.
KERNEL_FN Exit exit_from_face(SceneView scene, Ray ray, uint link)
{
    Exit exit;
    exit.tet = link >> 2u;
    exit.face = start_face(scene, exit.tet, ray);
    if (exit.face != (link & 3u)) return exit;
    COUNT_SEARCH(2);
    uint beyond = face_link(scene, exit.tet, exit.face);
    exit.tet = beyond >> 2u; // NO_TET if beyond is NO_LINK
    if (beyond != NO_LINK) exit.face = exit_face(scene, exit.tet, beyond & 3u, ray);
    return exit;
}
