// A quotient that has the same bits on every device.
#ifndef TETRACE_KERNELS_RECIPROCAL_H
#define TETRACE_KERNELS_RECIPROCAL_H

// Quotients that are compared must have the same bits everywhere; division does not guarantee that. a: normal, 2^-126
// to 2^124.
KERNEL_FN real reciprocal(real a)
{
    real guess = as_real(0x7EF311C3u - as_bits(a));
    PRECISE real first = guess * (real(2.0f) - a * guess);
    PRECISE real second = first * (real(2.0f) - a * first);
    PRECISE real third = second * (real(2.0f) - a * second);
    return third;
}

#endif
