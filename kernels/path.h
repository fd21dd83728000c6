// Where a path begins that does not begin at the origin's tet: for methods that define WALKS_PATHS, whose signs make
// the faces that a ray crosses one path from boundary to boundary (SPEC.md, Method project). Such a method brings
// is_ahead(scene, tet, face, ray).
#ifdef WALKS_PATHS

// The first face of the ray's path that it crosses in front of its origin, as tet << 2 | face of the tet that it leaves
// there; the path's last face where it crosses all behind; NO_LINK where it has no path. For an origin in a tet none of
// whose faces hold the ray.
KERNEL_FN uint exit_ahead(SceneView scene, TraceParams params, Ray ray)
{
    uint link = entry_anywhere(scene, ray);
    uint exit = NO_LINK;
    bool ahead = false;
    for (uint steps = 0u; !ahead && link != NO_LINK && steps < params.max_steps; steps++) {
        uint tet = link >> 2u;
        uint face = exit_face(scene, tet, link & 3u, ray);
        exit = (tet << 2u) | face;
        link = face_link(scene, tet, face);
        ahead = is_ahead(scene, tet, face, ray);
    }
    return exit;
}
#endif
