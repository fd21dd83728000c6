// Layout tet20 (Aman, Demirci, Guedukbay 2022): the xor of a tet's four vertices, then its four neighbours in the order
// of their opposite vertices.
#ifndef TETRACE_KERNELS_LAYOUTS_TET20_H
#define TETRACE_KERNELS_LAYOUTS_TET20_H

STRUCT(CompactTet)
{
    uint first_word;
    uint vertices; // xor of the four vertices
};

KERNEL_FN CompactTet compact_tet(SceneView scene, uint tet)
{
    CompactTet result;
    result.first_word = TET20_WORDS * tet;
    result.vertices = FETCH(scene, tet_words, TET20_WORDS * tet);
    return result;
}

// What is across the face opposite the vertex of that rank among the four.
KERNEL_FN uint neighbour(SceneView scene, CompactTet tet, uint rank)
{
    return FETCH(scene, tet_words, tet.first_word + 1u + rank);
}

#define NEIGHBOUR(scene, tet, rank, known_rank, known) neighbour(scene, tet, rank)

#endif
