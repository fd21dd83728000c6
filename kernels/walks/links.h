// Shared by the walks that follow links: the link of a face, whether the ray ends before the next tet, and the hit at
// the end.

// The link of a face; NO_LINK where the face is NO_EXIT or not decided yet. A face from 0 to 3 is read in any case: all
// lanes then load alike, and none loads beyond the last tet.
KERNEL_FN uint link_beyond(SceneView scene, uint tet, uint face)
{
    uint link = face_link(scene, tet, face & 3u);
    return face >= NO_EXIT ? NO_LINK : link;
}

// Whether the ray ends before it enters the tet that the link names: all three vertices of the face lie beyond its end
// along its direction. Rounding does not matter here: hits beyond the end are discarded later.
KERNEL_FN bool ends_before(SceneView scene, uint link, Ray ray, real end)
{
    PRECISE real reach = end * dot3(ray.direction, ray.direction);
    uint tet = link >> 2u;
    uint face = link & 3u;
    if (dot3(sub3(vertex(scene, tet, corner(face, 0u)), ray.origin), ray.direction) <= reach) return false;
    if (dot3(sub3(vertex(scene, tet, corner(face, 1u)), ray.origin), ray.direction) <= reach) return false;
    return dot3(sub3(vertex(scene, tet, corner(face, 2u)), ray.origin), ray.direction) > reach;
}

// The hit of a walk that has ended after `steps` tets, the last of which it left by this face.
KERNEL_FN Hit hit_at_end(SceneView scene, TraceParams params, Ray ray, uint tet, uint face, uint steps, real end)
{
    uint hit_triangle = face_triangle(scene, tet, face);
    if (hit_triangle != FREE_FACE) return hit_on(scene, ray, hit_triangle, tet, steps, end);
    bool left = face_link(scene, tet, face) == NO_LINK;
    bool ended = end < real(NO_END) && steps < params.max_steps;
    return make_no_hit(left || ended ? NO_HIT : LOST, tet, steps);
}
