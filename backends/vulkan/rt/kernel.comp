#version 460
// Traces by ray queries. A work group is a tile.
#extension GL_EXT_ray_query : require
#include "backends/vulkan/rt/item.glsl"

layout(local_size_x = TILE_WIDTH, local_size_y_id = 0) in; // constant 0 is the tile's height

Hit trace(Ray ray, real end)
{
    rayQueryEXT query;
    rayQueryInitializeEXT(query, scene, ray_flags(), 0xFFu, vec3(ray.origin.x, ray.origin.y, ray.origin.z), real(0.0f),
                          vec3(ray.direction.x, ray.direction.y, ray.direction.z), end);
    while (rayQueryProceedEXT(query)) {}
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT)
        return make_no_hit(NO_HIT, NO_TET, 0u);
    return drivers_hit(uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true)),
                       rayQueryGetIntersectionTEXT(query, true), rayQueryGetIntersectionBarycentricsEXT(query, true));
}

void main()
{
    uint run = gl_WorkGroupID.y * gl_NumWorkGroups.z + gl_WorkGroupID.z; // as in kernel.comp of all other layouts
    trace_item(launch.first_tile + run * gl_NumWorkGroups.x + gl_WorkGroupID.x, gl_LocalInvocationIndex);
}
