#pragma once

#include "backends/opencl/context.h"
#include "core/device/program_cache.h"
#include "core/pack/kernel_id.h"

#include <string>
#include <string_view>

namespace tetrace::opencl {

/// The name of a kernel's program among embedded_kernels(), for any math mode and schedule.
[[nodiscard]] std::string source_name(const KernelId& kernel);

/// The options of a math mode on every device, each with a blank before it.
[[nodiscard]] std::string_view math_options(MathMode math);

/// What decides a program: one of embedded_kernels() and how it is compiled.
struct ProgramId {
    std::string source; ///< its name
    MathMode math = MathMode::exact;
    std::string defines = {}; ///< further options: "-DGROUP_ITEMS=64"
};

/// A program compiled for a context's device, or taken from a cache.
class Program {
public:
    /// Throws Error{driver} with the compiler's messages if it fails.
    Program(Context& context, const ProgramId& id, const ProgramCache& cache);

    [[nodiscard]] const cl::Program& handle() const { return handle_; }
    [[nodiscard]] bool is_cached() const { return is_cached_; }
    /// Puts it into the cache, unless it came from there. Call it after the kernels' first run: some drivers finish
    /// compiling only then.
    void keep() const;

private:
    [[nodiscard]] bool load(const Context& context);
    void compile(Context& context, const ProgramId& id, std::string_view source);

    const ProgramCache& cache_;
    std::string options_;
    std::uint64_t key_ = 0;
    cl::Program handle_;
    bool is_cached_ = false;
};

} // namespace tetrace::opencl
