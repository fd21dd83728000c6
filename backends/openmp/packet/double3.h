// Vectors in double precision, for what is computed once per view.
struct Double3 {
    double x, y, z;
};
LANE_FN Double3 double3_of(const float* a)
{
    return {a[0], a[1], a[2]};
}
LANE_FN Double3 scaled(Double3 a, double factor)
{
    return {a.x * factor, a.y * factor, a.z * factor};
}
LANE_FN double dot(Double3 a, Double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LANE_FN Double3 cross(Double3 a, Double3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
LANE_FN double size_of(Double3 a)
{
    return __builtin_fabs(a.x) + __builtin_fabs(a.y) + __builtin_fabs(a.z);
}
