// Every array that a CDT with shared vertices has on a device; cdt_arrays.h lists those of a CDT whose tets hold their
// vertices.
SCENE_ARRAY(uint, tet_words, tets, 0)
SCENE_ARRAY(uint4, tet_quads, tets, 0)
SCENE_ARRAY(uint4, triangles, triangles, 1)
SCENE_ARRAY(uint, lines, lines, 2)
SCENE_ARRAY(uint, entry_ranges, entry_ranges, 3)
SCENE_ARRAY(uint4, entry_faces, entry_faces, 4)
SCENE_ARRAY(uint4, vertices, vertices, 5)
SCENE_ARRAY(uint, occlusive_faces, occlusive_faces, 6)
