#pragma once

#include "backends/vulkan/rt/ray_tracing.h"
#include "core/device/backend.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace::vulkan {

/// The properties of a device that decide whether and how it can be used.
struct Limits {
    std::uint32_t api_version = 0;
    std::optional<std::uint32_t> queue_family; ///< the first that computes and has timestamps
    unsigned timestamp_bits = 0;               ///< valid ones, of that family
    std::uint32_t push_constant_bytes = 0;
    std::uint32_t storage_buffers = 0; ///< of a shader
    std::uint32_t texels = 0;          ///< of a texel buffer
    std::uint32_t group_items = 0;
    std::uint32_t group_height = 0;
    std::uint32_t groups = 0; ///< of a dispatch, along x
    std::uint64_t allocation_bytes = 0;
};

/// Empty if the device can run our kernels, else the reason with both numbers.
[[nodiscard]] std::string why_not_usable(const Limits& limits);

/// The number of storage buffers of a kernel: the scene's arrays, the output, and rays or further parts of the tets.
[[nodiscard]] constexpr std::uint32_t storage_buffers_needed(std::size_t arrays, bool in_parts)
{
    return static_cast<std::uint32_t>(arrays) + (in_parts ? MAX_TET_PARTS : 2);
}

/// A physical device of instance(). handle is null where facts speak of there being none.
struct FoundDevice {
    Device facts;
    VkPhysicalDevice handle = nullptr;
    Limits limits;
    RayTracing ray_tracing;
    bool has_ballots = false;      ///< of subgroups, in compute shaders
    bool tells_cache_hits = false; ///< VK_EXT_pipeline_creation_feedback
    bool reads_texels = false;     ///< reads texel buffers faster than storage buffers
    bool selects_minima = false;   ///< selects the smaller of two numbers faster than its minimum does
    unsigned stack_top = 0;        ///< how many entries of a ray's stack are in shared memory (kernels/stack.h)
    unsigned shares = 1;           ///< it cuts a dispatch into this many runs of successive groups, one per thread
    bool always_stages = false;    ///< treats the device's memory as if the host did not see it, for tests
    std::string build_key;         ///< device and driver with versions: compiled pipelines are valid only for these
};

/// For the structure with the most arrays: a device with fewer buffers cannot be used.
inline constexpr std::uint32_t min_storage_buffers = storage_buffers_needed(5, false);

/// Every device of every driver, or one entry that says why there is none. Throws nothing.
[[nodiscard]] std::vector<FoundDevice> find_devices();

/// Whether a driver offers hardware that is not here: it compiles for it, and can run nothing. radv does so where
/// RADV_FORCE_FAMILY names a family of GPUs. implementation: as implementation_of() names it.
[[nodiscard]] bool is_null_hardware(std::string_view implementation, std::string_view device_name);

/// The most steps of a walk on an implementation, as implementation_of() names it; 0: no limit. lavapipe before Mesa 25
/// ends the loops of an invocation after 65,535 iterations in all, without an error (tests/expected/README.md,
/// `loop_of_70000_iterations`). A walk that asks whether it goes in circles follows its path twice: 2 * 28,000 steps
/// and the first STEPS_BEFORE_DOUBT leave 5,439 iterations for ties and for the search of the entry.
[[nodiscard]] std::uint32_t max_steps_of(std::string_view implementation);

/// A driver's name and version in short, from VkPhysicalDeviceDriverProperties: "lavapipe-22.3", "radv-22.3"; of
/// NVIDIA's drivers the branch, "nvidia-vulkan-580". Names that are not known are in lower case, a version that is not
/// found is left out.
[[nodiscard]] std::string implementation_of(std::string_view driver_name, std::string_view driver_info);

} // namespace tetrace::vulkan
