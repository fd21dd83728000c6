// The exit search alone, without the walk around it: the paper's Table 5. A given ray enters a tet by a known face; a
// method says by which face it leaves, or NO_EXIT. Methods get the moment as in a walk, made once a ray; a row that a
// method has no use for is not loaded.
KERNEL_FN Ray given_ray(uint4 direction, uint4 origin, uint4 moment)
{
    Ray ray;
    ray.origin = VEC3(as_real(origin.x), as_real(origin.y), as_real(origin.z));
    ray.direction = VEC3(as_real(direction.x), as_real(direction.y), as_real(direction.z));
    ray.moment = VEC3(as_real(moment.x), as_real(moment.y), as_real(moment.z));
    return ray;
}

// Number of an item's ray: the image is one tile wide.
KERNEL_FN uint ray_index(Pixel pixel)
{
    return pixel.y * TILE_WIDTH + pixel.x;
}

// How many rays there are: row r of ray i is number r * ray_count() + i.
KERNEL_FN uint ray_count(LaunchParams launch)
{
    return launch.trace.height * TILE_WIDTH;
}

KERNEL_FN uint search_exit(SceneView scene, uint4 direction, uint4 origin, uint4 moment)
{
    return exit_face(scene, direction.w >> 2u, direction.w & 3u, given_ray(direction, origin, moment));
}
