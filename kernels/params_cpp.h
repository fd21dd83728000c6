// From a job to what a kernel gets, in host C++.
inline Vec3 to_vec3(tetrace::Float3 a)
{
    return VEC3(real(a.x), real(a.y), real(a.z));
}

[[maybe_unused]] inline TraceParams params_of(const tetrace::TraceJob& job)
{
    return {to_vec3(job.view.origin),
            to_vec3(job.view.corner),
            to_vec3(job.view.step_x),
            to_vec3(job.view.step_y),
            job.width,
            job.height,
            job.start_tet,
            job.max_steps,
            job.any_hit ? 1u : 0u,
            job.start.vertices[0],
            job.start.vertices[1],
            job.start.vertices[2],
            job.start.vertices[3],
            job.start.neighbour};
}
