// Layout tet16 (Aman, Demirci, Guedukbay 2022): a quad with the xor of a tet's four vertices, and the xor of each of
// three neighbours with the fourth. One neighbour determines the other three; a walk knows the one that it comes from.
#ifndef TETRACE_KERNELS_LAYOUTS_TET16_H
#define TETRACE_KERNELS_LAYOUTS_TET16_H

STRUCT(CompactTet)
{
    uint vertices; // xor of the four vertices
    uint n0;       // neighbours, each xor the last one, in the order of their opposite vertices
    uint n1;
    uint n2;
};

KERNEL_FN CompactTet compact_tet(SceneView scene, uint tet)
{
    uint4 quad = FETCH(scene, tet_quads, tet);
    CompactTet result;
    result.vertices = quad.x;
    result.n0 = quad.y;
    result.n1 = quad.z;
    result.n2 = quad.w;
    return result;
}

KERNEL_FN uint neighbour_code(CompactTet tet, uint rank)
{
    uint of_first = rank == 0u ? tet.n0 : tet.n1;
    uint of_last = rank == 2u ? tet.n2 : 0u;
    return rank < 2u ? of_first : of_last;
}

// What is across the face opposite the vertex of that rank among the four. known: the same for the vertex of
// `known_rank`.
KERNEL_FN uint neighbour(CompactTet tet, uint rank, uint known_rank, uint known)
{
    return neighbour_code(tet, rank) ^ neighbour_code(tet, known_rank) ^ known;
}

#define NEIGHBOUR(scene, tet, rank, known_rank, known) neighbour(tet, rank, known_rank, known)

#endif
