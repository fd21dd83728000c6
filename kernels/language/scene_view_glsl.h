// How kernels reach a scene's arrays in GLSL: storage buffers by name, and FETCH(). A buffer that is read both as words
// and as quads is declared twice with one binding.
#define SCENE_ARRAY(element, name, member, number)                                                                     \
    layout(std430, set = 0, binding = number) restrict readonly buffer Buffer_##name                                   \
    {                                                                                                                  \
        element name[];                                                                                                \
    };
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY

STRUCT(SceneView)
{
    uint divisions;
    DomainBox domain;
    uint part_log2; // tets in several buffers: log2 of the bytes of each but the last
};

#ifndef TETS_IN_PARTS
#define FETCH(scene, array, index) array[index]
#else
#define FETCH(scene, array, index) fetch_##array(scene, index)

// The parts of the tets after the first, which is the scene's array itself.
#define TET_PART(part)                                                                                                 \
    layout(std430, set = 0,                                                                                            \
           binding = SECOND_PART_BINDING - 1u + part) restrict readonly buffer Buffer_tet_words_##part                 \
    {                                                                                                                  \
        uint tet_words_##part[];                                                                                       \
    };                                                                                                                 \
    layout(std430, set = 0,                                                                                            \
           binding = SECOND_PART_BINDING - 1u + part) restrict readonly buffer Buffer_tet_quads_##part                 \
    {                                                                                                                  \
        uint4 tet_quads_##part[];                                                                                      \
    };
TET_PART(1)
TET_PART(2)
TET_PART(3)
TET_PART(4)
TET_PART(5)
TET_PART(6)
TET_PART(7)
#undef TET_PART

// element_log2: log2 of an element's bytes.
#define FETCH_FROM_PARTS(element, array, element_log2)                                                                 \
    KERNEL_FN element fetch_##array(SceneView scene, uint index)                                                       \
    {                                                                                                                  \
        uint part_log2 = scene.part_log2 - element_log2;                                                               \
        uint inside = index & ((1u << part_log2) - 1u);                                                                \
        switch (index >> part_log2) {                                                                                  \
        case 1u: return array##_1[inside];                                                                             \
        case 2u: return array##_2[inside];                                                                             \
        case 3u: return array##_3[inside];                                                                             \
        case 4u: return array##_4[inside];                                                                             \
        case 5u: return array##_5[inside];                                                                             \
        case 6u: return array##_6[inside];                                                                             \
        case 7u: return array##_7[inside];                                                                             \
        default: return array[inside];                                                                                 \
        }                                                                                                              \
    }
FETCH_FROM_PARTS(uint, tet_words, 2u)
FETCH_FROM_PARTS(uint4, tet_quads, 4u)
#undef FETCH_FROM_PARTS

#define fetch_triangles(scene, index) triangles[index]
#define fetch_lines(scene, index) lines[index]
#define fetch_entry_ranges(scene, index) entry_ranges[index]
#define fetch_entry_half_faces(scene, index) entry_half_faces[index]
#define fetch_entry_faces(scene, index) entry_faces[index]
#define fetch_vertices(scene, index) vertices[index]
#define fetch_occlusive_faces(scene, index) occlusive_faces[index]
#endif
