#version 460
// A ray's nearest hit, or its first one, for kernel.rgen.
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT uvec4 answer;
hitAttributeEXT vec2 weights;

void main()
{
    answer = uvec4(uint(gl_PrimitiveID), floatBitsToUint(gl_HitTEXT), floatBitsToUint(weights.x),
                   floatBitsToUint(weights.y));
}
