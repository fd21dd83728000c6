#version 460
// Traces through the driver's own BVH (acceleration.h). Rays are made or given as in kernel.comp, the rest is the
// driver's.
// A work group is a tile. TRACE or RAYS: the task.
#extension GL_EXT_ray_query : require
#include "kernels/language/dialect_glsl.h"

#include "kernels/language/vector.h"

#include "kernels/ray.h"

#include "kernels/hit.h"

#include "kernels/launch.h"

layout(local_size_x = TILE_WIDTH, local_size_y_id = 0) in; // constant 0 is the tile's height
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

Hit trace(Ray ray, real end)
{
    uint flags = gl_RayFlagsOpaqueEXT | (launch.trace.any_hit != 0u ? gl_RayFlagsTerminateOnFirstHitEXT : 0u);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, scene, flags, 0xFFu, vec3(ray.origin.x, ray.origin.y, ray.origin.z), real(0.0f),
                          vec3(ray.direction.x, ray.direction.y, ray.direction.z), end);
    while (rayQueryProceedEXT(query)) {} // all triangles are opaque: there are no candidates to confirm
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT)
        return make_no_hit(NO_HIT, NO_TET, 0u);
    vec2 weights = rayQueryGetIntersectionBarycentricsEXT(query, true);
    Hit hit;
    hit.face_id = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    hit.tet = NO_TET;
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    hit.u = weights.x;
    hit.v = weights.y;
    hit.steps = 0u;
    return hit;
}

void main()
{
    uint run = gl_WorkGroupID.y * gl_NumWorkGroups.z + gl_WorkGroupID.z; // as in kernel.comp
    uint tile = launch.first_tile + run * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    Pixel pixel = pixel_of(launch, tile, gl_LocalInvocationIndex);
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
