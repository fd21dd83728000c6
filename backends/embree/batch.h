#pragma once

#include "backends/embree/queries.h"
#include "core/rays/hit.h"
#include "core/rays/ray_set.h"

#include <span>

namespace tetrace::embree {

/// The hit of a query for the nearest triangle.
[[nodiscard]] inline Hit nearest_hit(unsigned primitive, float t, float u, float v)
{
    if (primitive == RTC_INVALID_GEOMETRY_ID) return {NO_HIT, NO_TET, 0, 0, 0, 0};
    return {primitive, NO_TET, t, u, v, 0};
}

/// The hit of an occlusion query, which sets the end of an occluded ray to -inf.
[[nodiscard]] inline Hit any_hit(float end)
{
    return {end < 0 ? SOME_HIT : NO_HIT, NO_TET, 0, 0, 0, 0};
}

template <unsigned width>
struct PacketOf;
template <>
struct PacketOf<8> {
    using Type = RTCRayHit8;
};
template <>
struct PacketOf<16> {
    using Type = RTCRayHit16;
};

/// Packets of `width` rays for one call of Embree: one packet, or a stream of them.
template <unsigned width, unsigned packets>
class Batch {
public:
    void set(unsigned packet, unsigned lane, Float3 origin, Float3 direction, float end)
    {
        auto& [in, out] = packets_[packet];
        in.org_x[lane] = origin.x;
        in.org_y[lane] = origin.y;
        in.org_z[lane] = origin.z;
        in.dir_x[lane] = direction.x;
        in.dir_y[lane] = direction.y;
        in.dir_z[lane] = direction.z;
        in.tnear[lane] = 0;
        in.tfar[lane] = end;
        in.time[lane] = 0;
        in.mask[lane] = ~0u;
        in.id[lane] = 0;
        in.flags[lane] = 0;
        out.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        out.primID[lane] = RTC_INVALID_GEOMETRY_ID;
        out.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        if constexpr (packets == 1) valid_[lane] = -1;
    }

    /// Leaves a ray out.
    void clear(unsigned packet, unsigned lane)
    {
        set(packet, lane, {}, {1, 0, 0}, -1);
        if constexpr (packets == 1) valid_[lane] = 0;
    }

    void trace(RTCScene scene, bool any_hit, Coherence coherence)
    {
        if constexpr (packets == 1)
            any_hit ? occlude(scene, valid_, packets_[0].ray, coherence)
                    : intersect(scene, valid_, packets_[0], coherence);
        else
            any_hit ? occlude_stream(scene, std::span(packets_), coherence)
                    : intersect_stream(scene, std::span(packets_), coherence);
    }

    [[nodiscard]] Hit hit(unsigned packet, unsigned lane, bool any_hit) const
    {
        const auto& [in, out] = packets_[packet];
        return any_hit ? embree::any_hit(in.tfar[lane])
                       : nearest_hit(out.primID[lane], in.tfar[lane], out.u[lane], out.v[lane]);
    }

private:
    alignas(64) typename PacketOf<width>::Type packets_[packets];
    alignas(64) int valid_[width];
};

} // namespace tetrace::embree
