// The kernels' language as the text that backends/webgpu/wgsl translates to WGSL; include it before kernel.h or
// probe.h. Functions without a body are those of backends/webgpu/prelude.wgsl.
#include "kernels/layouts/layout.h"

#define KERNEL_FN
#define RARE_FN
#define MAYBE_UNUSED
#define KEEP_LOOP
#define STRUCT(name) struct name
#define VEC3(x, y, z) Vec3(x, y, z)
#define PRECISE precise

real as_real(uint bits);
uint as_bits(real value);
real magnitude(real value);
real to_real(uint value);
// Rounded down. value: not negative.
uint to_uint(real value);
real square_root(real value);
// a * b + c, rounded once or twice: only for what decides nothing, such as the boxes of BVHs (docs/spec/bvhs.md, B7).
real multiply_add(real a, real b, real c);
real minimum(real a, real b);
real maximum(real a, real b);
uint highest_bit(uint value);
uint bit_count(uint value);
// The high word of the product of two words.
uint high_product(uint a, uint b);
