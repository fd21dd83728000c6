#include "bench/debugging/dump.h"

#include "backends/webgpu/kernels.h"
#include "bench/options/browser_api.h"
#include "bench/options/identity.h"
#include "bench/options/option_values.h"
#include "bench/rows/rows.h"
#include "bench/terminal/text.h"
#include "bench/variants/variant_program.h"
#include "core/base/error.h"
#include "core/base/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace tetrace {

namespace {

template <class T>
bool is_asked(const std::vector<T>& asked, T value)
{
    return asked.empty() || std::ranges::find(asked, value) != asked.end();
}

template <class T>
void require_one(const Options& options, const char* option, const std::vector<T>& values)
{
    if (values.size() > 1)
        throw Error(ErrorKind::usage, fmt::format("{}: {} accepts one value here; {} are given", name_of(options.verb),
                                                  option, values.size()));
}

} // namespace

KernelId one_kernel(const Options& options)
{
    require_one(options, "--method", options.methods);
    require_one(options, "--layout", options.layouts);
    require_one(options, "--math", options.math);
    const MathMode math = options.math.empty() ? MathMode::exact : options.math.front();
    std::vector<KernelId> fitting;
    for (const KernelId& kernel : all_kernels())
        if (is_asked(options.methods, kernel.method) && is_asked(options.layouts, kernel.layout) &&
            (kernel.math == math || !is_portable(kernel)) && kernel.schedule == Schedule::tiles)
            fitting.push_back(kernel);
    if (fitting.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("{}: no kernel of task trace has {}{}{}", name_of(options.verb),
                                options.methods.empty() ? "" : "method " + join_names(options.methods),
                                options.methods.empty() || options.layouts.empty() ? "" : " and ",
                                options.layouts.empty() ? "" : "layout " + join_names(options.layouts)));
    const auto usual = std::ranges::find_if(fitting, [](const KernelId& kernel) { return is_default(kernel); });
    return usual != fitting.end() ? *usual : fitting.front();
}

