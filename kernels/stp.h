// Method stp: exit face by scalar triple products of the ray's direction and two vertices, seen from the ray's origin.
// Source: Lagae and Dutre, "Accelerating Ray Tracing using Constrained Tetrahedralizations", EGSR 2008.
// 3 operations a vertex moved, 14 a product (9 + 5); three products or four, at most six.

// from, to: vertices less the ray's origin. Exactly negated where they change places.
KERNEL_FN real triple_product(Ray ray, Vec3 from, Vec3 to)
{
    return dot3(ray.direction, cross3(from, to));
}

// A face is the exit where none of its three edges has the ray on its entering side. The three candidates are asked one
// after the other, each until an edge says no, and no edge is asked twice.
KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Vec3 apex = sub3(vertex(scene, tet, entry), ray.origin);
    Vec3 c0 = sub3(vertex(scene, tet, corner(entry, 0u)), ray.origin);
    Vec3 c1 = sub3(vertex(scene, tet, corner(entry, 1u)), ray.origin);
    real s0 = triple_product(ray, c0, apex);
    real s1 = triple_product(ray, c1, apex);
    if (s0 <= real(0.0f) && s1 >= real(0.0f) && triple_product(ray, c0, c1) >= real(0.0f)) return corner(entry, 2u);
    Vec3 c2 = sub3(vertex(scene, tet, corner(entry, 2u)), ray.origin);
    real s2 = triple_product(ray, c2, apex);
    if (s1 <= real(0.0f) && s2 >= real(0.0f) && triple_product(ray, c1, c2) >= real(0.0f)) return corner(entry, 0u);
    if (s2 <= real(0.0f) && s0 >= real(0.0f) && triple_product(ray, c2, c0) >= real(0.0f)) return corner(entry, 1u);
    return NO_EXIT;
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return start_face_by_edges(scene, tet, ray);
}
