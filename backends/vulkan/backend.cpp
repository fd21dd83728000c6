#include "backends/vulkan/backend.h"

#include "backends/vulkan/code.h"
#include "backends/vulkan/kernels.h"
#include "backends/vulkan/launch_case.h"
#include "backends/vulkan/probe.h"
#include "backends/vulkan/session.h"
#include "core/device/defects.h"
#include "core/device/device_facts.h"
#include "core/device/session.h"

#include <mutex>

namespace tetrace {
namespace {

class VulkanBackend : public Backend {
public:
    [[nodiscard]] std::string name() const override { return "vulkan"; }
    [[nodiscard]] std::string clock() const override { return "Vulkan timestamps"; }

    [[nodiscard]] const std::vector<Device>& devices() const override { return found().facts; }

    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override
    {
        const bool has_schedule = kernel.schedule == Schedule::tiles || kernel.schedule == Schedule::pipeline;
        return has_schedule && find_kernel(vulkan::embedded_kernels(), vulkan::shader_name(kernel)) != nullptr;
    }

    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override
    {
        if (!has_kernel(kernel)) return "vulkan lacks kernel " + name_of(kernel);
        const std::string& reason = devices().at(device).reason;
        if (!reason.empty() || kernel.layout != Layout::rt) return reason;
        return found().devices[device].ray_tracing.why_not(vulkan::tracer_of(kernel));
    }

    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        if (kernel.layout == Layout::rt) {
            require_kernel(*this, device, kernel);
            return std::make_unique<vulkan::VulkanSession>(found().devices[device], kernel, *scene.mesh, options);
        }
        const PackedScene& packed = packed_scene(*this, device, kernel, scene);
        return std::make_unique<vulkan::VulkanSession>(found().devices[device], kernel, packed, options);
    }

    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override
    {
        return vulkan::run_probe(vulkan::Context(found().devices.at(device)), math, operations);
    }

    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t device, const SessionOptions& options) override
    {
        return vulkan::measure_device(vulkan::Context(found().devices.at(device)),
                                      max_buffer(devices().at(device), options));
    }

    [[nodiscard]] bool runs_defects() const override { return true; }
    [[nodiscard]] std::vector<std::uint32_t> run_defect(std::size_t device, std::string_view name,
                                                        const DefectLaunch& launch) override
    {
        return vulkan::run_defect(vulkan::Context(found().devices.at(device)), name, launch);
    }

    [[nodiscard]] std::vector<KernelFile> kernel_files(const KernelId& kernel) const override
    {
        return vulkan::kernel_files(kernel);
    }
    [[nodiscard]] std::optional<LaunchCase> tile_case(const Device& device, const KernelId& kernel,
                                                      const PackedScene& scene, const LaunchParams& launch,
                                                      std::span<const Quad> rays,
                                                      const std::filesystem::path& program_file) const override
    {
        return vulkan::tile_case(device, kernel, scene, launch, rays, program_file);
    }
    [[nodiscard]] std::optional<LaunchCase> defect_case(std::string_view name,
                                                        const DefectLaunch& launch) const override
    {
        return vulkan::defect_case(name, launch);
    }

    [[nodiscard]] bool shows_code() const override { return true; }

    [[nodiscard]] CompiledCode compiled(std::size_t device, const std::optional<KernelId>& kernel, bool starts_outside,
                                        const std::filesystem::path& program_file) const override
    {
        const vulkan::FoundDevice& wanted = found().devices.at(device);
        if (!wanted.facts.usable && !wanted.facts.compile_only) throw Error(ErrorKind::missing, wanted.facts.reason);
        return vulkan::compiled_code(wanted, kernel, starts_outside, program_file);
    }

private:
    struct Found {
        std::vector<vulkan::FoundDevice> devices;
        std::vector<Device> facts;
    };

    /// Found when first asked for: this loads drivers, and a run that selects other backends needs none of them.
    [[nodiscard]] const Found& found() const
    {
        std::call_once(once_, [this] {
            found_.devices = vulkan::find_devices();
            found_.facts = facts_of(found_.devices);
        });
        return found_;
    }

    mutable std::once_flag once_;
    mutable Found found_;
};

} // namespace

Backend& vulkan_backend()
{
    static VulkanBackend backend;
    return backend;
}

} // namespace tetrace
