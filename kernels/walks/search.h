// The exit search by itself, without the walk: the paper's Table 5. A given ray enters a tet by a known face, and a
// method returns the face by which it leaves, or NO_EXIT. Methods get the moment as in a walk, computed once per ray. A
// quad that a method does not use is not loaded.
#ifndef TETRACE_KERNELS_WALKS_SEARCH_H
#define TETRACE_KERNELS_WALKS_SEARCH_H

#include KERNEL_METHOD_HEADER

#define SEARCHES_EXITS

KERNEL_FN Ray stabbing_ray(uint4 direction, uint4 origin, uint4 moment)
{
    Ray ray;
    ray.origin = VEC3(as_real(origin.x), as_real(origin.y), as_real(origin.z));
    ray.direction = VEC3(as_real(direction.x), as_real(direction.y), as_real(direction.z));
    ray.moment = VEC3(as_real(moment.x), as_real(moment.y), as_real(moment.z));
    return ray;
}

KERNEL_FN uint search_exit(SceneView scene, uint4 direction, uint4 origin, uint4 moment)
{
    return exit_face(scene, direction.w >> 2u, direction.w & 3u, stabbing_ray(direction, origin, moment));
}

#endif
