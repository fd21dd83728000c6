#pragma once

#include "backends/cuda/driver_backend.h"
#include "core/device/self_test.h"
#include "scenes/cache.h"
#include "tests/support/device_rays.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace tetrace::test {

/// Before the instance is made: any message of Vulkan's validation layers, if they are installed, fails a case.
[[maybe_unused]] inline const int validation_is_on = ::setenv("TETRACE_VULKAN_VALIDATION", "1", 1);

/// The BVHs' kernel of a layout for a task.
[[nodiscard]] inline KernelId bvh_kernel(Layout layout, Task task)
{
    return {.structure = Structure::bvh, .method = Method::single, .layout = layout, .task = task};
}

/// An API, and what is claimed of it in addition to what is claimed of all.
struct Api {
    std::string name;
    bool is_persistent = true; ///< it has kernels of schedule persistent
    bool cuts_tets = false;    ///< it binds tets that exceed a buffer in several; else its kernels address all memory
};
inline std::ostream& operator<<(std::ostream& out, const Api& api)
{
    return out << api.name;
}

/// All but the host's own, which the devices are compared with: the reference, and Embree, which runs no kernel of
/// ours.
[[nodiscard]] inline std::vector<Api> apis()
{
    std::vector<Api> found = {{.name = "cuda-stub"}};
    for (const Backend* backend : all_backends())
        if (backend->name() != "embree" && backend != &reference_backend())
            found.push_back({.name = backend->name(),
                             .is_persistent = backend->name() != "vulkan",
                             .cuts_tets = backend->name() == "opencl" || backend->name() == "vulkan"});
    return found;
}

/// CUDA on the library that poses as NVIDIA's driver.
[[nodiscard]] inline Backend& cuda_stub_backend()
{
    static cuda::DriverBackend backend(
        {"cuda-stub", "CUDA events", [] { return cuda::load_driver(TETRACE_STUB_CUDA); }, cuda::embedded_programs});
    return backend;
}

[[nodiscard]] inline Backend& backend_of(const Api& api)
{
    const auto is_named = [&](const Backend* backend) { return backend->name() == api.name; };
    const auto found = std::ranges::find_if(all_backends(), is_named);
    return found != all_backends().end() ? **found : cuda_stub_backend();
}

/// An API's name as that of a case.
[[nodiscard]] inline std::string case_name(const ::testing::TestParamInfo<Api>& api)
{
    std::string name = api.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

/// A case runs once for each of apis(), on each of its devices.
class EachDevice : public UsableDevices, public ::testing::WithParamInterface<Api> {
protected:
    EachDevice() : UsableDevices(backend_of(GetParam())) {}

    /// With compiled kernels kept for other cases and suites: NVRTC takes seconds for each.
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& data,
                                                SessionOptions options = {})
    {
        options.program_cache = cache_directory() / "programs";
        return backend.open(device, kernel, data, options);
    }
    [[nodiscard]] SelfTest self_test(std::size_t device) const
    {
        return judge_self_test(backend.probe(device, MathMode::exact, self_test_operations()));
    }
    /// Rays of exact mode that are not openmp's, exactly or as near as the device's division lets them be.
    [[nodiscard]] std::size_t wrong_rays(std::size_t device, const std::vector<Hit>& hits,
                                         const std::vector<Hit>& openmps)
    {
        if (!allowed_ulps_.contains(device)) allowed_ulps_[device] = self_test(device).allowed_ulps();
        return different_rays(hits, openmps, allowed_ulps_[device]);
    }

private:
    std::map<std::size_t, std::uint64_t> allowed_ulps_; ///< by device, once it was asked for
};

} // namespace tetrace::test
