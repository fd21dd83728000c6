// Method maria: exit face by two side products in the frame of the complement vertex.
// Source: Maria, Horna, Aveneau, "Efficient Ray Traversal of Constrained Delaunay Tetrahedralization", GRAPP 2017,
// sections 3.1 to 3.4. 28 operations a step: 9 + 3 for the moment, twice 3 + 5 for a side product.

// Table of exits: face reached from `entry` by outcome 0, 1, 2; 2-bit entries as in corner().
//   entry 0: 2 3 1    entry 1: 3 2 0    entry 2: 1 3 0    entry 3: 2 1 0
KERNEL_FN uint other_face(uint entry, uint outcome)
{
    return (0x18D2DEu >> (6u * entry + 2u * outcome)) & 3u;
}

KERNEL_FN uint exit_face(SceneView scene, uint tet, uint entry, Ray ray)
{
    Vec3 apex = vertex(scene, tet, entry);
    Vec3 moment = sub3(ray.moment, cross3(apex, ray.direction)); // origin moved to the apex: its edges have no moment
    real side = dot3(moment, sub3(apex, vertex(scene, tet, corner(entry, 2u))));
    uint outcome = side >= real(0.0f) ? 1u : 0u;
    side = dot3(moment, sub3(apex, vertex(scene, tet, corner(entry, outcome))));
    outcome += side < real(0.0f) ? 1u : 0u;
    return other_face(entry, outcome);
}

// In the tet that holds the origin there is no entry face; three side products decide among four faces. Each edge
// excludes one of its two faces; edges 23 and 01 leave one face of {0, 1} and one of {2, 3}, and the edge that those
// two share decides.
KERNEL_FN uint start_face(SceneView scene, uint tet, Ray ray)
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
