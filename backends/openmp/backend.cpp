#include "backends/openmp/backend.h"

#include "backends/openmp/session.h"
#include "core/error.h"
#include "core/host.h"

#include <omp.h>

#include <algorithm>

namespace tetrace {
namespace {

const openmp::CompiledKernel* find_kernel(const KernelId& id)
{
    const auto& kernels = openmp::compiled_kernels();
    const auto found =
        std::find_if(kernels.begin(), kernels.end(), [&](const auto& kernel) { return kernel.id == id; });
    return found == kernels.end() ? nullptr : &*found;
}

class OpenmpBackend : public Backend {
public:
    [[nodiscard]] std::string name() const override { return "openmp"; }
    [[nodiscard]] std::string clock() const override { return "host steady clock"; }

    [[nodiscard]] std::vector<Device> devices() const override
    {
        Device device = host_device();
        device.driver = "OpenMP " + std::to_string(_OPENMP);
        device.threads = static_cast<unsigned>(omp_get_max_threads());
        return {device};
    }

    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return find_kernel(kernel) != nullptr; }

    [[nodiscard]] std::string why_not(const KernelId& kernel) const override
    {
        if (!has_kernel(kernel)) return "openmp has no kernel " + name_of(kernel);
        if (kernel.math == MathMode::fast && !host_has_fused_multiply())
            return "math mode fast is compiled for x86-64-v3, which this processor is not; use --math exact";
        return {};
    }

    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        const auto* found = find_kernel(kernel);
        if (const auto reason = why_not(kernel); !reason.empty()) throw Error(ErrorKind::unsupported, reason);
        if (scene.packed == nullptr || scene.packed->layout != kernel.layout)
            throw Error(ErrorKind::internal,
                        "opening openmp: the scene is not packed as " + std::string(name_of(kernel.layout)));
        const unsigned threads = options.threads != 0 ? options.threads : devices().front().threads;
        return std::make_unique<openmp::OpenmpSession>(found->trace, *scene.packed, threads);
    }
};

} // namespace

Backend& openmp_backend()
{
    static OpenmpBackend backend;
    return backend;
}

} // namespace tetrace
