// layouts/: the packed forms of tets, one file each, and the layout of all packed data.

// Every array that a CDT has on a device: element type, name, member of the packed scene, binding. A dialect defines
// SCENE_ARRAY, includes KERNEL_ARRAYS_HEADER (this file, compact_arrays.h or bvh_arrays.h) as often as it needs, and
// undefines it. A layout reads the tets as words or as quads; both names are the same bytes. The bindings after these
// are in layout.h.
SCENE_ARRAY(uint, tet_words, tets, 0)
SCENE_ARRAY(uint4, tet_quads, tets, 0)
SCENE_ARRAY(uint4, triangles, triangles, 1)
SCENE_ARRAY(uint, lines, lines, 2)
SCENE_ARRAY(uint, entry_ranges, entry_ranges, 3)
SCENE_ARRAY(uint, entry_half_faces, entry_half_faces, 4)
