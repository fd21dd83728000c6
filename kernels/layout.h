// The packed data that crosses to a device, stated once, for every language: constants and the hit record.
// Plain C: no include, no type that a shading language lacks. Array names and bindings: scene_arrays.h.
#ifndef TETRACE_KERNELS_LAYOUT_H
#define TETRACE_KERNELS_LAYOUT_H

// Hit.face_id beyond the input triangles.
#define NO_HIT 0xFFFFFFFFu // the ray left the domain, or never met it
#define LOST 0xFFFFFFFEu   // the walk found no exit face, or reached its cap of steps: always a failure
#define POISON 0xFFFFFFFDu // nothing was written: buffers are filled with it before a launch

// A launch's output: guard words, six words a hit row after row, guard words; all of it is POISON before.
#define HIT_WORDS 6u
#define GUARD_WORDS 64u
// A ray that is given: its rows stand a whole list of rays apart, all first rows before all second ones.
//   {direction, link of its entry face}  {origin, 0}  {moment, 0}
#define RAY_ROWS 3u
// A tile of an image is a work group: this many pixels wide, 4 or 8 high.
#define TILE_WIDTH 8u

// Operations of the self-test, see probe.h.
#define PROBE_COPY 0u
#define PROBE_MULTIPLY_ADD 1u
#define PROBE_DIVIDE 2u
#define PROBE_ADD 3u
#define PROBE_MULTIPLY 4u
#define PROBE_SQUARE_ROOT 5u
#define PROBE_CONVERT 6u
#define PROBE_COMPARE 7u
#define PROBE_INTEGER 8u

// A link is tet << 2 | face: 2^30 - 1 tets at most.
#define NO_LINK 0xFFFFFFFFu
#define NO_TET 0x3FFFFFFFu
#define MAX_TETS 0x3FFFFFFFu
#define FREE_FACE 0xFFFFFFFFu // a face that belongs to no input triangle
#define NO_EXIT 4u            // instead of a face: the method found none to leave the tet by

// Bindings: scene_arrays.h has 0 to 4; then the output, the counter of persistent threads, and the parts of the array
// of tets beyond its first, where one buffer cannot hold it.
#define SCENE_ARRAYS 5u
#define OUTPUT_BINDING 5u
#define COUNTER_BINDING 6u
#define SECOND_PART_BINDING 7u
#define MAX_TET_PARTS 8u
#define RAYS_BINDING (SECOND_PART_BINDING + MAX_TET_PARTS - 1u)
#define FIRST_ROWS_BINDING 16u // of rows, where words and rows of one array are bound apart

// tet80: rows of 16 bytes. 12 floats (vertex major), then 4 faces of 8 bytes {link, input triangle}.
#define TET80_ROWS 5u
// tet96: 4 vertices of 16 bytes (w is 0), then 4 faces of 8 bytes {link, input triangle}.
#define TET96_ROWS 6u
// triangles: v0, v1 - v0, v2 - v0 of each input triangle, a row of 16 bytes each (w is 0).
#define TRIANGLE_ROWS 3u

#endif
