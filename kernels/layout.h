// The packed data that crosses to a device, stated once, for every language: constants and the hit record.
// Plain C: no include, no type that a shading language lacks. Array names and bindings: scene_arrays.h.
#ifndef TETRACE_KERNELS_LAYOUT_H
#define TETRACE_KERNELS_LAYOUT_H

// Hit.face_id beyond the input triangles.
#define NO_HIT 0xFFFFFFFFu // the ray left the domain, or never met it
#define LOST 0xFFFFFFFEu   // the walk reached its cap of steps: always a failure
#define POISON 0xFFFFFFFDu // nothing was written: buffers are filled with it before a launch

// A link is tet << 2 | face: 2^30 - 1 tets at most.
#define NO_LINK 0xFFFFFFFFu
#define NO_TET 0x3FFFFFFFu
#define MAX_TETS 0x3FFFFFFFu
#define FREE_FACE 0xFFFFFFFFu // a face that belongs to no input triangle

// tet80: rows of 16 bytes. 12 floats (vertex major), then 4 faces of 8 bytes {link, input triangle}.
#define TET80_ROWS 5u
// tet96: 4 vertices of 16 bytes (w is 0), then 4 faces of 8 bytes {link, input triangle}.
#define TET96_ROWS 6u
// triangles: v0, v1 - v0, v2 - v0 of each input triangle, a row of 16 bytes each (w is 0).
#define TRIANGLE_ROWS 3u

#endif
