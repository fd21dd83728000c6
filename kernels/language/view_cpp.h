// A camera's view as kernel parameters, in host C++, for inclusion in an unnamed namespace (see dialect_cpp.h).
inline Vec3 to_vec3(tetrace::Float3 a)
{
    return VEC3(real(a.x), real(a.y), real(a.z));
}

// The parameters that primary rays are made from; the others are 0.
[[maybe_unused]] inline TraceParams params_of(const tetrace::View& view)
{
    TraceParams params{};
    params.origin = to_vec3(view.origin);
    params.corner = to_vec3(view.corner);
    params.step_x = to_vec3(view.step_x);
    params.step_y = to_vec3(view.step_y);
    return params;
}
