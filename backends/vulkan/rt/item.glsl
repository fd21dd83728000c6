// What an item of a launch does with the driver's own BVH (acceleration.h), whatever stage it is of: it makes a ray, or
// reads the one that it is given, as in kernel.comp, and writes the answer of trace(), which the stage defines. TRACE or
// RAYS: the task.
#include "kernels/language/dialect_glsl.h"

#include "kernels/language/vector.h"

#include "kernels/ray.h"

#include "kernels/hit.h"

#include "kernels/launch.h"

layout(push_constant) uniform Launch
{
    LaunchParams launch;
};
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene; // where other kernels have their first array
layout(std430, set = 0, binding = OUTPUT_BINDING) writeonly buffer Output
{
    uint output_words[];
};
#ifdef RAYS
layout(std430, set = 0, binding = RAYS_BINDING) readonly buffer Rays
{
    uint4 rays[];
};
#endif

Hit trace(Ray ray, real end);

// All triangles are opaque: there are no candidates to confirm.
uint ray_flags()
{
    return gl_RayFlagsOpaqueEXT | (launch.trace.any_hit != 0u ? gl_RayFlagsTerminateOnFirstHitEXT : 0u);
}

Hit drivers_hit(uint triangle, real t, vec2 weights)
{
    Hit hit;
    hit.face_id = triangle;
    hit.tet = NO_TET;
    hit.t = t;
    hit.u = weights.x;
    hit.v = weights.y;
    hit.steps = 0u;
    return hit;
}

void trace_item(uint tile, uint item)
{
    Pixel pixel = pixel_of(launch, tile, item);
    if (!is_in_image(launch, pixel)) return;
#ifdef RAYS
    uint ray = ray_index(pixel);
    uint4 origin = rays[ray_count(launch) + ray];
    Hit hit = trace(given_ray(rays[ray], origin), as_real(origin.w));
#else
    Hit hit = trace(primary_ray(launch.trace, pixel.x, pixel.y), real(NO_END));
#endif
    uint word = output_word(launch, pixel);
    output_words[word] = hit.face_id;
    output_words[word + 1u] = hit.tet;
    output_words[word + 2u] = as_bits(hit.t);
    output_words[word + 3u] = as_bits(hit.u);
    output_words[word + 4u] = as_bits(hit.v);
    output_words[word + 5u] = hit.steps;
}
