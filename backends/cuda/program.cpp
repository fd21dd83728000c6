#include "backends/cuda/program.h"

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"
#include "core/device/program_cache.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

namespace tetrace::cuda {

namespace {

constexpr std::array names{"libnvrtc.so.13", "libnvrtc.so.12", "libnvrtc.so.11.2"};
constexpr std::array folders{"", "/usr/local/cuda/lib64/", "/usr/local/cuda/targets/x86_64-linux/lib/",
                             "/usr/local/cuda/targets/sbsa-linux/lib/", "/opt/cuda/lib64/"};

void* open_library()
{
    for (const char* folder : folders)
        for (const char* name : names)
            if (void* library = dlopen((std::string(folder) + name).c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
    return nullptr;
}

bool is_machine_code(const std::string& target)
{
    return target.rfind("sm_", 0) == 0;
}

} // namespace

const Nvrtc& Nvrtc::installed()
{
    static const Nvrtc library;
    return library;
}

Nvrtc::Nvrtc()
{
    load();
}

void Nvrtc::load()
{
    void* library = open_library();
    if (library == nullptr) {
        reason_ = "NVRTC, which compiles kernels at run time, was not found as libnvrtc.so.13, .12 or .11.2; "
                  "NVIDIA's install the CUDA toolkit (Debian: package nvidia-cuda-toolkit)";
        return;
    }
    const auto find = [&](auto& function, const char* symbol) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, symbol));
        if (function == nullptr) reason_ = std::string("NVRTC is too old for this program: it lacks ") + symbol;
    };
    find(version_, "nvrtcVersion");
    find(error_text_, "nvrtcGetErrorString");
    find(target_count_, "nvrtcGetNumSupportedArchs");
    find(targets_, "nvrtcGetSupportedArchs");
    find(create_, "nvrtcCreateProgram");
    find(destroy_, "nvrtcDestroyProgram");
    find(compile_, "nvrtcCompileProgram");
    find(log_size_, "nvrtcGetProgramLogSize");
    find(log_, "nvrtcGetProgramLog");
    find(code_size_, "nvrtcGetCUBINSize");
    find(code_, "nvrtcGetCUBIN");
    find(assembly_size_, "nvrtcGetPTXSize");
    find(assembly_, "nvrtcGetPTX");
}

void Nvrtc::check(int result, const std::string& doing) const
{
    if (result == 0) return;
    throw Error(ErrorKind::driver, "NVRTC: " + doing + ": " + error_text_(result));
}

std::string Nvrtc::version() const
{
    int major = 0, minor = 0;
    check(version_(&major, &minor), "asking its version");
    return std::to_string(major) + "." + std::to_string(minor);
}

std::string Nvrtc::target(int capability) const
{
    int count = 0;
    check(target_count_(&count), "asking what it compiles for");
    std::vector<int> known(static_cast<std::size_t>(count));
    check(targets_(known.data()), "asking what it compiles for");
    std::sort(known.begin(), known.end());
    const auto newer = std::upper_bound(known.begin(), known.end(), capability);
    if (newer == known.begin())
        throw Error(ErrorKind::unsupported, "compiling kernels: NVRTC " + version() + " knows no device as old as sm_" +
                                                std::to_string(capability) + "; one of an older CUDA does");
    const int best = *(newer - 1);
    return (best == capability ? "sm_" : "compute_") + std::to_string(best);
}

std::string Nvrtc::output(Program program, GetSize size, GetText text) const
{
    std::size_t bytes = 0;
    check(size(program, &bytes), "asking a size");
    std::string output(bytes, '\0');
    check(text(program, output.data()), "fetching what it made");
    return output;
}

std::vector<unsigned char> Nvrtc::compile(const char* text, const std::string& name, const std::string& target,
                                          std::span<const std::string> options) const
{
    const std::string architecture = "--gpu-architecture=" + target;
    std::vector<const char*> words{architecture.c_str(), "--std=c++17"};
    for (const std::string& option : options)
        words.push_back(option.c_str());

    Program program = nullptr;
    check(create_(&program, text, (name + ".cu").c_str(), 0, nullptr, nullptr), "taking the text of " + name);
    const auto destroy = [this](Program made) { destroy_(&made); };
    const std::unique_ptr<ProgramState, decltype(destroy)> owner(program, destroy);
    if (const int result = compile_(program, static_cast<int>(words.size()), words.data()); result != 0)
        check(result, "compiling " + name + " for " + target + ": " + output(program, log_size_, log_).c_str());
    const std::string made =
        is_machine_code(target) ? output(program, code_size_, code_) : output(program, assembly_size_, assembly_);
    return {made.begin(), made.end()};
}

