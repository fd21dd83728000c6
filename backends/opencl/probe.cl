// The self-test as an OpenCL program, and a kernel that does nothing, whose launch is timed.
#include "kernels/language/dialect_opencl.h"

#include "kernels/probe.h"

// One item per quad of {operation, a, b, c}.
__kernel void run_probe(__global const uint4* restrict operations, __global uint* restrict results)
{
    size_t item = get_global_id(0);
    uint4 quad = operations[item];
    results[item] = probe(quad.x, quad.y, quad.z, quad.w);
}

__kernel void do_nothing(void)
{
}
