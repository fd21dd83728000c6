// A reduced kernel as an OpenCL program; DEFECT is its name, from outside.
#include "kernels/language/dialect_opencl.h"

#define DEFECT_WORDS __global const uint *restrict words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/defects/defects.h"

__kernel void run_defect(__global const uint* restrict words, __global uint* restrict results, uint count)
{
    uint item = (uint)get_global_id(0);
    if (item >= count) return;
    results[item] = DEFECT(words, item);
}
