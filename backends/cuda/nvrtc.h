#pragma once

#include <cstddef>
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
    /// "--fmad=false". Throws Error{internal} with the compiler's log.
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

} // namespace tetrace::cuda
