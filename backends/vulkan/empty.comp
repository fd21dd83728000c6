#version 450
// Does nothing; its launch is timed. It has as many items as a tile: RADV gives small groups smaller subgroups, and its
// kernels' subgroups are counted against this one's (bench/inspection).
layout(local_size_x = 64) in;

void main()
{
}
