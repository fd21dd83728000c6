#include "backends/embree/backend.h"

#include "backends/embree/session.h"
#include "core/error.h"
#include "core/host.h"

#include <omp.h>

namespace tetrace {
namespace {

class EmbreeBackend : public Backend {
public:
    [[nodiscard]] std::string name() const override { return "embree"; }
    [[nodiscard]] std::string clock() const override { return "host steady clock"; }

    [[nodiscard]] std::vector<Device> devices() const override
    {
        Device device = host_device();
        device.driver = embree::version_text();
        device.threads = static_cast<unsigned>(omp_get_max_threads());
        return {device};
    }

    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override
    {
        return kernel.structure == Structure::bvh && kernel.layout == Layout::embree;
    }

    [[nodiscard]] std::string why_not(const KernelId& kernel) const override
    {
        return has_kernel(kernel) ? "" : "Embree traces its own BVH only";
    }

    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        if (const auto reason = why_not(kernel); !reason.empty()) throw Error(ErrorKind::unsupported, reason);
        const unsigned threads = options.threads != 0 ? options.threads : devices().front().threads;
        return std::make_unique<embree::EmbreeSession>(
            kernel.method, std::make_shared<embree::Accelerator>(*scene.mesh, false, threads), threads);
    }
};

} // namespace

Backend& embree_backend()
{
    static EmbreeBackend backend;
    return backend;
}

} // namespace tetrace
