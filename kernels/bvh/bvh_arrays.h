// Every array that a BVH brings to a device, as cdt_arrays.h has those of a CDT.
SCENE_ARRAY(uint4, nodes, nodes, 0)
SCENE_ARRAY(uint4, leaf_triangles, leaf_triangles, 1)
