#include "backends/cuda/driver_backend.h"

#include "backends/cuda/code.h"
#include "backends/cuda/device.h"
#include "backends/cuda/program.h"
#include "backends/cuda/session.h"
#include "core/base/error.h"
#include "core/base/files.h"
#include "core/device/backend.h"
#include "core/device/session.h"
#include "core/device/yardstick.h"

namespace tetrace::cuda {

namespace {

constexpr const char* ptx_target = "compute_75"; // the oldest that CUDA 13 knows; any later GPU's driver takes it

std::string joined(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words)
        text += " " + word;
    return text;
}

/// Throws Error{missing} if NVRTC is not here, and as Nvrtc::compile().
std::string ptx_of(const Programs& programs, const EmbeddedKernel& source, const ProgramId& id)
{
    if (!programs.has_nvrtc())
        throw Error(ErrorKind::missing, programs.nvrtc == nullptr ? "NVRTC is not used" : programs.nvrtc().reason());
    const auto options = compiler_options(id);
    const auto code = programs.nvrtc().compile(source.text().data(), id.name(), ptx_target, options);
    std::string text(code.begin(), code.end());
    while (!text.empty() && text.back() == '\0')
        text.pop_back();
    return text;
}

/// A kernel's source with its includes resolved; its PTX, if NVRTC is here; and nvcc's code, if this build has that.
/// Empty without such a kernel.
std::vector<KernelFile> files_of(const Programs& programs, const KernelId& kernel)
{
    const ProgramId id = program_of(kernel);
    const EmbeddedKernel* const source = find_kernel(programs.sources, id.source);
    if (source == nullptr) return {};
    const std::string ptx = id.name() + ".ptx", text = id.source + ".cu";
    const std::string command = "nvcc --ptx -std=c++17 -arch=" + std::string(ptx_target) +
                                joined(compiler_options(id)) + " -o " + ptx + " " + text;
    std::vector<KernelFile> files = {
        {text, "CUDA C++ with its includes resolved, as NVRTC and nvcc get it", command, std::string(source->text())}};
    try {
        files.push_back({ptx, "PTX, by NVRTC", "ptxas -v -arch=sm_75 -o " + id.name() + ".cubin " + ptx,
                         ptx_of(programs, *source, id)});
    } catch (const Error& error) {
        files.front().what += "; without PTX, because " + std::string(error.what());
    }
    if (const EmbeddedKernel* const code = find_kernel(programs.code, id.name()))
        files.push_back({id.name() + ".fatbin", "machine code, by " + programs.compiler + ", as the driver gets it",
                         "cuobjdump --dump-sass " + id.name() + ".fatbin", std::string(code->text())});
    return files;
}

Yardstick measured_copies(OpenDevice& device)
{
    std::size_t free = 0, total = 0;
    device.context.check(device.driver().memory_info(&free, &total), "asking how much memory is free");
    const std::size_t bytes = copied_bytes(free, 0);
    const Memory from(device.context, bytes, "the copy's source"), to(device.context, bytes, "the copy's target");
    EventTimer timer(device.context);
    return measure_copies(bytes, [&](std::uint64_t each, unsigned times) {
        timer.start(device.stream.get());
        for (unsigned time = 0; time < times; ++time)
            device.context.check(
                device.driver().copy_on_device(to.address(), from.address(), each, device.stream.get()),
                "copying memory to memory");
        timer.stop(device.stream.get());
        return timer.seconds();
    });
}

double launch_s(OpenDevice& device, FunctionHandle probe)
{
    Address none = 0;
    std::uint32_t count = 0;
    void* parameters[] = {&none, &none, &count};
    return median_seconds([&] {
        device.launch(probe, 1, 1, parameters);
        device.synchronize();
    });
}

/// Copies memory to memory, up to 512 MiB and for some milliseconds at most, and takes the best of a few; then launches
/// a kernel that has nothing to do. probe: of the self-test's module.
Yardstick measure_device(OpenDevice& device, FunctionHandle probe)
{
    Yardstick measured = measured_copies(device);
    measured.launch_s = launch_s(device, probe);
    return measured;
}

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

/// Runs a kernel that reads an input and changes the results. what: "the self-test", in messages. large_bytes: of a
/// buffer that only the kernel sees.
void run_on_words(OpenDevice& device, FunctionHandle kernel, std::span<const std::byte> input, std::uint32_t items,
                  unsigned block_threads, std::vector<std::uint32_t>& results, const std::string& what,
                  std::uint64_t large_bytes = 0)
{
    const Memory read(device.context, input, ("the input of " + what).c_str(), device.stream.get());
    const Memory written(device.context, std::as_bytes(std::span(results)), ("the results of " + what).c_str(),
                         device.stream.get());
    const Memory large(device.context, large_bytes, ("the large buffer of " + what).c_str());
    Address from = read.address(), to = written.address(), far = large.address();
    void* parameters[] = {&from, &to, &items, &far}; // a kernel without a large buffer has three
    device.launch(kernel, (items + block_threads - 1) / block_threads, block_threads, parameters);
    device.context.check(device.driver().copy_to_host(results.data(), to, written.bytes(), device.stream.get()),
                         ("copying the results of " + what + " to the host").c_str());
    device.synchronize();
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
    Programs programs = here.programs;
    const std::string name = program_of(kernel).name();
    const std::string given = options.program_file.empty() ? std::string() : required_bytes(options.program_file);
    const EmbeddedKernel code{name, std::as_bytes(std::span(given))};
    if (!given.empty()) programs = {.code = std::span(&code, 1), .compiler = "the compiler of a given program"};
    return std::make_unique<CudaSession>(driver, ordinal_of(driver, device), programs, kernel, packed, options,
                                         tile_height_of(options));
}

std::vector<std::uint32_t> DriverBackend::probe(std::size_t device, MathMode math, std::span<const Quad> operations)
{
    const Found& here = require(device);
    OpenDevice opened(here.driver.driver, ordinal_of(here.driver.driver, device));
    const ProgramId id = probe_program(math);
    const LoadedProgram program = load_program(opened.context, opened.capability, here.programs, id, {});
    std::vector<std::uint32_t> results(operations.size());
    run_on_words(opened, program.module.function(id.name()), std::as_bytes(operations),
                 static_cast<std::uint32_t>(operations.size()), probe_block_threads, results, "the self-test");
    return results;
}

std::vector<std::uint32_t> DriverBackend::run_defect(std::size_t device, std::string_view name,
                                                     const DefectLaunch& launch)
{
    const Found& here = require(device);
    OpenDevice opened(here.driver.driver, ordinal_of(here.driver.driver, device));
    const LoadedProgram program = load_program(opened.context, opened.capability, here.programs, {"defects"}, {});
    const auto words = defect_words(launch);
    std::vector<std::uint32_t> results(output_words(name, launch));
    run_on_words(opened, program.module.function("run_" + std::string(name)), std::as_bytes(std::span(words)),
                 launch.items, launch.group_items, results, std::string(name), launch.large_bytes());
    return results;
}

CompiledCode DriverBackend::compiled(std::size_t device, const std::optional<KernelId>& kernel, bool starts_outside,
                                     const std::filesystem::path&) const
{
    const Found& here = require(device);
    const Driver& driver = here.driver.driver;
    return compiled_code(driver, ordinal_of(driver, device), here.devices[device], here.programs, kernel,
                         starts_outside);
}

std::vector<KernelFile> DriverBackend::kernel_files(const KernelId& kernel) const
{
    return files_of(platform_.programs(), kernel);
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
