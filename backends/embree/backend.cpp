#include "backends/embree/backend.h"

#include "backends/embree/session.h"
#include "core/base/error.h"
#include "core/device/host.h"

#include <omp.h>

namespace tetrace {
namespace {

Device embree_device()
{
    Device device = host_device();
    device.driver = embree::version_text();
    device.implementation = "embree";
    device.threads = static_cast<unsigned>(omp_get_max_threads());
    return device;
}

class EmbreeBackend : public Backend {
public:
    [[nodiscard]] std::string name() const override { return "embree"; }
    [[nodiscard]] std::string clock() const override { return "host steady clock"; }

    [[nodiscard]] const std::vector<Device>& devices() const override { return devices_; }

    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override
    {
        return kernel.structure == Structure::bvh && kernel.layout == Layout::embree && has_task(kernel);
    }

    [[nodiscard]] std::string why_not(std::size_t, const KernelId& kernel) const override
    {
        return has_kernel(kernel) ? "" : "Embree traces its own BVH only";
    }

    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        if (const auto reason = why_not(0, kernel); !reason.empty()) throw Error(ErrorKind::unsupported, reason);
        const unsigned threads = options.threads != 0 ? options.threads : devices_.front().threads;
        return std::make_unique<embree::EmbreeSession>(
            kernel.method, kernel.task, std::make_shared<embree::Accelerator>(*scene.mesh, false, threads), threads);
    }

    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t, MathMode, std::span<const Quad>) override { return {}; }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions&) override { return {}; }

private:
    std::vector<Device> devices_ = {embree_device()};
};

} // namespace

Backend& embree_backend()
{
    static EmbreeBackend backend;
    return backend;
}

} // namespace tetrace
