// The boundary face by which a ray enters the domain, for walks by links.

// The number of the first of the square's faces that the ray is inside; if it is inside none, of the nearest one;
// NO_ENTRY where the ray misses the domain.
KERNEL_FN uint entry_index(SceneView scene, Ray ray)
{
    uint square = entry_square(scene, ray);
    if (square == 6u * scene.divisions * scene.divisions) return NO_ENTRY;
    uint last = FETCH(scene, entry_ranges, square + 1u);
    uint best = FETCH(scene, entry_ranges, square);
    real depth = depth_in(entry_face(scene, best), ray);
    for (uint index = best + 1u; index < last && depth < real(0.0f); ++index) {
        real candidate = depth_in(entry_face(scene, index), ray);
        best = candidate > depth ? index : best;
        depth = candidate > depth ? candidate : depth;
    }
    return best;
}
