#version 450
// A value that is loaded in a loop which items leave at different times, and used after it. Read tests/expected/README.md.
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
    uint count = 0u;
    uint value;
    do {
        value = values[count];
        count++;
    } while (value != item && count < 64u);
    results[item] = value;
}
