#include "backends/cuda/driver_backend.h"

#include "backends/cuda/files.h"
#include "backends/cuda/session.h"
#include "backends/cuda/yardstick.h"
#include "core/base/error.h"
#include "core/device/open_checks.h"

namespace tetrace::cuda {

namespace {

constexpr unsigned probe_block_threads = 64;

/// Whether a kernel's text, if there is one, has an entry for its task and schedule (kernel.cu).
bool has_entry(const KernelId& kernel)
{
    return is_common(kernel.schedule) && has_task(kernel);
}

ProgramId probe_program(MathMode math)
{
    return {"probe", math};
}

/// Runs a kernel that reads an input and writes a word an item. what: "the self-test", in messages.
std::vector<std::uint32_t> words_of(OpenDevice& device, FunctionHandle kernel, std::span<const std::byte> input,
                                    std::uint32_t items, unsigned block_threads, const std::string& what)
{
    std::vector<std::uint32_t> results(items);
    const Memory read(device.context, input, ("the input of " + what).c_str(), device.stream.get());
    const Memory written(device.context, results.size() * sizeof(results[0]), ("the results of " + what).c_str());
    Address from = read.address(), to = written.address();
    void* parameters[] = {&from, &to, &items};
    device.launch(kernel, (items + block_threads - 1) / block_threads, block_threads, parameters);
    device.context.check(device.driver().copy_to_host(results.data(), to, written.bytes(), device.stream.get()),
                         ("copying the results of " + what + " to the host").c_str());
    device.synchronize();
    return results;
}

} // namespace

const DriverBackend::Found& DriverBackend::found() const
{
    std::call_once(once_, [this] {
        found_.driver = platform_.driver();
        found_.programs = platform_.programs();
        found_.devices = list_devices(found_.driver, found_.programs);
    });
    return found_;
}

const DriverBackend::Found& DriverBackend::require(std::size_t device) const
{
    const Device& wanted = devices().at(device);
    if (!wanted.usable) throw Error(ErrorKind::missing, wanted.reason);
    return found_;
}

bool DriverBackend::has_kernel(const KernelId& kernel) const
{
    return has_entry(kernel) && find_kernel(embedded_sources(), program_of(kernel).source) != nullptr;
}

std::string DriverBackend::why_not(std::size_t device, const KernelId& kernel) const
{
    if (!has_kernel(kernel)) return name() + " lacks kernel " + name_of(kernel);
    const Device& wanted = devices().at(device);
    return wanted.usable ? "" : wanted.reason;
}

std::unique_ptr<Session> DriverBackend::open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                             const SessionOptions& options)
{
    const Found& here = found();
    const PackedScene& packed = packed_scene(*this, device, kernel, scene);
    const Driver& driver = here.driver.driver;
    return std::make_unique<CudaSession>(driver, ordinal_of(driver, device), here.programs, kernel, packed, options,
                                         tile_height_of(options));
}

std::vector<std::uint32_t> DriverBackend::probe(std::size_t device, MathMode math, std::span<const Quad> operations)
{
    const Found& here = require(device);
    OpenDevice opened(here.driver.driver, ordinal_of(here.driver.driver, device));
    const ProgramId id = probe_program(math);
    const LoadedProgram program = load_program(opened.context, opened.capability, here.programs, id, {});
    return words_of(opened, program.module.function(id.name()), std::as_bytes(operations),
                    static_cast<std::uint32_t>(operations.size()), probe_block_threads, "the self-test");
}

std::vector<std::uint32_t> DriverBackend::run_defect(std::size_t device, std::string_view name)
{
    const Found& here = require(device);
    OpenDevice opened(here.driver.driver, ordinal_of(here.driver.driver, device));
    const LoadedProgram program = load_program(opened.context, opened.capability, here.programs, {"defects"}, {});
    const auto words = defect_words();
    return words_of(opened, program.module.function("run_" + std::string(name)), std::as_bytes(std::span(words)),
                    defect_items, defect_items, std::string(name));
}

std::vector<KernelFile> DriverBackend::kernel_files(const KernelId& kernel) const
{
    return cuda::kernel_files(platform_.programs(), kernel);
}

std::optional<Yardstick> DriverBackend::yardstick(std::size_t device, const SessionOptions& options)
{
    const Found& here = require(device);
    const Driver& driver = here.driver.driver;
    if (driver.is_emulation()) driver.use_threads(options.threads);
    OpenDevice opened(driver, ordinal_of(driver, device));
    const ProgramId id = probe_program(MathMode::exact);
    const LoadedProgram program =
        load_program(opened.context, opened.capability, here.programs, id, options.program_cache);
    return measure_device(opened, program.module.function(id.name()));
}

} // namespace tetrace::cuda
