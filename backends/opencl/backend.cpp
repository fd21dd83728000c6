#include "backends/opencl/backend.h"

#include "backends/opencl/code.h"
#include "backends/opencl/kernels.h"
#include "backends/opencl/launch_case.h"
#include "backends/opencl/probe.h"
#include "backends/opencl/program.h"
#include "backends/opencl/session.h"
#include "core/device/defects.h"
#include "core/device/device_facts.h"
#include "core/device/session.h"

#include <mutex>

namespace tetrace {

namespace {

/// A kernel's source with its includes resolved; empty if there is none.
std::vector<KernelFile> files_of(const KernelId& kernel)
{
    const std::string name = opencl::source_name(kernel);
    const EmbeddedKernel* const source = find_kernel(opencl::embedded_kernels(), name);
    if (source == nullptr || name == "probe") return {};
    const std::string options = "-cl-std=CL1.2 " + opencl::defines_of(kernel, tile_height_of({}), false, false, 0) +
                                std::string(opencl::math_options(kernel.math));
    std::string what =
        "OpenCL C with its includes resolved, as the driver's compiler gets it; the kernel is run_image. "
        "clBuildProgram gets '" +
        options + "', and also: ";
    if (kernel.task == Task::trace && kernel.structure == Structure::cdt)
        what += "-DSTARTS_OUTSIDE for rays from outside; ";
    if (kernel.task == Task::trace)
        for (const Task task : values_of<Task>())
            if (traits_of(task).takes_rays) {
                what += opencl::define_of(task);
                what.append(" for ").append(traits_of(task).what).append("; ");
            }
    if (traits_of(kernel.task).finds_hits) what += "-DPERSISTENT for that schedule; ";
    what += "-cl-denorms-are-zero on processors; -cl-fp32-correctly-rounded-divide-sqrt where the device offers it";
    return {{name + ".cl", what,
             "clang -x cl -Xclang -finclude-default-header -fsyntax-only " + options + " " + name + ".cl",
             std::string(source->text())}};
}

class OpenclBackend : public Backend {
public:
    [[nodiscard]] std::string name() const override { return "opencl"; }
    [[nodiscard]] std::string clock() const override { return "OpenCL profiling events"; }

    [[nodiscard]] const std::vector<Device>& devices() const override { return found().facts; }

    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override
    {
        return is_common(kernel.schedule) && has_task(kernel) &&
               find_kernel(opencl::embedded_kernels(), opencl::source_name(kernel)) != nullptr;
    }

    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override
    {
        if (!has_kernel(kernel)) return "opencl lacks kernel " + name_of(kernel);
        return devices().at(device).reason;
    }

    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        const PackedScene& packed = packed_scene(*this, device, kernel, scene);
        return std::make_unique<opencl::OpenclSession>(context(device, options.threads), kernel, packed, options);
    }

    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override
    {
        return opencl::run_probe(*context(device, 0), math, operations);
    }

    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t device, const SessionOptions& options) override
    {
        return opencl::measure_device(*context(device, options.threads), max_buffer(devices().at(device), options));
    }

    [[nodiscard]] CompiledCode compiled(std::size_t device, const std::optional<KernelId>& kernel, bool starts_outside,
                                        const std::filesystem::path&) const override
    {
        return opencl::compiled_code(*context(device, 0), kernel, starts_outside);
    }

    [[nodiscard]] bool runs_defects() const override { return true; }
    [[nodiscard]] std::vector<std::uint32_t> run_defect(std::size_t device, std::string_view name,
                                                        const DefectLaunch& launch) override
    {
        const auto opened = context(device, 0);
        if (defect_ == nullptr || !defect_->is_of(*opened, name)) {
            defect_.reset();
            defect_ = std::make_unique<opencl::DefectProgram>(opened, name);
        }
        return defect_->run(launch);
    }

    [[nodiscard]] std::vector<KernelFile> kernel_files(const KernelId& kernel) const override
    {
        return files_of(kernel);
    }
    [[nodiscard]] std::optional<LaunchCase> tile_case(const Device& device, const KernelId& kernel,
                                                      const PackedScene& scene, const LaunchParams& launch,
                                                      std::span<const Quad> rays,
                                                      const std::filesystem::path& program_file) const override
    {
        return opencl::tile_case(device, kernel, scene, launch, rays, program_file);
    }
    [[nodiscard]] std::optional<LaunchCase> defect_case(std::string_view name,
                                                        const DefectLaunch& launch) const override
    {
        return opencl::defect_case(name, launch);
    }

private:
    /// The context that the device's open sessions share, else a new one. A lost context is not used for new sessions.
    std::shared_ptr<opencl::Context> context(std::size_t device, unsigned threads) const
    {
        if (!devices().at(device).usable) throw Error(ErrorKind::missing, devices()[device].reason);
        Shared& shared = shared_[device];
        if (auto made = shared.context.lock(); made && !made->is_lost() && shared.threads == threads) return made;
        auto made = std::make_shared<opencl::Context>(found().devices[device], threads);
        shared = {made, threads};
        return made;
    }

    struct Shared {
        std::weak_ptr<opencl::Context> context;
        unsigned threads = 0; ///< asked for
    };

    struct Found {
        std::vector<opencl::FoundDevice> devices;
        std::vector<Device> facts;
    };

    /// Found when first asked for: this loads drivers, and a run that selects other backends needs none of them.
    [[nodiscard]] const Found& found() const
    {
        std::call_once(once_, [this] {
            found_.devices = opencl::find_devices();
            found_.facts = facts_of(found_.devices);
            shared_.resize(found_.devices.size());
        });
        return found_;
    }

    /// The last one, for its next launch. Not destroyed at exit: the driver may be unloaded by then.
    std::unique_ptr<opencl::DefectProgram>& defect_ = *new std::unique_ptr<opencl::DefectProgram>;
    mutable std::once_flag once_;
    mutable Found found_;
    mutable std::vector<Shared> shared_; ///< device by device
};

} // namespace

Backend& opencl_backend()
{
    static OpenclBackend backend;
    return backend;
}

} // namespace tetrace
