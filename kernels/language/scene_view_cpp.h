// How kernels reach a scene's arrays in host C++: by name and index through FETCH, which checks the index in debug.
struct SceneView {
#define SCENE_ARRAY(element, name, member, binding)                                                                    \
    const element* name;                                                                                               \
    std::size_t name##_size;
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
    uint divisions;
};

template <class Stored, class Element>
void bind_array(const std::vector<Stored>& from, const Element*& array, std::size_t& size)
{
    static_assert(sizeof(Stored) % sizeof(Element) == 0);
    array = reinterpret_cast<const Element*>(from.data());
    size = from.size() * (sizeof(Stored) / sizeof(Element));
}

inline SceneView view_of(const tetrace::PackedScene& packed)
{
    SceneView view{};
#define SCENE_ARRAY(element, name, member, binding) bind_array(packed.member, view.name, view.name##_size);
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
    view.divisions = packed.divisions;
    return view;
}
