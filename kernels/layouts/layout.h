// The packed data that is copied to a device, stated once for every language: constants and the hit record.
// Plain C: no include, no type that a shading language lacks. Array names and bindings: cdt_arrays.h,
// compact_arrays.h and bvh_arrays.h.
#ifndef TETRACE_KERNELS_LAYOUT_H
#define TETRACE_KERNELS_LAYOUT_H

// Values of Hit.face_id that are not input triangles.
#define NO_HIT 0xFFFFFFFFu // the ray left the domain, or never met it
#define LOST 0xFFFFFFFEu   // the walk found no exit face, or reached its cap of steps: always a failure
#define POISON 0xFFFFFFFDu // nothing was written: outputs are filled with this before a launch
#define DEFERRED POISON    // of a ray at a tie, if kernels defer ties: until another program has traced it

// A launch's output: guard words, six words per hit row after row, guard words; filled with POISON before the launch.
#define HIT_WORDS 6u
#define GUARD_WORDS 64u
// A given ray. The first quads of all rays come before all second quads. Task search:
//   {direction, half-face of its entry face}  {origin, 0}  {moment, 0}
#define RAY_QUADS 3u
// Task rays, with the half-face of the face that the ray starts on or enters by, NO_HALF_FACE if it comes from outside
// the domain (BVHs do not use it), and the ray parameter of its end:
//   {direction, half-face}  {origin, end}
#define GIVEN_RAY_QUADS 2u
#define NO_END 3.0e38f // of a ray that goes on for ever
// Task segments: the same quads, with the ray's stretch in place of its end, which it has none: 2^STRETCH_BITS times
// the length of the direction over the magnitude of its largest component, rounded; 1 to sqrt 3. A place is a
// coordinate along that component's axis in units of 2^-PLACE_BITS, from -2 on, times the stretch, times 2^-32: a
// length from there in units of 2^-LENGTH_BITS.
#define STRETCH_BITS 31u
#define PLACE_BITS 29u
#define LENGTH_BITS 28u
#define PLACE_OF_ZERO 0x40000000u // 2 * 2^PLACE_BITS
// Task absorb: what a medium lets pass is in units of 2^-TRANSMITTANCE_BITS; a ray that has met none has NO_ABSORPTION.
// A walk ends after the tet in which it falls below MIN_TRANSMITTANCE, 2^-10 of the light.
#define TRANSMITTANCE_BITS 24u
#define NO_ABSORPTION 0x1000000u
#define MIN_TRANSMITTANCE 0x4000u
// After this many steps a walk checks whether it is in a circle. Longer walks are rare, and those in circles end soon.
#define STEPS_BEFORE_DOUBT 4096u
// A tile of an image is a work group: this many pixels wide, 4 or 8 high.
#define TILE_WIDTH 8u
// If kernels defer ties, the list of deferred rays: the groups of the program that traces them, 3 words as an indirect
// dispatch has them; how many rays there are; and their pixels, numbered row after row.
#define DEFERRED_COUNT 3u
#define DEFERRED_PIXELS 4u

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

// A half-face is one side of a face, tet << 2 | face: at most 2^30 - 1 tets.
#define NO_HALF_FACE 0xFFFFFFFFu
#define NO_TET 0x3FFFFFFFu
#define MAX_TETS 0x3FFFFFFFu
#define FREE_FACE 0xFFFFFFFFu // a face that belongs to no input triangle
#define NO_EXIT 4u            // instead of a face: the method found no exit

// Bindings: those of the arrays are 0 to 6; then the output, the counter of persistent threads, and the parts of the
// array of tets after the first, if one buffer cannot hold it.
#define SCENE_ARRAYS 7u
#define OUTPUT_BINDING 7u
#define COUNTER_BINDING 8u
#define SECOND_PART_BINDING 9u
#define MAX_TET_PARTS 8u
#define RAYS_BINDING (SECOND_PART_BINDING + MAX_TET_PARTS - 1u)
#define DEFERRED_BINDING (RAYS_BINDING + 1u)
#define FIRST_QUADS_BINDING 32u // of quads, where words and quads of one array have separate bindings

// tet80: quads of 16 bytes. 12 floats (vertex major), then 4 faces of 8 bytes {half-face, input triangle}.
#define TET80_QUADS 5u
// tet96: 4 vertices of 16 bytes (w is 0), then 4 faces of 8 bytes {half-face, input triangle}.
#define TET96_QUADS 6u
// Compilers compute with all four words of a quad at once, and some processors multiply denormal floats a hundred times
// slower. So a word next to coordinates is 0, or not a denormal as a float: numbers there are counted from this one.
#define NORMAL_BIAS 0x3F800000u
// half32: a record of 32 bytes for each tet and each face by which a ray may enter it, at its half-face (tet << 2 |
// face):
//   {apex.xyz, 0}  {exit 0, exit 1, exit 2, half-face of the entry face}
// Exit i leads through the face opposite corner i of the entry face: record << 2 | rotation where a tet follows: the
// corners of its entry face are the ray's three vertices, rotated by `rotation`. Else triangle << 2 | EXIT_END for
// the input triangle that is hit there, or NO_HALF_FACE at the domain's boundary.
#define HALF32_QUADS 2u // of a record; a tet has four
#define EXIT_END 3u
#define EXIT_AT_TIE                                                                                                    \
    (NO_HALF_FACE - 4u) // in a walk, instead of an exit that is not yet known: it ends loops as an end does
