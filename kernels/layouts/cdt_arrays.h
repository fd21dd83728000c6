// Every array that a CDT brings to a device: element type, name, member of the packed scene, binding. A dialect defines
// SCENE_ARRAY, includes KERNEL_ARRAYS_HEADER, this file or bvh_arrays.h, as often as it needs, and undefines it. The
// tets are read as words or as quads, whichever a layout wants; both names are the same bytes. The bindings behind
// these are in layout.h.
SCENE_ARRAY(uint, tet_words, tets, 0)
SCENE_ARRAY(uint4, tet_quads, tets, 0)
SCENE_ARRAY(uint4, triangles, triangles, 1)
SCENE_ARRAY(uint, lines, lines, 2)
SCENE_ARRAY(uint, entry_ranges, entry_ranges, 3)
SCENE_ARRAY(uint, entry_links, entry_links, 4)
