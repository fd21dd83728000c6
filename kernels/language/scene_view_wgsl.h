// How kernels reach a scene's arrays in WGSL: storage buffers by name. An array that is read both as words and as quads
// is declared twice with one binding; a kernel reads it in one way only, which is what WGSL allows.
#define SCENE_ARRAY(element, name, member, binding) storage(binding) element name[];
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY

STRUCT(SceneView)
{
    uint divisions;
    DomainBox domain;
};

#define FETCH(scene, array, index) array[index]
