#version 450
// The self-test as a compute shader: one item per quad of {operation, a, b, c}.
#include "kernels/language/dialect_glsl.h"

#include "kernels/probe.h"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Operations
{
    uint4 operations[];
};
layout(std430, set = 0, binding = 1) writeonly buffer Results
{
    uint results[];
};

void main()
{
    uint item = gl_GlobalInvocationID.x;
    if (item >= uint(operations.length())) return;
    uint4 quad = operations[item];
    results[item] = probe(quad.x, quad.y, quad.z, quad.w);
}
