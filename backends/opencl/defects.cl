// The reduced kernels as an OpenCL program: an entry for each, run_<name>.
#include "kernels/language/dialect_opencl.h"

#define DEFECT_WORDS __global const uint *restrict words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/defects/defects.h"

#define DEFECT(name)                                                                                                   \
    __kernel void run_##name(__global const uint* restrict words, __global uint* restrict results)                     \
    {                                                                                                                  \
        uint item = (uint)get_global_id(0);                                                                            \
        results[item] = name(words, item);                                                                             \
    }
#include "kernels/defects/defect_list.inc"
