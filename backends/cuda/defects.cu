// The reduced kernels (kernels/defects/defects.h), an entry for each, run_<name>; one item per thread.
#include "kernels/layouts/layout.h"

#include "kernels/language/dialect_cuda.h"

#define DEFECT_WORDS const uint *words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/defects/defects.h"

#define DEFECT(name)                                                                                                   \
    extern "C" __global__ void run_##name(const uint* words, uint* results, uint count)                                \
    {                                                                                                                  \
        uint index = blockIdx.x * blockDim.x + threadIdx.x;                                                            \
        if (index >= count) return;                                                                                    \
        results[index] = name(words, index);                                                                           \
    }
#include "kernels/defects/defect_list.inc"
