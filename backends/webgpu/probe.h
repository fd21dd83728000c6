// The self-test as WGSL: an item runs an operation of kernels/probe.h.
#include "kernels/language/dialect_wgsl.h"

#include "kernels/probe.h"

STRUCT(LaunchWords)
{
    uint count;
    uint zero; // 0, which no compiler knows: see keep()
};

// clang-format off
storage(0) uint4 operations[];
storage(LAUNCH_BINDING) LaunchWords launch_words;
storage_written(OUTPUT_BINDING) uint output_words[];
// clang-format on

void run_item(uint group, uint item)
{
    uint number = group * 64u + item;
    if (number >= launch_words.count) return;
    uint4 operation = operations[number];
    output_words[number] = probe(operation.x, operation.y, operation.z, operation.w);
}
