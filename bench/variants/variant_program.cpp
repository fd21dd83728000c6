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

// glslang takes less than a second, g++ and nvcc some; a busy machine may let them wait.
constexpr ChildLimits compiling{.time_s = 600, .processor_s = 60};
constexpr int not_found = 127; // of env

} // namespace

VariantProgram::VariantProgram(const std::string& backend, const KernelId& kernel)
    : VariantProgram(source_of(backend, kernel))
{
}

VariantProgram::Source VariantProgram::source_of(const std::string& backend, const KernelId& kernel)
{
    const std::string name = fmt::format("{}_{}", name_of(kernel.method), name_of(kernel.layout));
    const std::string with_math = fmt::format("{}_{}", name, name_of(kernel.math));
    const Source known[] = {
        {name + ".cl", {}, {}, {}, {}, {}, {}},
        {name + ".comp", {}, fmt::format("{}_{}.spv", with_math, name_of(kernel.task)), {}, "glslang-tools", {}, {}},
        {name + ".cu", {}, with_math + ".ptx", {}, "nvidia-cuda-toolkit", {}, {}},
        {with_math + ".cpp", {}, with_math + ".so", {}, "g++, or set CXX", {}, {}},
    };
    const auto files = backend_named(backend, direct_backends()).kernel_files(kernel);
    for (Source source : known) {
        const auto text = std::ranges::find(files, source.name, &KernelFile::name);
        const auto maker = std::ranges::find_if(files, [&](const KernelFile& file) {
            return file.command.ends_with(" -o " + source.program + " " + source.name);
        });
        if (text == files.end() || !is_portable(kernel)) continue;
        if (maker == files.end() && !source.program.empty()) continue;
        source.text = text->bytes;
        if (!source.program.empty()) source.command = maker->command;
        source.what = text->what;
        source.readme_command = source.command.empty() ? text->command : source.command;
        return source;
    }
    throw Error(ErrorKind::unsupported,
                fmt::format("{} has no text of {} that a compiler can be given here", backend, name_of(kernel)));
}

std::filesystem::path VariantProgram::write(const std::string& text, const std::filesystem::path& folder) const
{
    write_whole(folder / source_.name, text);
    if (source_.program.empty()) return folder / source_.name;
    std::vector<std::string> words;
    std::istringstream command(source_.command);
    for (std::string word; command >> word;)
        words.push_back(word == source_.name || word == source_.program ? (folder / word).string() : word);
    const ChildOutcome outcome = run_child("/usr/bin/env", words, compiling);
    if (outcome.end == ChildOutcome::End::interrupted) throw Error(ErrorKind::interrupted, "variants: interrupted");
    if (outcome.end == ChildOutcome::End::exited && outcome.code == 0) return folder / source_.program;
    if (outcome.end == ChildOutcome::End::exited && outcome.code == not_found)
        throw Error(ErrorKind::missing, fmt::format("{} is missing, which compiles {}; install {}", words[0],
                                                    source_.name, source_.package));
    throw Error(ErrorKind::driver, fmt::format("{} did not compile {}: {}", words[0], source_.name,
                                               printable_text(outcome.out + outcome.errors)));
}

std::vector<std::string> backends_with_texts()
{
    std::vector<std::string> names;
    for (const Backend* backend : direct_backends())
        if (std::ranges::any_of(all_kernels(),
                                [&](const KernelId& kernel) { return !backend->kernel_files(kernel).empty(); }))
            names.push_back(backend->name());
    return names;
}

} // namespace tetrace
