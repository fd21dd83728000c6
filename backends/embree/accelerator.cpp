#include "backends/embree/accelerator.h"

#include "backends/embree/queries.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"

#include <algorithm>

namespace tetrace::embree {
namespace {

void check(RTCDevice device, const char* doing)
{
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw Error(ErrorKind::internal, std::string("Embree, ") + doing + ": error " + std::to_string(error));
}

/// Lets Embree use whatever the processor has. By default, it uses narrower trees on some Xeons, for the sake of
/// programs that use no wide instructions themselves (docs/embree.md).
#if defined(__x86_64__)
constexpr const char* frequency_level = "frequency_level=simd512";
#else
constexpr const char* frequency_level = "";
#endif

RTCDevice new_device(unsigned threads)
{
    std::string config = frequency_level;
    if (threads != 0) config += (config.empty() ? "threads=" : ",threads=") + std::to_string(threads);
    const RTCDevice device = rtcNewDevice(config.c_str());
    if (device == nullptr)
        throw Error(ErrorKind::internal,
                    "Embree: no device could be made: error " + std::to_string(rtcGetDeviceError(nullptr)));
    return device;
}

void attach_mesh(RTCDevice device, RTCScene scene, const TriangleMesh& mesh, RTCBuildQuality quality)
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
    rtcSetGeometryBuildQuality(geometry, quality);
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

Tree tree_of(Layout layout)
{
    switch (layout) {
    case Layout::embree_medium: return Tree::medium;
    case Layout::embree_robust: return Tree::robust;
    default: return Tree::high;
    }
}

Accelerator::Accelerator(const TriangleMesh& mesh, Tree tree, unsigned threads) : device_(new_device(threads))
{
    const RTCBuildQuality quality = tree == Tree::medium ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH;
    rtcSetDeviceMemoryMonitorFunction(device_, &Accelerator::count_bytes, this);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, quality);
    rtcSetSceneFlags(scene_, tree == Tree::robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    try {
        attach_mesh(device_, scene_, mesh, quality);
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

std::string version_text()
{
    const std::string version = "Embree " RTC_VERSION_STRING;
    return *frequency_level == '\0' ? version : version + ", " + frequency_level;
}

Abilities abilities()
{
    const RTCDevice device = new_device(1);
    const auto has = [&](RTCDeviceProperty property) { return rtcGetDeviceProperty(device, property) != 0; };
    Abilities result;
    result.version = RTC_VERSION_MAJOR;
    result.native_width = has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)  ? 16
                          : has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8
                          : has(RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED) ? 4
                                                                           : 1;
#if TETRACE_EMBREE_MAJOR < 4
    result.has_streams = has(RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED);
#endif
    rtcReleaseDevice(device);
    return result;
}

std::string why_not_traced(const Abilities& abilities, Method method)
{
    if (method == Method::stream && abilities.version >= 4) return no_streams;
    if (method == Method::stream && !abilities.has_streams) return "this build of Embree lacks ray streams";
    const unsigned width = packet_width(method), native = abilities.native_width;
    if (width <= native || (abilities.version < 4 && native > 1)) return {};
    return "Embree " + std::to_string(abilities.version) + " would trace packets of " + std::to_string(width) +
           " as single rays: its native width on this processor is " + std::to_string(native) +
           (native > 4 ? " (method packet" + std::to_string(native) + ")" : "");
}

} // namespace tetrace::embree