namespace {

Backend& chosen(const Options& options, const std::vector<Backend*>& backends)
{
    return **std::ranges::find(backends, options.backends.front(), &Backend::name);
}

std::string in_file_name(std::string text)
{
    std::ranges::replace_if(
        text, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-'; }, '-');
    return text;
}

std::string name_of_code(const KernelId& kernel, const Device& device, std::size_t index, bool starts_outside)
{
    return fmt::format("{}_{}_{}_{}-{}-{}.txt", name_of(kernel.method), name_of(kernel.layout), name_of(kernel.math),
                       starts_outside ? "outside" : "inside", index, in_file_name(device.implementation));
}

/// The WGSL of each task that pages have.
std::vector<KernelFile> page_files(const KernelId& asked)
{
    std::vector<KernelFile> files;
    for (const Task task : values_of<Task>()) {
        KernelId kernel = asked;
        kernel.task = task;
        const std::string_view text = webgpu::kernel_text(kernel);
        if (text.empty()) continue;
        const std::string name =
            fmt::format("{}_{}_{}.wgsl", name_of(kernel.method), name_of(kernel.layout), name_of(task));
        files.push_back({name, fmt::format("WGSL of task {}, for any WebGPU device", name_of(task)), "naga " + name,
                         std::string(text)});
    }
    if (files.empty())
        throw Error(ErrorKind::usage, fmt::format("dump: a page has no kernel of {} in math mode {}", name_of(asked),
                                                  name_of(asked.math)));
    return files;
}

/// The kernel with the task of --entry.
KernelId kernel_of_entry(const Options& options, KernelId kernel)
{
    require_one(options, "--entry", options.entries);
    if (options.entries.empty()) return kernel;
    if (options.entries.front() == Entry::inside)
        throw Error(ErrorKind::usage, "dump: --entry: a variant's command has primary rays from outside, not inside; "
                                      "'outside' is accepted");
    kernel.task = value_named<Task>(name_of(options.entries.front())).value_or(Task::trace); // outside and inside
    if (!has_task(kernel))
        throw Error(ErrorKind::usage,
                    fmt::format("dump: --entry: {} on {} has no entry point '{}'", name_of(kernel.method),
                                name_of(kernel.layout), name_of(options.entries.front())));
    return kernel;
}

bool is_kept(const Options& options, const Backend& backend, std::size_t index)
{
    const Device& device = backend.devices()[index];
    return (device.usable || device.compile_only) && wanted_device(options, backend, index);
}

} // namespace

std::vector<KernelFile> dumped_files(const Options& options, const std::vector<Backend*>& backends)
{
    const KernelId kernel = one_kernel(options);
    if (options.backends.front() == browser_api) {
        if (!options.changes.empty())
            throw Error(ErrorKind::usage, fmt::format("dump: --variant: {} has no variants", browser_api));
        return page_files(kernel);
    }
    const Backend& backend = chosen(options, backends);
    std::vector<KernelFile> files = backend.kernel_files(kernel);
    if (!options.changes.empty() && !files.empty()) {
        const KernelId entered = kernel_of_entry(options, kernel);
        const VariantProgram variant(backend.name(), entered);
        return {variant.text_file(variant.text().with(variant.text().named(options.changes)),
                                  fmt::format("; with the changes {}. The command is for {}; the text has all "
                                              "entry points",
                                              fmt::join(options.changes, ", "), traits_of(entered.task).what))};
    }
    if (files.empty())
        throw Error(
            ErrorKind::usage,
            fmt::format("dump: {} has neither source nor code of {}{}", backend.name(), name_of(kernel),
                        std::ranges::none_of(all_kernels(),
                                             [&](const KernelId& one) { return !backend.kernel_files(one).empty(); })
                            ? ": its kernels are parts of this program; objdump -d shows them"
                            : ""));
    return files;
}

std::vector<KernelFile> driver_code(const Options& options, const std::vector<Backend*>& backends,
                                    std::vector<std::string>& notes)
{
    const KernelId kernel = one_kernel(options);
    if (options.backends.front() == browser_api || !options.changes.empty()) return {};
    const Backend& backend = chosen(options, backends);
    std::vector<KernelFile> files;
    bool has_device = false;
    for (std::size_t i = 0; backend.shows_code() && i < backend.devices().size(); ++i) {
        if (!is_kept(options, backend, i)) continue;
        has_device = true;
        const Device& device = backend.devices()[i];
        try {
            const CompiledCode code = backend.compiled(i, kernel, true, {});
            if (code.text.empty())
                notes.push_back(
                    fmt::format("{}: its driver reports statistics of its code, but not the code", device.name));
            else
                files.push_back({name_of_code(kernel, device, i, true),
                                 fmt::format("the code from {}, for primary rays from outside", code.compiler),
                                 {},
                                 code.text});
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::interrupted) throw;
            notes.push_back(printable_line(error.what()));
        }
    }
    if (backend.shows_code() && !has_device)
        notes.push_back(fmt::format("a driver's code: no device of {}{}", backend.name(),
                                    options.devices.empty() ? " is usable" : " matches --device"));
    return files;
}

std::string dump_title(const Options& options)
{
    return fmt::format("{} for {}", name_of(one_kernel(options)), options.backends.front());
}

std::string readme_of(const std::string& title, const std::vector<KernelFile>& files,
                      const std::vector<std::string>& notes, std::size_t width)
{
    const BuildIdentity build = build_identity();
    std::string text =
        wrapped(fmt::format("{}, written by tetrace {} ({})", title, build.version, build.commit), width, 0) + "\n";
    for (const KernelFile& file : files) {
        text += fmt::format("{} ({} bytes)\n{}", file.name, file.bytes.size(), wrapped(file.what + ".", width, 4));
        text += file.command.empty() ? std::string("\n") : fmt::format("    $ {}\n\n", file.command);
    }
    for (const std::string& note : notes)
        text += wrapped("Not here: " + note + ".", width, 0);
    return text;
}

} // namespace tetrace
