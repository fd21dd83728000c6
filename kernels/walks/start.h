// The exit face of the tet that a ray starts in, for the methods that need an entry face.
// In the tet that holds the origin there is no entry face; three side products decide among four faces. Each edge
// excludes one of its two faces; edges 23 and 01 leave one face of {0, 1} and one of {2, 3}, and the edge that those
// two share decides.
KERNEL_FN uint start_face_by_edges(SceneView scene, uint tet, Ray ray)
{
    real side = side_of_edge(ray, vertex(scene, tet, 2u), vertex(scene, tet, 3u));
    uint low = side >= real(0.0f) ? 1u : 0u;
    side = side_of_edge(ray, vertex(scene, tet, 0u), vertex(scene, tet, 1u));
    uint high = side >= real(0.0f) ? 3u : 2u;
    side = side_of_edge(ray, vertex(scene, tet, 1u - low), vertex(scene, tet, 5u - high));
    bool positive = side >= real(0.0f);
    bool even = low + 2u == high;
    return positive == even ? low : high;
}