#define HALF32_MAX_TETS 0x0FFFFFFFu
#define HALF32_MAX_TRIANGLES 0x3FFFFFFEu // the next number is that of EXIT_AT_TIE
// tet64: a record is a quad, {vertex.xyz, what is across the face opposite it}, and a tet has four. That word is
//   EXIT_IS_NORMAL | record << 2 | fold   where a tet follows: vertex face ^ fold of this tet is vertex face' ^ fold of
//                                         that one, and the two others of the face are crossed; 3 is written as 0
//   EXIT_IS_NORMAL | row << 2 | EXIT_END        for an occlusive face, which has a row of `triangles`; or NO_HALF_FACE
#define EXIT_IS_NORMAL 0x40000000u
#define TET64_MAX_TETS 0x03FFFFFFu
#define TET64_MAX_ROWS 0x0FFFFFFFu
// tet20: {xor of the four vertices, what is across the face opposite each of them}, by the vertices' numbers ascending.
#define TET20_WORDS 5u
// tet16: a quad: tet20's words without the last, and each neighbour xor that last one.
// vertices of both: {x, y, z, 0}
// What is across a face: a tet, OCCLUSIVE | 2 * occlusive face + side, or NO_HALF_FACE.
#define OCCLUSIVE 0x80000000u
// occlusive_faces: {input triangle, the tet on side 0, that on side 1}
#define OCCLUSIVE_WORDS 3u
// entry_faces: {three vertices in the order of faces.h, tet}
// triangles: v0, v1 - v0, v2 - v0 of each input triangle, a quad of 16 bytes each (w is 0). In tet64 there is a row for
// each occlusive face, in the order of the tets, and w is NORMAL_BIAS + its input triangle, then EXIT_IS_NORMAL | its
// half-face on each side (NO_HALF_FACE outside the domain).
#define TRIANGLE_QUADS 3u

// leaf triangles of a BVH: {v0, input triangle}, {v1, 0}, {v2, 0}, as the mesh has them.
#define LEAF_TRIANGLE_QUADS 3u
// Boxes of BVHs are larger than their content by this much on every side, because the triangle test decides on rounded
// projections (docs/spec/bvhs.md, B7).
#define BOX_MARGIN 7.62939453125e-6f // 2^-17
// bvh2: both children's boxes and the children.
//   {a.low.x, a.high.x, a.low.y, a.high.y} {b.low.x, b.high.x, b.low.y, b.high.y}
//   {a.low.z, a.high.z, b.low.z, b.high.z} {a, b, 0, 0}
// A child is a node, or BVH2_LEAF | first << 4 | count for `count` leaf triangles from `first` on; an empty leaf has
// its sibling's box.
#define BVH2_NODE_QUADS 4u
#define BVH2_LEAF 0x80000000u
#define BVH2_STACK 64u // the most children that wait on a ray's stack: packing refuses deeper trees
// bvh4: the boxes of four children, component by component, and the children as in bvh2.
//   {low.x 0..3} {high.x 0..3} {low.y 0..3} {high.y 0..3} {low.z 0..3} {high.z 0..3} {children 0..3} {0, 0, 0, 0}
// An empty slot is an empty leaf, whose box no ray enters: it begins at BVH4_OUTSIDE and ends at -BVH4_OUTSIDE.
#define BVH4_NODE_QUADS 8u
#define BVH4_LEAF BVH2_LEAF
#define BVH4_OUTSIDE 1048576.0f // farther than any ray's origin
#define BVH4_STACK 96u          // the most children that wait on a ray's stack
// cwbvh: eight children, boxes as bytes on the node's own grid.
//   {origin.xyz, exponents of the grid in bytes 0 to 2, bits of the inner children in byte 3}
//   {first inner child, first leaf triangle, meta 0..3, meta 4..7}
//   {low.x 0..3, low.x 4..7, low.y 0..3, low.y 4..7} {low.z 0..3, low.z 4..7, high.x 0..3, high.x 4..7}
//   {high.y 0..3, high.y 4..7, high.z 0..3, high.z 4..7}
// meta: 0 of an empty slot; 0x20 | 24 + slot of an inner child; count in unary << 5 | offset of a leaf's triangles.
#define CWBVH_NODE_QUADS 5u
#define CWBVH_LEAF_TRIANGLES 3u
#define CWBVH_STACK 40u // the most pairs of words that wait on a ray's stack
// How many entries of a ray's stack GPUs keep in the work group's memory (kernels/stack.h).
#define STACK_TOP_OF_GPUS 6u
#define STACK_ENTRY_WORDS 2u

#endif