namespace {

/// Everything that NVRTC's result depends on.
std::uint64_t cache_key(const Nvrtc& nvrtc, std::string_view text, std::span<const std::string> options,
                        const std::string& target)
{
    std::uint64_t key = hash_of(target, hash_of(text, hash_of(nvrtc.version())));
    for (const std::string& option : options)
        key = hash_of(option, key);
    return key;
}

/// Loads a compiler's output. If the driver cannot use it, the driver is usually older than the compiler: the error
/// names both versions.
Module load_image(Context& context, std::span<const std::byte> image, const ProgramId& id, const std::string& compiler)
try {
    return {context, image, id.name()};
} catch (const Error& error) {
    if (error.kind() != ErrorKind::unsupported) throw;
    int version = 0;
    context.driver().driver_version(&version);
    throw Error(ErrorKind::unsupported, std::string(error.what()) + "; it was made by " + compiler +
                                            ", the driver is of CUDA " + version_text(version) +
                                            ": install a newer driver, or NVRTC of a CUDA that this driver supports " +
                                            "(package nvidia-cuda-toolkit)");
}

/// NVRTC's module, from the cache if it is there; second: whether it was.
std::pair<Module, bool> compiled_module(Context& context, int capability, const Programs& programs, const ProgramId& id,
                                        const ProgramCache& cache)
{
    const EmbeddedKernel* source = find_kernel(programs.sources, id.source);
    if (source == nullptr || !programs.has_nvrtc())
        throw Error(ErrorKind::unsupported, "CUDA: this build lacks the code of kernel " + id.name() +
                                                ", and nothing here compiles it: " +
                                                (programs.nvrtc != nullptr ? programs.nvrtc().reason() : "no NVRTC"));
    const Nvrtc& nvrtc = programs.nvrtc();
    const std::string compiler = "NVRTC " + nvrtc.version(), target = nvrtc.target(capability);
    const auto options = compiler_options(id);
    const std::uint64_t key = cache_key(nvrtc, source->text(), options, target);
    if (const auto kept = cache.find(key))
        return {load_image(context, std::as_bytes(std::span(*kept)), id, compiler), true};
    const auto image = nvrtc.compile(source->text().data(), id.name(), target, options);
    cache.keep(key, image);
    return {load_image(context, std::as_bytes(std::span(image)), id, compiler), false};
}

/// Empty if the driver cannot use the build's code and NVRTC is available instead.
std::optional<Module> build_module(Context& context, const Programs& programs, const ProgramId& id)
{
    const EmbeddedKernel* code = find_kernel(programs.code, id.name());
    if (code == nullptr) return std::nullopt;
    try {
        return load_image(context, code->bytes, id, programs.compiler);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::unsupported || !programs.has_nvrtc()) throw;
        return std::nullopt;
    }
}

} // namespace

ProgramId program_of(const KernelId& kernel)
{
    return {std::string(name_of(kernel.method)).append("_").append(name_of(kernel.layout)), kernel.math};
}

std::string entry_name(const KernelId& kernel, bool starts_outside)
{
    const bool starts_inside = kernel.task == Task::trace && !starts_outside && kernel.structure == Structure::cdt;
    return std::string(starts_inside ? "inside" : name_of(kernel.task))
        .append("_")
        .append(name_of(kernel.schedule))
        .append("_" + program_of(kernel).name());
}

std::vector<std::string> compiler_options(const ProgramId& id)
{
    std::vector<std::string> options{"-DKERNEL_NAME=" + id.name()};
    std::istringstream words(id.math == MathMode::exact ? TETRACE_CUDA_FLAGS_EXACT : TETRACE_CUDA_FLAGS_FAST);
    for (std::string word; words >> word;)
        options.push_back(word);
    return options;
}

LoadedProgram load_program(Context& context, int capability, const Programs& programs, const ProgramId& id,
                           const std::filesystem::path& cache)
{
    const Stopwatch watch;
    const auto loaded = [&](Module module, bool cached) {
        return LoadedProgram{std::move(module), watch.seconds(), cached};
    };
    if (auto module = build_module(context, programs, id)) return loaded(std::move(*module), false);
    auto [module, cached] = compiled_module(context, capability, programs, id, ProgramCache(cache));
    return loaded(std::move(module), cached);
}

} // namespace tetrace::cuda
