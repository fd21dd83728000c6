#version 450
// A loop of more than 65,535 iterations. Read tests/expected/README.md.
layout(local_size_x = 16) in;
layout(std430, set = 0, binding = 0) readonly buffer Values
{
    uint values[];
};
layout(std430, set = 0, binding = 1) writeonly buffer Results
{
    uint results[];
};

void main()
{
    uint item = gl_GlobalInvocationID.x;
    uint value = values[item];
    for (uint i = 0u; i < 70000u; i++)
        value = value * 1664525u + 1013904223u;
    results[item] = value;
}
