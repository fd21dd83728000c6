#include "backends/cuda/nvrtc.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <dlfcn.h>
#include <memory>

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
    throw Error(ErrorKind::internal, "NVRTC: " + doing + ": " + error_text_(result));
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

} // namespace tetrace::cuda
