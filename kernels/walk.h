// The walk from tet to tet, and the hit at its end. A method brings exit_face() and start_face(), which return a face
// of the tet, or NO_EXIT.

// t, u, v on the input triangle (Moeller and Trumbore 1997). A ray within rounding of the triangle's plane gets the
// centroid.
KERNEL_FN Hit make_hit(SceneView scene, Ray ray, uint triangle, uint tet, uint steps)
{
    uint4 r0 = FETCH(scene, triangles, TRIANGLE_ROWS * triangle);
    uint4 r1 = FETCH(scene, triangles, TRIANGLE_ROWS * triangle + 1u);
    uint4 r2 = FETCH(scene, triangles, TRIANGLE_ROWS * triangle + 2u);
    Vec3 edge_1 = VEC3(as_real(r1.x), as_real(r1.y), as_real(r1.z));
    Vec3 edge_2 = VEC3(as_real(r2.x), as_real(r2.y), as_real(r2.z));
    Vec3 offset = sub3(ray.origin, VEC3(as_real(r0.x), as_real(r0.y), as_real(r0.z)));
    Vec3 p = cross3(ray.direction, edge_2);
    Vec3 q = cross3(offset, edge_1);
    real determinant = dot3(edge_1, p);

    Hit hit;
    hit.face_id = triangle;
    hit.tet = tet;
    hit.steps = steps;
    if (determinant == real(0.0f)) {
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

// The link of a face, or NO_LINK where there is none to leave by. Such a walk reads face 0 instead: a load that all
// lanes do, and no word behind the last tet.
KERNEL_FN uint link_beyond(SceneView scene, uint tet, uint face)
{
    uint link = face_link(scene, tet, face & 3u);
    return face == NO_EXIT ? NO_LINK : link;
}

// Only the loop's own variables live on after it; everything else is loaded again (some compilers lose the rest).
KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    uint tet = params.start_tet;
    uint face = 0u;
    if (tet == NO_TET) {
        uint entry = entry_link(scene, ray);
        if (entry == NO_LINK) return make_no_hit(NO_HIT, NO_TET, 0u);
        tet = entry >> 2u;
        face = exit_face(scene, tet, entry & 3u, ray);
    } else {
        face = start_face(scene, tet, ray);
    }
    uint link = link_beyond(scene, tet, face);
    uint triangle = face_triangle(scene, tet, face & 3u);
    uint steps = 1u;
    while (triangle == FREE_FACE && link != NO_LINK && steps < params.max_steps) {
        tet = link >> 2u;
        face = exit_face(scene, tet, link & 3u, ray);
        link = link_beyond(scene, tet, face);
        triangle = face_triangle(scene, tet, face & 3u);
        steps++;
    }
    if (face == NO_EXIT) return make_no_hit(LOST, tet, steps - 1u);
    uint hit_triangle = face_triangle(scene, tet, face);
    if (hit_triangle != FREE_FACE) return make_hit(scene, ray, hit_triangle, tet, steps);
    bool left = face_link(scene, tet, face) == NO_LINK;
    return make_no_hit(left ? NO_HIT : LOST, tet, steps);
}
