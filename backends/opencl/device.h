#pragma once

#include "backends/opencl/api.h"
#include "core/device/backend.h"

#include <string>
#include <string_view>
#include <vector>

namespace tetrace::opencl {

/// A device of any platform. id is null where facts speak of a platform without devices, or of no platform.
struct FoundDevice {
    Device facts;
    cl_device_id id = nullptr; ///< not cl::Device, which calls the driver at exit: it may be unloaded by then
    std::string build_key; ///< platform, driver and device with versions: compiled programs are valid only for these
    bool divides_correctly = false; ///< offers correctly rounded division and square root, as a build option
    /// PoCL keeps compiled kernels in a cache of its own, and compiles each once more if it is asked for its program.
    bool keeps_programs = false;
    bool mixes_up_widths = false; ///< ends the process if launches of one kernel grow in flight (findings.md, 13)
    bool has_ballots = false;     ///< of subgroups: cl_khr_subgroup_ballot
    bool has_fences = false;      ///< between groups, in OpenCL C 3.0
    unsigned stack_top = 0;       ///< how many entries of a ray's stack are in local memory (kernels/stack.h)
};

/// Every device of every platform, or one entry that says why there is none. Throws nothing.
[[nodiscard]] std::vector<FoundDevice> find_devices();

/// An implementation's name and version in short: "pocl-3.1", "oclgrind-21.10"; of NVIDIA's drivers the branch,
/// "nvidia-opencl-580". Names that are not known are the platform's in lower case; a version that is not found is left
/// out.
[[nodiscard]] std::string implementation_of(std::string_view platform_name, std::string_view driver_version,
                                            std::string_view platform_version);

} // namespace tetrace::opencl
