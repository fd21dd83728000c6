#include "bench/debugging/one_kernel.h"

#include "bench/options/option_values.h"

#include <algorithm>
#include <fmt/format.h>

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
        throw Error(ErrorKind::usage, fmt::format("{}: no kernel has method {} and layout {}", name_of(options.verb),
                                                  join_names(options.methods), join_names(options.layouts)));
    const auto usual = std::ranges::find_if(fitting, [](const KernelId& kernel) { return is_default(kernel); });
    return usual != fitting.end() ? *usual : fitting.front();
}

} // namespace tetrace
