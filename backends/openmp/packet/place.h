// Vectors in double precision, for what is computed once per view.
struct Place {
    double x, y, z;
};
LANE_FN Place place_of(const float* a)
{
    return {a[0], a[1], a[2]};
}
LANE_FN Place scaled(Place a, double factor)
{
    return {a.x * factor, a.y * factor, a.z * factor};
}
LANE_FN double dot(Place a, Place b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LANE_FN Place cross(Place a, Place b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
LANE_FN double size_of(Place a)
{
    return __builtin_fabs(a.x) + __builtin_fabs(a.y) + __builtin_fabs(a.z);
}
