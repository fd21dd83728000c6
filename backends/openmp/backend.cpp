#include "backends/openmp/backend.h"

#include "backends/openmp/defects.h"
#include "backends/openmp/packet_session.h"
#include "backends/openmp/probe.h"
#include "backends/openmp/session.h"
#include "backends/openmp/yardstick.h"
#include "core/base/error.h"
#include "core/device/backend.h"
#include "core/device/defects.h"
#include "core/device/host.h"
#include "core/device/session.h"

#include <omp.h>

#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

namespace {

Device openmp_device()
{
    Device device = host_device();
    device.driver = "OpenMP " + std::to_string(_OPENMP);
    device.implementation = "openmp";
    device.threads = static_cast<unsigned>(omp_get_max_threads());
    device.group_width = openmp::packet_kernels().front().lanes;
    return device;
}

class OpenmpBackend : public Backend {
public:
    [[nodiscard]] std::string name() const override { return "openmp"; }
    [[nodiscard]] std::string clock() const override { return "host steady clock"; }

    [[nodiscard]] const std::vector<Device>& devices() const override { return devices_; }

    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override
    {
        if (kernel.schedule == Schedule::packets) return has_packets(kernel) && has_task(kernel);
        return function_of(kernel) != nullptr;
    }

    [[nodiscard]] std::string why_not(std::size_t, const KernelId& kernel) const override
    {
        if (!has_kernel(kernel)) return "openmp lacks kernel " + name_of(kernel);
        if (kernel.math == MathMode::fast && !host_has_fused_multiply())
            return "math mode fast is compiled for x86-64-v3, which this processor is not; use --math exact";
        if (kernel.schedule == Schedule::native && !host_has_fused_multiply())
            return "schedule native is compiled for x86-64-v3, which this processor is not; use --schedule tiles";
        return {};
    }

    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        const PackedScene& packed = packed_scene(*this, 0, kernel, scene);
        if (kernel.schedule == Schedule::packets)
            return std::make_unique<openmp::PacketSession>(openmp::packet_kernel(options.packet_lanes), kernel.task,
                                                           packed, threads_of(options));
        return std::make_unique<openmp::OpenmpSession>(function_of(kernel), kernel.task, packed, threads_of(options),
                                                       tile_height_of(options));
    }

    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t, MathMode math,
                                                   std::span<const Quad> operations) override
    {
        return math == MathMode::exact ? openmp::probe_exact(operations) : openmp::probe_fast(operations);
    }

    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t, const SessionOptions& options) override
    {
        return openmp::measure_host(threads_of(options));
    }

    [[nodiscard]] bool runs_defects() const override { return true; }
    [[nodiscard]] std::vector<std::uint32_t> run_defect(std::size_t, std::string_view name,
                                                        const DefectLaunch& launch) override
    {
        return openmp::words_of_defect(name, launch);
    }

private:
    /// Null if there is none.
    [[nodiscard]] static openmp::RunFunction* function_of(const KernelId& kernel)
    {
        if (kernel.schedule == Schedule::native) return openmp::find_function(openmp::native_kernels(), kernel);
        return kernel.schedule == Schedule::tiles ? openmp::find_function(openmp::compiled_kernels(), kernel) : nullptr;
    }
    [[nodiscard]] unsigned threads_of(const SessionOptions& options) const
    {
        return options.threads != 0 ? options.threads : devices_.front().threads;
    }

    std::vector<Device> devices_ = {openmp_device()};
};

} // namespace

Backend& openmp_backend()
{
    static OpenmpBackend backend;
    return backend;
}

} // namespace tetrace
