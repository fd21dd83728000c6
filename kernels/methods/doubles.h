// A ray and points in double precision, for methods of other programs that compute in it. The kernels' other languages
// have no doubles, so these methods are openmp's alone.
#ifndef TETRACE_KERNELS_METHODS_DOUBLES_H
#define TETRACE_KERNELS_METHODS_DOUBLES_H

#include "kernels/ray.h"

STRUCT(Double3)
{
    double x;
    double y;
    double z;
};

KERNEL_FN Double3 in_double(Vec3 a)
{
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

KERNEL_FN Double3 operator-(Double3 a, Double3 b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

KERNEL_FN Double3 operator+(Double3 a, Double3 b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

KERNEL_FN Double3 operator*(double factor, Double3 a)
{
    return {factor * a.x, factor * a.y, factor * a.z};
}

KERNEL_FN double dot_of(Double3 a, Double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

KERNEL_FN Double3 cross_of(Double3 a, Double3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

#endif
