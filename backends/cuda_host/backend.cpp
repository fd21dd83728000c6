#include "backends/cuda_host/backend.h"

#include "backends/cuda/driver_backend.h"
#include "backends/cuda_host/driver.h"
#include "core/device/host.h"

#include <cstdlib>

namespace tetrace {

namespace cuda_host_frame {
std::span<const EmbeddedKernel> embedded_kernels();
}

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

constexpr std::string_view loaded_text = "\n#include KERNEL_FILE\n";

/// A kernel's text between what calls its entries, and the command that makes a shared object of it.
KernelFile host_text(const KernelId& kernel, std::string_view text)
{
    const std::string name = cuda::program_of(kernel).name();
    const char* const named = std::getenv("CXX");
    const std::string compiler = named != nullptr && *named != 0 ? named : "c++";
    const char* const flags = kernel.math == MathMode::exact ? HOST_FLAGS_EXACT : HOST_FLAGS_FAST;
    std::string whole(cuda_host_frame::embedded_kernels().front().text());
    whole.replace(whole.find(loaded_text) + 1, loaded_text.size() - 1, text);
    return {name + ".cpp", "CUDA C++ with what makes it host C++, for the emulated driver",
            compiler + " -std=c++20 -O2 " + flags + " -fPIC -shared -w -DKERNEL_NAME=" + name + " -o " + name + ".so " +
                name + ".cpp",
            whole};
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

    [[nodiscard]] std::vector<KernelFile> kernel_files(const KernelId& kernel) const override
    {
        const EmbeddedKernel* const source = find_kernel(cuda::embedded_sources(), cuda::program_of(kernel).source);
        return source == nullptr ? std::vector<KernelFile>{} : std::vector{host_text(kernel, source->text())};
    }
};

} // namespace

Backend& cuda_host_backend()
{
    static CudaHostBackend backend;
    return backend;
}

} // namespace tetrace
