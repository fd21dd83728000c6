#pragma once

#include "backends/opencl/context.h"
#include "core/device/program_cache.h"
#include "core/pack/kernel_id.h"

#include <filesystem>
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
    std::string defines = {};        ///< further options: "-DGROUP_ITEMS=64"
    std::string standard = "CL1.2";  ///< version of OpenCL C
    std::filesystem::path file = {}; ///< its text, in place of the embedded one; empty: that
};

/// "-DSEGMENTS": by which kernel.cl knows a task that is given rays.
[[nodiscard]] std::string define_of(Task task);

/// ProgramId::defines of a kernel. in_parts: the tets are in several buffers. starts_outside: no ray of an image starts
/// in a tet. stack_top: as FoundDevice has it.
[[nodiscard]] std::string defines_of(const KernelId& kernel, unsigned tile_height, bool in_parts, bool starts_outside,
                                     unsigned stack_top);

/// What the device's compiler is given for a program.
[[nodiscard]] std::string build_options(const FoundDevice& device, const ProgramId& id);

/// The arguments of kernel.cl's entry: these, then the scene's arrays, then the parts of the tets.
enum Argument : cl_uint {
    launch_argument,
    end_tile_argument,
    output_argument,
    counter_argument,
    rays_argument,
    first_array_argument
};

/// A program compiled for a context's device, or taken from a cache.
class Program {
public:
    /// Throws Error{driver} with the compiler's messages if it fails, Error{missing} if the file cannot be read.
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
