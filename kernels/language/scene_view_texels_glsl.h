// How kernels reach a scene's arrays in GLSL on devices that read storage buffers slowly: as texels of one or four
// unsigned words, by name through FETCH(). Same bytes and same answers as by scene_view_glsl.h. An array of quads is
// bound at its binding + FIRST_QUADS_BINDING: the tets are bound twice.
#define TEXELS_BINDING_uint 0
#define TEXELS_BINDING_uint4 FIRST_QUADS_BINDING
#define SCENE_ARRAY(element, name, member, number)                                                                     \
    layout(set = 0, binding = TEXELS_BINDING_##element + number) uniform usamplerBuffer name;                          \
    element fetch_##name(uint index)                                                                                   \
    {                                                                                                                  \
        return element(texelFetch(name, int(index)));                                                                  \
    }
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
#define FETCH(scene, array, index) fetch_##array(index)
#define QUADS_COST_AS_WORDS // a texel is a texel

STRUCT(SceneView)
{
    uint divisions;
    DomainBox domain;
    uint part_log2; // tets do not come in parts here
};
