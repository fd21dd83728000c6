#pragma once

#include "core/mesh/triangle_mesh.h"

#include <atomic>
#include <cstdint>

#if TETRACE_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tetrace::embree {

/// The options of a query to Embree; the two major versions spell them differently.
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

/// A triangle mesh in an Embree scene of its own device, built with quality high.
class Accelerator {
public:
    /// robust: Embree's watertight mode, which tests compare the oracle with. threads: of the build.
    /// Throws Error{internal} with Embree's reason.
    Accelerator(const TriangleMesh& mesh, bool robust, unsigned threads);
    ~Accelerator();
    Accelerator(const Accelerator&) = delete;
    Accelerator& operator=(const Accelerator&) = delete;

    [[nodiscard]] double build_s() const { return build_s_; }
    [[nodiscard]] std::uint64_t bytes() const { return static_cast<std::uint64_t>(bytes_.load()); }

    void intersect(RTCRayHit& ray, Coherence coherence) const;
    void intersect16(const int* valid, RTCRayHit16& rays, Coherence coherence) const;
    /// Whether anything is hit: if so, a ray's tfar becomes -inf.
    void occluded(RTCRay& ray, Coherence coherence) const;
    void occluded16(const int* valid, RTCRay16& rays, Coherence coherence) const;

private:
    static bool count_bytes(void* accelerator, ssize_t bytes, bool post);

    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    std::atomic<std::int64_t> bytes_ = 0;
    double build_s_ = 0;
};

/// "Embree 3.13.5"
[[nodiscard]] const char* version_text();

} // namespace tetrace::embree
