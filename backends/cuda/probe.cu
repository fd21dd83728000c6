// The self-test (kernels/probe.h), one operation per thread. KERNEL_NAME is probe_exact or probe_fast.
#include "kernels/layouts/layout.h"

#include "kernels/language/dialect_cuda.h"

#include "kernels/probe.h"

extern "C" __global__ void KERNEL_NAME(const uint4* operations, uint* results, uint count)
{
    uint index = blockIdx.x * blockDim.x + threadIdx.x;
    if (index >= count) return;
    uint4 quad = operations[index];
    results[index] = probe(quad.x, quad.y, quad.z, quad.w);
}
