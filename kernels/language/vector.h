// Vectors without operators: the result of every operation is a named local, so that a dialect can forbid contraction.
STRUCT(Vec3)
{
    real x;
    real y;
    real z;
};

// The box that the tets fill.
STRUCT(DomainBox)
{
    Vec3 low;
    Vec3 high;
};

KERNEL_FN Vec3 sub3(Vec3 a, Vec3 b)
{
    PRECISE real x = a.x - b.x;
    PRECISE real y = a.y - b.y;
    PRECISE real z = a.z - b.z;
    return VEC3(x, y, z);
}

KERNEL_FN real dot3(Vec3 a, Vec3 b)
{
    PRECISE real sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

KERNEL_FN Vec3 cross3(Vec3 a, Vec3 b)
{
    PRECISE real x = a.y * b.z - a.z * b.y;
    PRECISE real y = a.z * b.x - a.x * b.z;
    PRECISE real z = a.x * b.y - a.y * b.x;
    return VEC3(x, y, z);
}

KERNEL_FN real component(Vec3 a, uint axis)
{
    return axis == 0u ? a.x : axis == 1u ? a.y : a.z;
}

KERNEL_FN Vec3 magnitudes(Vec3 a)
{
    return VEC3(magnitude(a.x), magnitude(a.y), magnitude(a.z));
}

// cross3() with all signs positive: what its rounding errors are shares of.
KERNEL_FN Vec3 cross3_size(Vec3 a, Vec3 b)
{
    PRECISE real x = a.y * b.z + a.z * b.y;
    PRECISE real y = a.z * b.x + a.x * b.z;
    PRECISE real z = a.x * b.y + a.y * b.x;
    return VEC3(x, y, z);
}
