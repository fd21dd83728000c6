#include "backends/cuda/files.h"

#include "core/base/error.h"

namespace tetrace::cuda {

namespace {

constexpr const char* ptx_target = "compute_75"; // the oldest that CUDA 13 knows; any later GPU's driver takes it

std::string joined(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words)
        text += " " + word;
    return text;
}

/// Throws Error{missing} if NVRTC is not here, and as Nvrtc::compile().
std::string ptx_of(const Programs& programs, const EmbeddedKernel& source, const ProgramId& id)
{
    if (!programs.has_nvrtc())
        throw Error(ErrorKind::missing, programs.nvrtc == nullptr ? "NVRTC is not used" : programs.nvrtc().reason());
    const auto options = compiler_options(id);
    const auto code = programs.nvrtc().compile(source.text().data(), id.name(), ptx_target, options);
    std::string text(code.begin(), code.end());
    while (!text.empty() && text.back() == '\0')
        text.pop_back();
    return text;
}

} // namespace

std::vector<KernelFile> kernel_files(const Programs& programs, const KernelId& kernel)
{
    const ProgramId id = program_of(kernel);
    const EmbeddedKernel* const source = find_kernel(programs.sources, id.source);
    if (source == nullptr) return {};
    const std::string ptx = id.name() + ".ptx", text = id.source + ".cu";
    const std::string command = "nvcc --ptx -std=c++17 -arch=" + std::string(ptx_target) +
                                joined(compiler_options(id)) + " -o " + ptx + " " + text;
    std::vector<KernelFile> files = {
        {text, "CUDA C++ with its includes resolved, as NVRTC and nvcc get it", command, std::string(source->text())}};
    try {
        files.push_back({ptx, "PTX, by NVRTC", "ptxas -v -arch=sm_75 -o " + id.name() + ".cubin " + ptx,
                         ptx_of(programs, *source, id)});
    } catch (const Error& error) {
        files.front().what += "; without PTX, because " + std::string(error.what());
    }
    if (const EmbeddedKernel* const code = find_kernel(programs.code, id.name()))
        files.push_back({id.name() + ".fatbin", "machine code, by " + programs.compiler + ", as the driver gets it",
                         "cuobjdump --dump-sass " + id.name() + ".fatbin", std::string(code->text())});
    return files;
}

} // namespace tetrace::cuda
