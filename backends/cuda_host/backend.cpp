#include "backends/cuda_host/backend.h"

#include "backends/cuda/driver_backend.h"
#include "backends/cuda_host/driver.h"
#include "core/device/host.h"

namespace tetrace {

namespace {

/// Kernels are already compiled into the program: a module's image is only a kernel's name.
const std::vector<EmbeddedKernel>& host_images()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> made;
        for (const EmbeddedKernel& source : cuda::embedded_sources())
            for (const MathMode math : {MathMode::exact, MathMode::fast})
                made.push_back(cuda::ProgramId{std::string(source.name), math}.name());
        return made;
    }();
    static const std::vector<EmbeddedKernel> images = [] {
        std::vector<EmbeddedKernel> made;
        for (const std::string& name : names)
            made.push_back({name, std::as_bytes(std::span(name))});
        return made;
    }();
    return images;
}

class CudaHostBackend : public cuda::DriverBackend {
public:
    CudaHostBackend()
        : DriverBackend({"cuda-host", "host steady clock, as CUDA events",
                         [] {
                             return cuda::LoadedDriver{cuda_host::emulated_driver(), {}};
                         },
                         [] { return cuda::Programs{.code = host_images(), .compiler = "the host's compiler"}; }})
    {
    }

    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override
    {
        const std::string reason = DriverBackend::why_not(device, kernel);
        if (reason.empty() && kernel.math == MathMode::fast && !host_has_fused_multiply())
            return "math mode fast is compiled for x86-64-v3, which this processor is not; use --math exact";
        return reason;
    }
};

} // namespace

Backend& cuda_host_backend()
{
    static CudaHostBackend backend;
    return backend;
}

} // namespace tetrace
