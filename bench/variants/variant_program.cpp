#include "bench/variants/variant_program.h"

#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/printable.h"
#include "core/device/backend.h"
#include "core/isolation/isolation.h"
#include "scenes/child_process.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace tetrace {

namespace {

constexpr double max_compile_s = 60; // glslang takes less than one
constexpr int not_found = 127;       // of env

} // namespace

VariantProgram::VariantProgram(const std::string& backend, const KernelId& kernel)
    : VariantProgram(source_of(backend, kernel))
{
}

VariantProgram::Source VariantProgram::source_of(const std::string& backend, const KernelId& kernel)
{
    const std::string name = fmt::format("{}_{}", name_of(kernel.method), name_of(kernel.layout));
    const std::string spirv = fmt::format("{}_{}_{}.spv", name, name_of(kernel.math), name_of(kernel.task));
    const auto files = backend_named(backend, direct_backends()).kernel_files(kernel);
    const auto find = [&](const std::string& wanted) { return std::ranges::find(files, wanted, &KernelFile::name); };
    if (const auto text = find(name + ".cl"); text != files.end()) return {text->name, text->bytes, {}, {}};
    const auto text = find(name + ".comp"), program = find(spirv);
    if (text == files.end() || program == files.end() || !is_portable(kernel))
        throw Error(ErrorKind::unsupported,
                    fmt::format("{} has no text of {} that is compiled here; opencl and vulkan have", backend,
                                name_of(kernel)));
    return {text->name, text->bytes, program->name, program->command};
}

std::filesystem::path VariantProgram::write(const std::string& text, const std::filesystem::path& folder) const
{
    write_whole(folder / source_.name, text);
    if (source_.program.empty()) return folder / source_.name;
    std::vector<std::string> words;
    std::istringstream command(source_.command);
    for (std::string word; command >> word;)
        words.push_back(word == source_.name || word == source_.program ? (folder / word).string() : word);
    const ChildOutcome outcome = run_child("/usr/bin/env", words, {.time_s = max_compile_s});
    if (outcome.end == ChildOutcome::End::interrupted) throw Error(ErrorKind::interrupted, "variants: interrupted");
    if (outcome.end == ChildOutcome::End::exited && outcome.code == 0) return folder / source_.program;
    if (outcome.end == ChildOutcome::End::exited && outcome.code == not_found)
        throw Error(ErrorKind::missing,
                    fmt::format("{} is missing, which compiles variants for Vulkan; install glslang-tools", words[0]));
    throw Error(ErrorKind::driver, fmt::format("{} did not compile {}: {}", words[0], source_.name,
                                               printable_text(outcome.out + outcome.errors)));
}

} // namespace tetrace
