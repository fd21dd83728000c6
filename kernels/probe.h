// The self-test: one operation per work item, or a few that a compiler which reassociates would shorten; they show how
// a device computes. core/device/self_test.h makes the inputs and judges the outputs. A dialect defines as_real,
// as_bits, to_real and square_root.
#include "kernels/layouts/probe_chains.h"

KERNEL_FN uint probe(uint operation, uint a, uint b, uint c)
{
    real x = as_real(a);
    real y = as_real(b);
    real z = as_real(c);
    PRECISE real multiply_add = x * y + z;
    PRECISE real quotient = x / y;
    PRECISE real sum = x + y;
    PRECISE real product = x * z; // not x * y: multiply_add would share that product instead of fusing it
    PRECISE real root = square_root(x);
    real converted = to_real(a);
    // Dekker's split: x, if sums may be reassociated.
    PRECISE real large = x * real(4097.0f);
    PRECISE real high = large - (large - x);
    PRECISE real cancelled = (x + z) - z; // not x + y, which sum would share
    PRECISE real scaled = (x * real(3.0f)) * real(5.0f);
    uint result = a;
    result = operation == PROBE_MULTIPLY_ADD ? as_bits(multiply_add) : result;
    result = operation == PROBE_DIVIDE ? as_bits(quotient) : result;
    result = operation == PROBE_ADD ? as_bits(sum) : result;
    result = operation == PROBE_MULTIPLY ? as_bits(product) : result;
    result = operation == PROBE_SQUARE_ROOT ? as_bits(root) : result;
    result = operation == PROBE_CONVERT ? as_bits(converted) : result;
    result = operation == PROBE_COMPARE ? (x < y ? 1u : 0u) + (x <= y ? 2u : 0u) + (x == y ? 4u : 0u) : result;
    result = operation == PROBE_INTEGER ? ((a * b + c) >> (c & 31u)) ^ (a << (b & 31u)) : result;
    result = operation == PROBE_SPLIT ? as_bits(high) : result;
    result = operation == PROBE_CANCEL ? as_bits(cancelled) : result;
    result = operation == PROBE_SCALE ? as_bits(scaled) : result;
    return result;
}
