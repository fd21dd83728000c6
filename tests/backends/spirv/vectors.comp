#version 450
// What the data must not become: push constants with vectors of three, and quads that are read as words.
layout(local_size_x = 8) in;
struct TraceParams {
    vec3 origin;
    vec3 corner;
    vec3 step_x;
    vec3 step_y;
    uint width;
    uint height;
    uint start_tet;
    uint max_steps;
};
struct LaunchParams {
    TraceParams trace;
    uint divisions;
    uint first_tile;
    uint tile_height;
    uint part_log2;
};
layout(push_constant) uniform Launch
{
    LaunchParams launch;
};
layout(std430, set = 0, binding = 1) readonly buffer Buffer_triangles
{
    uint triangles[];
};
layout(std430, set = 0, binding = 7) writeonly buffer Output
{
    uint output_words[];
};

void main()
{
    output_words[0] = triangles[launch.first_tile] + launch.trace.width;
}
