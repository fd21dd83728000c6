#include "backends/opencl/program.h"

#include "backends/opencl/kernels.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "kernels/layouts/layout.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace tetrace::opencl {

namespace {

std::uint64_t key_of(const FoundDevice& device, const std::string& options, std::string_view source)
{
    std::uint64_t key = hash_of(device.build_key);
    key = hash_of(options, key);
    return hash_of(source, key);
}

std::string text_of(const ProgramId& id)
{
    if (!id.file.empty()) return required_bytes(id.file);
    const EmbeddedKernel* const source = find_kernel(embedded_kernels(), id.source);
    if (source == nullptr) throw Error(ErrorKind::internal, "opencl lacks program '" + id.source + "'");
    return std::string(source->text());
}

std::string build_log(const cl::BuildError& failure)
{
    std::string text;
    for (const auto& [device, log] : failure.getBuildLog())
        text += log;
    constexpr std::size_t longest = 4000;
    return text.size() > longest ? text.substr(0, longest) + "..." : text;
}

} // namespace

std::string source_name(const KernelId& kernel)
{
    return std::string(name_of(kernel.method)).append("_").append(name_of(kernel.layout));
}

std::string_view math_options(MathMode math)
{
    return math == MathMode::fast ? " -DMATH_FAST -cl-fast-relaxed-math -cl-denorms-are-zero" : "";
}

std::string define_of(Task task)
{
    std::string define = "-D";
    std::ranges::transform(name_of(task), std::back_inserter(define), [](char c) { return std::toupper(c); });
    return define;
}

std::string defines_of(const KernelId& kernel, unsigned tile_height, bool in_parts, bool starts_outside,
                       unsigned stack_top)
{
    std::string defines = "-DGROUP_ITEMS=" + std::to_string(TILE_WIDTH * tile_height);
    if (kernel.schedule == Schedule::persistent) defines += " -DPERSISTENT";
    if (traits_of(kernel.task).takes_rays) {
        defines += " " + define_of(kernel.task);
    }
    if (in_parts) defines += " -DTETS_IN_PARTS";
    if (starts_outside) defines += " -DSTARTS_OUTSIDE";
    if (structure_of(kernel.layout) == Structure::bvh && stack_top > 0)
        defines += " -DSTACK_TOP=" + std::to_string(stack_top) + "u";
    return defines;
}

std::string build_options(const FoundDevice& device, const ProgramId& id)
{
    std::string options = "-cl-std=" + id.standard + " " + id.defines;
    // Oclgrind 21.10 interprets its optimiser's output, but not llvm.experimental.noalias.scope.decl, which comes from
    // inlined functions that return structs.
    if (device.facts.implementation.starts_with("oclgrind")) options += " -cl-opt-disable -DCALLS_FUNCTIONS";
    // It takes asm statements, at which PoCL 6.0 ends with an assertion. PoCL drives GPUs, too.
    if (device.facts.implementation.starts_with("pocl-3.") && device.facts.kind != DeviceKind::gpu)
        options += " -DPREDICTS_BRANCHES";
    options += math_options(id.math);
    if (id.math == MathMode::fast) return options;
    // No decision has denormals (docs/spec/numbers.md, N1). Unused lanes of a processor's vectors may have them, where
    // compilers compute with all words of a quad, and some processors multiply denormals a hundred times slower.
    if (device.facts.kind != DeviceKind::gpu) options += " -cl-denorms-are-zero";
    return device.divides_correctly ? options + " -cl-fp32-correctly-rounded-divide-sqrt" : options;
}

Program::Program(Context& context, const ProgramId& id, const ProgramCache& cache)
    : cache_(cache), options_(build_options(context.found(), id))
{
    const std::string text = text_of(id);
    key_ = key_of(context.found(), options_, text);
    is_cached_ = load(context);
    if (!is_cached_) compile(context, id, text);
}

/// Whether the cache had it and the driver still accepts it.
bool Program::load(const Context& context)
{
    const auto binary = cache_.find(key_);
    if (!binary) return false;
    try {
        handle_ = cl::Program(context.handle(), {context.device()}, {*binary});
        handle_.build({context.device()}, options_.c_str());
        return true;
    } catch (const cl::Error&) {
        return false;
    }
}

void Program::compile(Context& context, const ProgramId& id, std::string_view source)
{
    context.run("compiling " + id.source, 0, [&] {
        handle_ = cl::Program(context.handle(), std::string(source));
        try {
            handle_.build({context.device()}, options_.c_str());
        } catch (const cl::BuildError& failure) {
            throw Error(ErrorKind::driver, "compiling " + id.source + " with '" + options_ + "' on '" +
                                               context.facts().name + "': " + error_name(failure.err()) + "\n" +
                                               build_log(failure));
        }
    });
}

void Program::keep() const
{
    if (is_cached_ || !cache_.keeps()) return;
    try {
        const auto binaries = handle_.getInfo<CL_PROGRAM_BINARIES>();
        if (binaries.size() == 1 && !binaries.front().empty()) cache_.keep(key_, binaries.front());
    } catch (const cl::Error&) {
        return; // if a driver does not return its binary, the next run compiles again
    }
}

} // namespace tetrace::opencl
