#version 460
// A ray that meets nothing, for kernel.rgen.
#extension GL_EXT_ray_tracing : require
#include "kernels/layouts/layout.h"

layout(location = 0) rayPayloadInEXT uvec4 answer;

void main()
{
    answer.x = NO_HIT;
}
