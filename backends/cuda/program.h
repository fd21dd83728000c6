#pragma once

#include "backends/cuda/handles.h"
#include "backends/embedded.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tetrace::cuda {

/// NVIDIA's run-time compiler, loaded if it is found: it compiles a kernel's text for a device.
class Nvrtc {
public:
    /// Looks for the library by its names (CUDA 13, 12, 11.2) where the loader looks, then in the toolkits' usual
    /// folders. It stays loaded.
    [[nodiscard]] static const Nvrtc& installed();

    /// Empty if it can be used; else what was looked for and what to install.
    [[nodiscard]] const std::string& reason() const { return reason_; }
    [[nodiscard]] std::string version() const; ///< "13.0"

    /// The target to compile for: machine code ("sm_90") if the compiler knows the device, else assembly for the newest
    /// older device that it knows ("compute_90"), which the driver translates.
    /// capability: 10 * major + minor. Throws Error{unsupported} if the device is older than all that the compiler
    /// knows.
    [[nodiscard]] std::string target(int capability) const;

    /// Code, or assembly, for a target. text: ends with a 0. name: in the compiler's messages. options: for example
    /// "--fmad=false". Throws Error{driver} with the compiler's log.
    [[nodiscard]] std::vector<unsigned char> compile(const char* text, const std::string& name,
                                                     const std::string& target,
                                                     std::span<const std::string> options) const;

private:
    using Program = struct ProgramState*;
    using GetSize = int (*)(Program, std::size_t*);
    using GetText = int (*)(Program, char*);

    Nvrtc();
    void load();
    [[nodiscard]] std::string output(Program program, GetSize size, GetText text) const;
    void check(int result, const std::string& doing) const;

    // The library's functions, as in its binary interface.
    int (*version_)(int* major, int* minor) = nullptr;
    const char* (*error_text_)(int result) = nullptr;
    int (*target_count_)(int* count) = nullptr;
    int (*targets_)(int* capabilities) = nullptr;
    int (*create_)(Program* program, const char* text, const char* name, int headers, const char* const* texts,
                   const char* const* names) = nullptr;
    int (*destroy_)(Program* program) = nullptr;
    int (*compile_)(Program program, int count, const char* const* options) = nullptr;
    GetSize log_size_ = nullptr, code_size_ = nullptr, assembly_size_ = nullptr;
    GetText log_ = nullptr, code_ = nullptr, assembly_ = nullptr;
    std::string reason_;
};

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

/// As kernel.cu calls a kernel's entry point. starts_outside: of task trace, no ray starts in a tet.
[[nodiscard]] std::string entry_name(const KernelId& kernel, bool starts_outside);

/// Threads of a block of schedule persistent: four warps, of which enough blocks fit for every warp that a device
/// holds.
inline constexpr unsigned persistent_block_threads = 128;

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
/// Error{driver} where the device is lost or NVRTC fails.
[[nodiscard]] LoadedProgram load_program(Context& context, int capability, const Programs& programs,
                                         const ProgramId& id, const std::filesystem::path& cache);

} // namespace tetrace::cuda
