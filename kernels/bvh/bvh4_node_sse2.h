// A node in bvh4's loop, four boxes at once.
{
    // Not in uint, whose products wrap: that would be more instructions before the node is read.
    const uint4* const node = &FETCH(scene, nodes, std::size_t{BVH4_NODE_QUADS} * child);
    const float* const planes = reinterpret_cast<const float*>(node);
    const uint4& children = node[6];
    // What the ray meets first along an axis is four floats, one quad, farther where it goes down.
    const uint down = static_cast<uint>(_mm_movemask_ps(frame.inverse));
    const uint down_x = down << 2u & 4u, down_y = down << 1u & 4u, down_z = down & 4u;
    const __m128 x0 = _mm_loadu_ps(planes + down_x) * frame.inverses.x - frame.offsets.x;
    const __m128 y0 = _mm_loadu_ps(planes + 8u + down_y) * frame.inverses.y - frame.offsets.y;
    const __m128 z0 = _mm_loadu_ps(planes + 16u + down_z) * frame.inverses.z - frame.offsets.z;
    const __m128 x1 = far_depths(planes + (4u - down_x), frame.inverses.x, frame.offsets.x);
    const __m128 y1 = far_depths(planes + (12u - down_y), frame.inverses.y, frame.offsets.y);
    const __m128 z1 = far_depths(planes + (20u - down_z), frame.inverses.z, frame.offsets.z);
    const __m128 near = _mm_max_ps(_mm_max_ps(x0, y0), _mm_max_ps(z0, _mm_setzero_ps()));
    const __m128 far = _mm_min_ps(_mm_min_ps(x1, y1), _mm_min_ps(z1, _mm_set1_ps(nearest.limit)));
    const uint entered = static_cast<uint>(_mm_movemask_ps(_mm_cmple_ps(near, far * _mm_set1_ps(BOX_SLACK))));
    alignas(16) uint4 keys;
    _mm_store_si128(reinterpret_cast<__m128i*>(&keys), _mm_and_si128(_mm_castps_si128(near), _mm_set1_epi32(~3)));
#include "kernels/bvh/bvh4_children_predicted.h"
}
