// Every array that a BVH has on a device; cdt_arrays.h lists those of a CDT.
SCENE_ARRAY(uint4, nodes, nodes, 0)
SCENE_ARRAY(uint4, leaf_triangles, leaf_triangles, 1)
