// The boxes of a node of bvh2 for processors, in four lanes: x and y of one child, then of the other. Depths have the
// bits of box_entry() (docs/spec/bvhs.md, B13).

// Where a ray enters a node's boxes.
STRUCT(Entries)
{
    real a;
    real b;
    uint met; // 1: the first box; 4: the second; 5: both
};

KERNEL_FN const float* node_of(SceneView scene, uint node)
{
    return reinterpret_cast<const float*>(&FETCH(scene, nodes, BVH2_NODE_QUADS * node));
}

KERNEL_FN Entries entries_of(const float* node, const RayFrame& frame, real limit)
{
    const __m128 inverse_xy = _mm_unpacklo_ps(frame.inverse, frame.inverse);
    const __m128 offset_xy = _mm_unpacklo_ps(frame.offset, frame.offset);
    const __m128 inverse_z = _mm_shuffle_ps(frame.inverse, frame.inverse, 0xAA);
    const __m128 offset_z = _mm_shuffle_ps(frame.offset, frame.offset, 0xAA);
    const __m128 a = _mm_loadu_ps(node) * inverse_xy - offset_xy;
    const __m128 b = _mm_loadu_ps(node + 4) * inverse_xy - offset_xy;
    const __m128 z = _mm_loadu_ps(node + 8) * inverse_z - offset_z;
    const __m128 low = _mm_shuffle_ps(a, b, _MM_SHUFFLE(2, 0, 2, 0)); // x, y of a, x, y of b
    const __m128 high = _mm_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 3, 1));
    const __m128 other_z = _mm_shuffle_ps(z, z, _MM_SHUFFLE(2, 3, 0, 1));
    const __m128 near_xy = _mm_min_ps(low, high), far_xy = _mm_max_ps(low, high);
    const __m128 near_z = _mm_max_ps(_mm_min_ps(z, other_z), _mm_setzero_ps());
    const __m128 far_z = _mm_min_ps(_mm_max_ps(z, other_z), _mm_set1_ps(limit));
    const __m128 near =
        _mm_max_ps(_mm_max_ps(near_xy, _mm_shuffle_ps(near_xy, near_xy, _MM_SHUFFLE(2, 3, 0, 1))), near_z);
    const __m128 far = _mm_min_ps(_mm_min_ps(far_xy, _mm_shuffle_ps(far_xy, far_xy, _MM_SHUFFLE(2, 3, 0, 1))), far_z);
    const int met = _mm_movemask_ps(_mm_cmple_ps(near, far * _mm_set1_ps(BOX_SLACK)));
    return {_mm_cvtss_f32(near), _mm_cvtss_f32(_mm_movehl_ps(near, near)), static_cast<uint>(met & 5)};
}
