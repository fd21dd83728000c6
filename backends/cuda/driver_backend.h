#pragma once

#include "backends/cuda/program.h"
#include "core/device/backend.h"
#include "core/device/defects.h"

#include <functional>
#include <mutex>

namespace tetrace::cuda {

/// What distinguishes CUDA on NVIDIA's driver from its emulation.
struct Platform {
    std::string name;                     ///< of the backend
    std::string clock;                    ///< the clock that events read
    std::function<LoadedDriver()> driver; ///< called when the devices are first asked for
    std::function<Programs()> programs;   ///< called when the programs are first needed
};

/// A backend on any driver table: everything except where CUDA's functions and kernels come from.
class DriverBackend : public Backend {
public:
    explicit DriverBackend(Platform platform) : platform_(std::move(platform)) {}

    [[nodiscard]] std::string name() const override { return platform_.name; }
    [[nodiscard]] std::string clock() const override { return platform_.clock; }
    [[nodiscard]] const std::vector<Device>& devices() const override { return found().devices; }
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override;
    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override;
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override;
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override;
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t device, const SessionOptions& options) override;
    [[nodiscard]] CompiledCode compiled(std::size_t device, const std::optional<KernelId>& kernel, bool starts_outside,
                                        const std::filesystem::path& program_file) const override;
    [[nodiscard]] bool runs_defects() const override { return true; }
    [[nodiscard]] std::vector<std::uint32_t> run_defect(std::size_t device, std::string_view name,
                                                        const DefectLaunch& launch) override;
    [[nodiscard]] std::vector<KernelFile> kernel_files(const KernelId& kernel) const override;

private:
    /// What was found on the machine; looked up once.
    struct Found {
        LoadedDriver driver;
        Programs programs;
        std::vector<Device> devices;
    };
    const Found& found() const;
    /// Throws Error{missing} with the reason where the device cannot be used.
    const Found& require(std::size_t device) const;

    Platform platform_;
    mutable std::once_flag once_;
    mutable Found found_;
};

/// Every kernel's text, for NVRTC: <method>_<layout>, probe and defects.
[[nodiscard]] std::span<const EmbeddedKernel> embedded_sources();

/// What this build has: the texts, the code if it was made with nvcc, and NVRTC if it is installed.
[[nodiscard]] Programs embedded_programs();

} // namespace tetrace::cuda
