#pragma once

#include "backends/cuda/handles.h"
#include "backends/cuda/nvrtc.h"
#include "backends/embedded.h"

#include <filesystem>

namespace tetrace::cuda {

/// Where a backend's kernels come from.
struct Programs {
    std::span<const EmbeddedKernel> sources = {}; ///< <method>_<layout>, probe and defects: texts for NVRTC
    std::span<const EmbeddedKernel> code = {};    ///< the same with _<math>: what the build compiled
    std::string compiler = {};                    ///< of the code, "nvcc 13.0"
    const Nvrtc& (*nvrtc)() = nullptr;            ///< loads NVRTC when called; null: NVRTC is not used

    [[nodiscard]] bool has_nvrtc() const { return nvrtc != nullptr && nvrtc().reason().empty(); }
};

/// A source's name and how it is compiled.
struct ProgramId {
    std::string source; ///< "maria_tet80", "probe"
    MathMode math = MathMode::exact;

    [[nodiscard]] std::string name() const { return source + "_" + std::string(name_of(math)); }
};
[[nodiscard]] ProgramId program_of(const KernelId& kernel);

/// NVRTC's options, the same as nvcc's (CMakeLists.txt), including KERNEL_NAME.
[[nodiscard]] std::vector<std::string> compiler_options(const ProgramId& id);

struct LoadedProgram {
    Module module;
    double compile_s = 0; ///< compiled, translated by the driver, loaded
    bool cached = false;  ///< NVRTC's output came from the cache
};

/// Loads what the build compiled. If there is none, or the driver cannot use it, loads what NVRTC compiles for the
/// device.
/// capability: the device's, 10 * major + minor. cache: folder for NVRTC's output; empty: it is not kept.
/// Throws Error{unsupported} if neither is available, naming both versions where the driver is older than the compiler,
/// Error{internal} where the device is lost or NVRTC fails.
[[nodiscard]] LoadedProgram load_program(Context& context, int capability, const Programs& programs,
                                         const ProgramId& id, const std::filesystem::path& cache);

} // namespace tetrace::cuda
