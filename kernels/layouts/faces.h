// The corners of a tet's faces, for tets with det(V1-V0, V2-V0, V3-V0) < 0, as 2-bit entries of one word: some devices
// would keep an array that is indexed at run time in memory.
//   face 0: 1 2 3    face 1: 0 3 2    face 2: 0 1 3    face 3: 0 2 1
// A line that enters through the face has side(c0, c1), side(c1, c2), side(c2, c0) >= 0.
#ifndef TETRACE_KERNELS_LAYOUTS_FACES_H
#define TETRACE_KERNELS_LAYOUTS_FACES_H

KERNEL_FN uint corner(uint face, uint index)
{
    return (0x634B39u >> (6u * face + 2u * index)) & 3u;
}

// Table of exits: the face by which a ray that entered by `entry` leaves, for outcomes 0, 1, 2 of the two tests of
// maria or project; 2-bit entries as in corner().
//   entry 0: 2 3 1    entry 1: 3 2 0    entry 2: 1 3 0    entry 3: 2 1 0
KERNEL_FN uint other_face(uint entry, uint outcome)
{
    return (0x18D2DEu >> (6u * entry + 2u * outcome)) & 3u;
}

#endif
