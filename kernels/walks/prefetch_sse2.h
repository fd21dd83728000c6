// For next_face_predicted.h: what the next step loads across each of the three faces is prefetched, since a branch that
// is predicted wrongly loads another record (docs/spec/devices.md, W10). The words are in the cache line that this step
// loads. At an end of the walk they number no record.

KERNEL_FN void prefetch_quad(SceneView scene, std::size_t index)
{
    const auto begin = reinterpret_cast<std::uintptr_t>(scene.tet_quads()); // an index of no record is past the array
    _mm_prefetch(reinterpret_cast<const char*>(begin + sizeof(uint4) * index), _MM_HINT_T0);
}

KERNEL_FN void prefetch_next(SceneView scene, MAYBE_UNUSED uint record, MAYBE_UNUSED RecordExits exits)
{
#ifdef TETRACE_KERNELS_LAYOUTS_TET64_H
    for (uint i = 1u; i < 4u; ++i)
        prefetch_quad(scene, record_across(FETCH(scene, tet_quads, record ^ i).w));
#else
    prefetch_quad(scene, HALF32_QUADS * std::size_t{record_across(exits.x)});
    prefetch_quad(scene, HALF32_QUADS * std::size_t{record_across(exits.y)});
    prefetch_quad(scene, HALF32_QUADS * std::size_t{record_across(exits.z)});
#endif
}
