// The parameters of a launch, a ray, and how a pixel becomes a ray.
#ifndef TETRACE_KERNELS_RAY_H
#define TETRACE_KERNELS_RAY_H

STRUCT(TraceParams)
{
    Vec3 origin;
    Vec3 corner; // direction of pixel (0, 0)
    Vec3 step_x; // from a pixel to its right neighbour
    Vec3 step_y; // from a pixel to the one below
    uint width;
    uint height;
    uint start_tet; // tet that holds the origin, or NO_TET: rays enter the domain from outside
    uint max_steps;
    uint any_hit;  // != 0: any hit will do, so the first one found is returned
    uint start_v0; // vertices of start_tet, for tets that do not store their vertices (structure_compact.h)
    uint start_v1;
    uint start_v2;
    uint start_v3;
    uint start_neighbour; // what is across the face opposite the one with the highest number
};

// The number of steps after which a walk first checks whether it is in a circle.
KERNEL_FN uint first_pause(TraceParams params)
{
    return params.max_steps < STEPS_BEFORE_DOUBT ? params.max_steps : STEPS_BEFORE_DOUBT;
}

STRUCT(Ray)
{
    Vec3 origin;
    Vec3 direction;
    Vec3 moment; // origin x direction: with the direction, the ray's Pluecker coordinates
};

STRUCT(Hit)
{
    uint face_id;
    uint tet;
    real t;
    real u;
    real v;
    uint steps;
};

// Components below 2^-20 of the optical axis become zero: then no intermediate product is denormal
// (docs/spec/numbers.md, N1).
KERNEL_FN real flush_tiny(real a)
{
    return magnitude(a) < real(9.5367431640625e-7f) ? real(0.0f) : a;
}

KERNEL_FN Ray make_ray(Vec3 origin, Vec3 direction)
{
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.moment = cross3(origin, direction);
    return ray;
}

KERNEL_FN Ray primary_ray(TraceParams params, uint x, uint y)
{
    real px = to_real(x);
    real py = to_real(y);
    PRECISE real dx = params.corner.x + params.step_x.x * px + params.step_y.x * py;
    PRECISE real dy = params.corner.y + params.step_x.y * px + params.step_y.y * py;
    PRECISE real dz = params.corner.z + params.step_x.z * px + params.step_y.z * py;
    return make_ray(params.origin, VEC3(flush_tiny(dx), flush_tiny(dy), flush_tiny(dz)));
}

// A given ray, from its quads (layout.h).
KERNEL_FN Ray given_ray(uint4 direction, uint4 origin)
{
    return make_ray(VEC3(as_real(origin.x), as_real(origin.y), as_real(origin.z)),
                    VEC3(as_real(direction.x), as_real(direction.y), as_real(direction.z)));
}

#endif
