#version 450
// Does nothing; its launch is timed.
layout(local_size_x = 1) in;

void main()
{
}
