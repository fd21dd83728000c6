// The hit at the end of a walk, on an input triangle.
// The hit on an input triangle; NO_HIT where the ray ends before it.
KERNEL_FN Hit hit_on(SceneView scene, Ray ray, uint triangle, uint tet, uint steps, real end)
{
    uint4 r0 = FETCH(scene, triangles, TRIANGLE_QUADS * triangle);
    uint4 r1 = FETCH(scene, triangles, TRIANGLE_QUADS * triangle + 1u);
    uint4 r2 = FETCH(scene, triangles, TRIANGLE_QUADS * triangle + 2u);
    Vec3 v0 = VEC3(as_real(r0.x), as_real(r0.y), as_real(r0.z));
    Vec3 edge_1 = VEC3(as_real(r1.x), as_real(r1.y), as_real(r1.z));
    Vec3 edge_2 = VEC3(as_real(r2.x), as_real(r2.y), as_real(r2.z));
    if (is_beyond(ray, v0, edge_1, edge_2, end)) return make_no_hit(NO_HIT, tet, steps);
    return make_hit(ray, triangle, v0, edge_1, edge_2, tet, steps);
}
