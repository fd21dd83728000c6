// How kernels reach a scene's arrays in OpenCL C: by name and index through FETCH. Build option TETS_IN_PARTS: the tets
// are in several buffers.

// The parts of the tets after the first, which is the scene's array itself.
#define MORE_TET_PARTS(DO) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)

STRUCT(SceneView)
{
#define SCENE_ARRAY(element, name, member, binding) __global const element* name;
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
    uint divisions;
    DomainBox domain;
#ifdef STACK_TOP
    __local uint* group_words; // kernels/stack.h
#endif
#ifdef TETS_IN_PARTS
#define PART_MEMBER(number) __global const uint4* part_##number;
    MORE_TET_PARTS(PART_MEMBER)
    uint part_log2; // bytes of a part
#endif
};

#ifndef TETS_IN_PARTS
#define FETCH(scene, array, index) ((scene).array[(index)])
#else
#define FETCH(scene, array, index) fetch_##array((scene), (index))

// Selected, not indexed: some devices would keep an array of pointers in memory.
KERNEL_FN __global const uint4* tet_part(SceneView scene, uint part)
{
    __global const uint4* of_01 = (part & 1u) == 0u ? scene.tet_quads : scene.part_1;
    __global const uint4* of_23 = (part & 1u) == 0u ? scene.part_2 : scene.part_3;
    __global const uint4* of_45 = (part & 1u) == 0u ? scene.part_4 : scene.part_5;
    __global const uint4* of_67 = (part & 1u) == 0u ? scene.part_6 : scene.part_7;
    __global const uint4* of_0123 = (part & 2u) == 0u ? of_01 : of_23;
    __global const uint4* of_4567 = (part & 2u) == 0u ? of_45 : of_67;
    return (part & 4u) == 0u ? of_0123 : of_4567;
}

// fetch_<array>() for each array. Only the tets, binding 0, come in parts; the compiler knows the binding.
#define SCENE_ARRAY(element, name, member, binding)                                                                    \
    KERNEL_FN element fetch_##name(SceneView scene, uint index)                                                        \
    {                                                                                                                  \
        uint part_size_log2 = scene.part_log2 - (sizeof(element) == 16u ? 4u : 2u);                                    \
        __global const element* base =                                                                                 \
            binding == 0 ? (__global const element*)tet_part(scene, index >> part_size_log2) : scene.name;             \
        return base[binding == 0 ? index & ((1u << part_size_log2) - 1u) : index];                                     \
    }
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
#endif
