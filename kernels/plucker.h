// Method plucker: exit face by the permuted inner products of the Pluecker coordinates of ray and edges.
// Sources: Platis and Theoharis, "Fast Ray-Tetrahedron Intersection Using Pluecker Coordinates", Journal of Graphics
// Tools 8(4), 2003; Lagae and Dutre, "Accelerating Ray Tracing using Constrained Tetrahedralizations", EGSR 2008.
// 23 operations a product: 3 for the edge's direction, 9 for its moment, 5 + 5 + 1; three products or four, at most
// six.

// The edge's Pluecker coordinates are {to - from, from x to}. Exactly negated where from and to change places.
KERNEL_FN real edge_product(Ray ray, Vec3 from, Vec3 to)
{
    PRECISE real product = dot3(ray.moment, sub3(to, from)) + dot3(ray.direction, cross3(from, to));
    return product;
}

// A face is the exit where none of its three edges has the ray on its entering side. The three candidates are asked one
// after the other, each until an edge says no, and no edge is asked twice.
KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Vec3 apex = vertex(scene, tet, entry);
    Vec3 c0 = vertex(scene, tet, corner(entry, 0u));
    Vec3 c1 = vertex(scene, tet, corner(entry, 1u));
    real s0 = edge_product(ray, c0, apex);
    real s1 = edge_product(ray, c1, apex);
    if (s0 <= real(0.0f) && s1 >= real(0.0f) && edge_product(ray, c0, c1) >= real(0.0f)) return corner(entry, 2u);
    Vec3 c2 = vertex(scene, tet, corner(entry, 2u));
    real s2 = edge_product(ray, c2, apex);
    if (s1 <= real(0.0f) && s2 >= real(0.0f) && edge_product(ray, c1, c2) >= real(0.0f)) return corner(entry, 0u);
    if (s2 <= real(0.0f) && s0 >= real(0.0f) && edge_product(ray, c2, c0) >= real(0.0f)) return corner(entry, 1u);
    return NO_EXIT;
}

KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
{
    return start_face_by_edges(scene, tet, ray);
}
