// From a job to a kernel's parameters, in host C++; include after view_cpp.h.
[[maybe_unused]] inline TraceParams params_of(const tetrace::TraceJob& job)
{
    TraceParams params = params_of(job.view);
    params.width = job.width;
    params.height = job.height;
    params.start_tet = job.start_tet;
    params.max_steps = job.max_steps;
    params.any_hit = job.any_hit ? 1u : 0u;
    params.start_v0 = job.start.vertices[0];
    params.start_v1 = job.start.vertices[1];
    params.start_v2 = job.start.vertices[2];
    params.start_v3 = job.start.vertices[3];
    params.start_neighbour = job.start.neighbour;
    return params;
}
