#pragma once

#include "backends/embree/accelerator.h"
#include "core/base/error.h"

#include <cstddef>
#include <span>

namespace tetrace::embree {

/// What a query's rays have in common.
enum class Coherence { coherent, incoherent };

/// A query of one ray, from parameter `near` to `end`.
[[nodiscard]] inline RTCRayHit query_of(Float3 origin, Float3 direction, float near, float end)
{
    RTCRayHit query{};
    query.ray.org_x = origin.x;
    query.ray.org_y = origin.y;
    query.ray.org_z = origin.z;
    query.ray.dir_x = direction.x;
    query.ray.dir_y = direction.y;
    query.ray.dir_z = direction.z;
    query.ray.tnear = near;
    query.ray.tfar = end;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

inline constexpr const char* no_streams = "Embree 4 lacks ray streams (rtcIntersectNM); Embree 3 has them";

// A query's options, and the order in which the two major versions take options and rays.
#if TETRACE_EMBREE_MAJOR >= 4
[[nodiscard]] inline RTCIntersectArguments to_intersect(Coherence coherence)
{
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = coherence == Coherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return arguments;
}
[[nodiscard]] inline RTCOccludedArguments to_occlude(Coherence coherence)
{
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = coherence == Coherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return arguments;
}
#define QUERY(rays, arguments) rays, arguments
#else
[[nodiscard]] inline RTCIntersectContext to_intersect(Coherence coherence)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}
[[nodiscard]] inline RTCIntersectContext to_occlude(Coherence coherence)
{
    return to_intersect(coherence);
}
#define QUERY(rays, context) context, rays
#endif

/// Finds the nearest hit of a ray.
inline void intersect(RTCScene scene, RTCRayHit& ray, Coherence coherence)
{
    auto how = to_intersect(coherence);
    rtcIntersect1(scene, QUERY(&ray, &how));
}
/// And of a packet. valid: -1 for each ray that is to be traced, else 0, aligned like the packet.
inline void intersect(RTCScene scene, const int* valid, RTCRayHit8& rays, Coherence coherence)
{
    auto how = to_intersect(coherence);
    rtcIntersect8(valid, scene, QUERY(&rays, &how));
}
inline void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays, Coherence coherence)
{
    auto how = to_intersect(coherence);
    rtcIntersect16(valid, scene, QUERY(&rays, &how));
}

/// Finds whether a ray hits anything: if so, its tfar becomes -inf.
inline void occlude(RTCScene scene, RTCRay& ray, Coherence coherence)
{
    auto how = to_occlude(coherence);
    rtcOccluded1(scene, QUERY(&ray, &how));
}
inline void occlude(RTCScene scene, const int* valid, RTCRay8& rays, Coherence coherence)
{
    auto how = to_occlude(coherence);
    rtcOccluded8(valid, scene, QUERY(&rays, &how));
}
inline void occlude(RTCScene scene, const int* valid, RTCRay16& rays, Coherence coherence)
{
    auto how = to_occlude(coherence);
    rtcOccluded16(valid, scene, QUERY(&rays, &how));
}
#undef QUERY

/// The same for streams of packets, in which a ray whose end is below its start is left out.
/// Throws Error{unsupported} with Embree 4.
template <class Packet, std::size_t count>
void intersect_stream(RTCScene scene, std::span<Packet, count> packets, Coherence coherence)
{
#if TETRACE_EMBREE_MAJOR >= 4
    static_cast<void>(scene), static_cast<void>(packets), static_cast<void>(coherence);
    throw Error(ErrorKind::unsupported, no_streams);
#else
    auto how = to_intersect(coherence);
    rtcIntersectNM(scene, &how, reinterpret_cast<RTCRayHitN*>(packets.data()), sizeof(Packet::ray.tfar) / sizeof(float),
                   static_cast<unsigned>(packets.size()), sizeof(Packet));
#endif
}
template <class Packet, std::size_t count>
void occlude_stream(RTCScene scene, std::span<Packet, count> packets, Coherence coherence)
{
#if TETRACE_EMBREE_MAJOR >= 4
    static_cast<void>(scene), static_cast<void>(packets), static_cast<void>(coherence);
    throw Error(ErrorKind::unsupported, no_streams);
#else
    auto how = to_occlude(coherence);
    rtcOccludedNM(scene, &how, reinterpret_cast<RTCRayN*>(packets.data()), sizeof(Packet::ray.tfar) / sizeof(float),
                  static_cast<unsigned>(packets.size()), sizeof(Packet));
#endif
}

} // namespace tetrace::embree
