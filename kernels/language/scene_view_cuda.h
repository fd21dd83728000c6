// How kernels reach a scene's arrays in CUDA C++: by name and index through FETCH, in one address space, never in
// parts. backends/cuda/session.cpp builds the same struct word for word.
#define FETCH(scene, array, index) __ldg((scene).array + (index)) // a scene is never written: a read-only load

STRUCT(SceneView)
{
#define SCENE_ARRAY(element, name, member, binding) const element* __restrict__ name;
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
    uint divisions;
    DomainBox domain;
};
