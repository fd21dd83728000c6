#include "backends/cuda/program.h"

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/stopwatch.h"
#include "core/device/program_cache.h"

#include <optional>
#include <sstream>
#include <utility>

namespace tetrace::cuda {

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
                                            ": a newer driver, or NVRTC of a CUDA that this driver knows (package " +
                                            "nvidia-cuda-toolkit), brings it");
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
