#include "backends/embree/accelerator.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"

#include <algorithm>
#include <string>

namespace tetrace::embree {
namespace {

void check(RTCDevice device, const char* doing)
{
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw Error(ErrorKind::internal, std::string("Embree, ") + doing + ": error " + std::to_string(error));
}

void attach_mesh(RTCDevice device, RTCScene scene, const TriangleMesh& mesh)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.vertices.size()));
    auto* triangles = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    if (vertices == nullptr || triangles == nullptr)
        throw Error(ErrorKind::unsupported, "Embree: out of memory for the mesh");
    for (const Float3 v : mesh.vertices) {
        *vertices++ = v.x;
        *vertices++ = v.y;
        *vertices++ = v.z;
    }
    for (const auto& triangle : mesh.triangles)
        triangles = std::copy(triangle.begin(), triangle.end(), triangles);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

} // namespace

bool Accelerator::count_bytes(void* accelerator, ssize_t bytes, bool)
{
    static_cast<Accelerator*>(accelerator)->bytes_ += bytes;
    return true;
}

Accelerator::Accelerator(const TriangleMesh& mesh, bool robust, unsigned threads)
{
    const std::string config = threads == 0 ? "" : "threads=" + std::to_string(threads);
    device_ = rtcNewDevice(config.c_str());
    if (device_ == nullptr) throw Error(ErrorKind::internal, "Embree: no device could be made");
    rtcSetDeviceMemoryMonitorFunction(device_, &Accelerator::count_bytes, this);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    try {
        attach_mesh(device_, scene_, mesh);
        const Stopwatch watch;
        rtcCommitScene(scene_);
        build_s_ = watch.seconds();
        check(device_, "building the BVH");
    } catch (...) {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
        throw;
    }
}

Accelerator::~Accelerator()
{
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

namespace {

// A query's options, and the order in which the two major versions take options and rays.
#if TETRACE_EMBREE_MAJOR >= 4
template <class Arguments>
Arguments with_coherence(Arguments arguments, Coherence coherence)
{
    arguments.flags = coherence == Coherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return arguments;
}
RTCIntersectArguments to_intersect(Coherence coherence)
{
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    return with_coherence(arguments, coherence);
}
RTCOccludedArguments to_occlude(Coherence coherence)
{
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    return with_coherence(arguments, coherence);
}
#define QUERY(rays, arguments) rays, arguments
#else
RTCIntersectContext to_intersect(Coherence coherence)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}
constexpr auto to_occlude = to_intersect;
#define QUERY(rays, context) context, rays
#endif

} // namespace

void Accelerator::intersect(RTCRayHit& ray, Coherence coherence) const
{
    auto how = to_intersect(coherence);
    rtcIntersect1(scene_, QUERY(&ray, &how));
}

void Accelerator::intersect16(const int* valid, RTCRayHit16& rays, Coherence coherence) const
{
    auto how = to_intersect(coherence);
    rtcIntersect16(valid, scene_, QUERY(&rays, &how));
}

void Accelerator::occluded(RTCRay& ray, Coherence coherence) const
{
    auto how = to_occlude(coherence);
    rtcOccluded1(scene_, QUERY(&ray, &how));
}

void Accelerator::occluded16(const int* valid, RTCRay16& rays, Coherence coherence) const
{
    auto how = to_occlude(coherence);
    rtcOccluded16(valid, scene_, QUERY(&rays, &how));
}

const char* version_text()
{
    return "Embree " RTC_VERSION_STRING;
}

} // namespace tetrace::embree
