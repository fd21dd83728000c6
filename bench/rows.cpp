#include "bench/rows.h"

#include "core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <regex>

namespace tetrace {

namespace {

template <class T>
bool wanted(const std::vector<T>& list, const T& value)
{
    return list.empty() || std::find(list.begin(), list.end(), value) != list.end();
}

bool wanted_math(const Options& options, const KernelId& kernel)
{
    if (kernel.structure != Structure::cdt) return true;
    return options.math.empty() ? kernel.math == MathMode::exact : wanted(options.math, kernel.math);
}

std::vector<TetOrder> wanted_orders(const Options& options, const KernelId& kernel)
{
    if (kernel.structure != Structure::cdt || options.orders.empty()) return {TetOrder::hilbert};
    return options.orders;
}

bool wanted_kernel(const Options& options, const KernelId& kernel)
{
    return kernel.schedule == Schedule::tiles && wanted(options.structures, kernel.structure) &&
           wanted(options.methods, kernel.method) && wanted(options.layouts, kernel.layout) &&
           wanted_math(options, kernel);
}

bool filter_keeps(const std::string& filter, const std::string& name)
{
    return filter.empty() || std::regex_search(name, std::regex(filter));
}

std::vector<RowKey> rows_of_scene(const Options& options, const std::string& scene,
                                  const std::vector<Backend*>& backends)
{
    std::vector<RowKey> rows;
    for (const KernelId& kernel : all_kernels())
        for (const Backend* backend : backends) {
            if (!wanted_kernel(options, kernel) || !wanted(options.backends, backend->name())) continue;
            if (!backend->has_kernel(kernel)) continue;
            for (const TetOrder order : wanted_orders(options, kernel)) {
                const RowKey key{scene, backend->name(), kernel, RayKind::primary, order, 0};
                if (std::find(rows.begin(), rows.end(), key) == rows.end()) rows.push_back(key);
            }
        }
    return rows;
}

/// Reasons of the backends asked for, so that an empty selection explains itself.
std::string reasons(const Options& options)
{
    std::string text;
    for (const KernelId& kernel : all_kernels())
        for (const Backend* backend : all_backends())
            if (wanted_kernel(options, kernel) && wanted(options.backends, backend->name()))
                if (const std::string reason = backend->why_not(0, kernel); !reason.empty())
                    text += fmt::format("\n  {} on {}: {}", name_of(kernel), backend->name(), reason);
    return text;
}

[[noreturn]] void reject_selection(const Options& options, const std::vector<RowKey>& unfiltered)
{
    if (unfiltered.empty())
        throw Error(ErrorKind::usage,
                    "no row has this combination of --structure, --method, --layout, --backend and --math" +
                        reasons(options) + "\n'tetrace bench --list' prints the rows of the defaults");
    std::string text =
        fmt::format("--filter '{}' matches none of the {} rows selected otherwise:", options.filter, unfiltered.size());
    for (const RowKey& key : unfiltered)
        text += "\n  " + row_name(key);
    throw Error(ErrorKind::usage, text);
}

} // namespace

std::string row_name(const RowKey& key)
{
    return fmt::format("{}/{}/{}/math:{}{}{}/api:{}{}", name_of(key.kernel), key.scene, name_of(key.rays),
                       name_of(key.kernel.math), key.order == TetOrder::hilbert ? "" : "/order:input",
                       key.kernel.schedule == Schedule::tiles ? "" : "/schedule:persistent", key.backend,
                       key.device == 0 ? "" : fmt::format(":{}", key.device));
}

std::string kernel_title(const RowKey& key)
{
    if (key.kernel.structure == Structure::bvh) return fmt::format("bvh {}", name_of(key.kernel.method));
    return fmt::format("cdt {} {}{}{}{}", name_of(key.kernel.method), name_of(key.kernel.layout),
                       key.kernel.math == MathMode::exact ? "" : " fast",
                       key.order == TetOrder::hilbert ? "" : " input order",
                       key.kernel.schedule == Schedule::tiles ? "" : " persistent");
}

std::vector<RowKey> select_rows(const Options& options, const std::vector<std::string>& scene_labels,
                                const std::vector<Backend*>& backends)
{
    std::vector<RowKey> unfiltered, rows;
    for (const std::string& scene : scene_labels)
        for (const RowKey& key : rows_of_scene(options, scene, backends))
            unfiltered.push_back(key);
    for (const RowKey& key : unfiltered)
        if (filter_keeps(options.filter, row_name(key))) rows.push_back(key);
    if (rows.empty()) reject_selection(options, unfiltered);
    return rows;
}

bool benchmark_filter_keeps(const std::string& filter, const std::string& name)
{
    if (filter.empty() || filter == "all") return true;
    const bool negated = filter.front() == '-';
    try {
        // Google Benchmark uses POSIX extended expressions.
        const std::regex expression(negated ? filter.substr(1) : filter, std::regex::extended);
        return std::regex_search(name, expression) != negated;
    } catch (const std::regex_error& problem) {
        throw Error(ErrorKind::usage,
                    fmt::format("--benchmark_filter: '{}' is not a regular expression: {}", filter, problem.what()));
    }
}

} // namespace tetrace
