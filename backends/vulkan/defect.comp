#version 450
// A reduced kernel as a compute shader; DEFECT is its name. Compiled by
// glslangValidator -V --target-env vulkan1.1 -DDEFECT=<name>.
#include "kernels/language/dialect_glsl.h"

layout(local_size_x = 16, local_size_x_id = 0) in;
layout(std430, set = 0, binding = 0) readonly buffer Words
{
    uint words[];
};
layout(std430, set = 0, binding = 1) writeonly buffer Results
{
    uint results[];
};

#define DEFECT_WORDS
#define DEFECT_PASSED
#define WORD(index) words[index]
#include "kernels/defects/defects.h"

void main()
{
    uint item = gl_GlobalInvocationID.x;
    if (item >= uint(results.length())) return;
    results[item] = DEFECT(item);
}
