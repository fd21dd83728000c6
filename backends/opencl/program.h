#pragma once

#include "backends/opencl/context.h"
#include "core/device/program_cache.h"
#include "core/pack/kernel_id.h"

#include <string>

namespace tetrace::opencl {

/// The program of a kernel among embedded_kernels(), whatever its math mode and schedule.
[[nodiscard]] std::string source_name(const KernelId& kernel);

/// What decides a program: one of embedded_kernels() and how it is compiled.
struct ProgramId {
    std::string source; ///< its name
    MathMode math = MathMode::exact;
    std::string defines = {}; ///< further options: "-DGROUP_ITEMS=64"
};

/// A program compiled for a context's device, from a cache where it is there.
class Program {
public:
    /// Throws Error{internal} with the compiler's own words where it fails.
    Program(Context& context, const ProgramId& id, const ProgramCache& cache);

    [[nodiscard]] const cl::Program& handle() const { return handle_; }
    [[nodiscard]] bool is_cached() const { return is_cached_; }
    /// Puts it into the cache, unless it came from there: after its kernels ran first, which is when some drivers
    /// finish it.
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
