// entry_keys() of bvh4.h in vectors, which PoCL's compiler does not make of the four boxes by itself.
KERNEL_FN uint4 entry_keys(RayFrame frame, real limit, uint4 near_x, uint4 near_y, uint4 near_z, uint4 far_x,
                           uint4 far_y, uint4 far_z)
{
    float4 x0 = mad(as_float4(near_x), (float4)(frame.inverse.x), (float4)(-frame.offset.x));
    float4 y0 = mad(as_float4(near_y), (float4)(frame.inverse.y), (float4)(-frame.offset.y));
    float4 z0 = mad(as_float4(near_z), (float4)(frame.inverse.z), (float4)(-frame.offset.z));
    float4 x1 = mad(as_float4(far_x), (float4)(frame.inverse.x), (float4)(-frame.offset.x));
    float4 y1 = mad(as_float4(far_y), (float4)(frame.inverse.y), (float4)(-frame.offset.y));
    float4 z1 = mad(as_float4(far_z), (float4)(frame.inverse.z), (float4)(-frame.offset.z));
    float4 near = max(max(x0, y0), max(z0, (float4)(0.0f)));
    float4 far = min(min(x1, y1), min(z1, (float4)(limit)));
    int4 entered = near <= far * BOX_SLACK;
    return (as_uint4(near) & ~3u) | (uint4)(0u, 1u, 2u, 3u) | ~as_uint4(entered); // BVH4_NO_KEY has all bits
}
