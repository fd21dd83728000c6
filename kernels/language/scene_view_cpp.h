// How kernels reach a scene's arrays in host C++: by name and index through FETCH, which checks the index in debug.
// Small, because it is passed by value. The packed scene must stay where it is.
struct SceneView {
    const tetrace::PackedScene* packed;
    uint divisions;
    DomainBox domain;

#define SCENE_ARRAY(element, name, member, binding)                                                                    \
    [[nodiscard]] const element* name() const                                                                          \
    {                                                                                                                  \
        return reinterpret_cast<const element*>(packed->member.data());                                                \
    }                                                                                                                  \
    [[nodiscard]] std::size_t name##_size() const                                                                      \
    {                                                                                                                  \
        return packed->member.size() * sizeof(packed->member[0]) / sizeof(element);                                    \
    }
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
};

inline SceneView view_of(const tetrace::PackedScene& packed)
{
    const auto [divisions, low, high] = domain_of(packed);
    const auto place = [](tetrace::Float3 a) { return VEC3(real(a.x), real(a.y), real(a.z)); };
    return {&packed, divisions, {place(low), place(high)}};
}
