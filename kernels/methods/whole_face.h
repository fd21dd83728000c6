// Exit face for methods that ask a face for the sides of all its edges. The method, which includes this, brings
// AS_SEEN(ray, point), a vertex as its products take it, and side_of(ray, from, to) for two of those, which must be
// exactly negated where they change places: an edge then has one side, whichever tet asks.

// A face is the exit where none of its three edges has the ray on its entering side. The three candidates are asked one
// after the other, each until an edge says no, and no edge is asked twice.
KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Vec3 apex = AS_SEEN(ray, vertex(scene, tet, entry));
    Vec3 c0 = AS_SEEN(ray, vertex(scene, tet, corner(entry, 0u)));
    Vec3 c1 = AS_SEEN(ray, vertex(scene, tet, corner(entry, 1u)));
    real s0 = side_of(ray, c0, apex);
    real s1 = side_of(ray, c1, apex);
    if (s0 <= real(0.0f) && s1 >= real(0.0f) && side_of(ray, c0, c1) >= real(0.0f)) return corner(entry, 2u);
    Vec3 c2 = AS_SEEN(ray, vertex(scene, tet, corner(entry, 2u)));
    real s2 = side_of(ray, c2, apex);
    if (s1 <= real(0.0f) && s2 >= real(0.0f) && side_of(ray, c1, c2) >= real(0.0f)) return corner(entry, 0u);
    if (s2 <= real(0.0f) && s0 >= real(0.0f) && side_of(ray, c2, c0) >= real(0.0f)) return corner(entry, 1u);
    return NO_EXIT;
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return start_face_by_edges(scene, tet, ray);
}

KERNEL_FN real side_at_entry(Ray ray, Vec3 from, Vec3 to)
{
    return side_of(ray, AS_SEEN(ray, from), AS_SEEN(ray, to));
}
