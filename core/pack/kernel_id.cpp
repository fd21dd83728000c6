#include "core/pack/kernel_id.h"

#include "core/base/error.h"
#include "kernels/layouts/layout.h"

#include <algorithm>

namespace tetrace {

namespace {

/// A row of kernels/kernel_list.inc.
struct KernelRow {
    Method method;
    Layout layout;
    unsigned tasks, schedules; ///< bits
    bool is_robust, is_default;
};

template <class T>
constexpr unsigned bit(T value)
{
    return 1u << static_cast<unsigned>(value);
}

const std::vector<KernelRow>& kernel_rows()
{
    // The list's words are these constants.
#define TASK(name, ...) constexpr unsigned name = bit(Task::name);
#define GIVEN_TASK(name, ...) constexpr unsigned name = bit(Task::name);
#define CROSSING_TASK(name, ...) constexpr unsigned name = bit(Task::name);
#include "kernels/kernel_list.inc"
    constexpr unsigned tiles = bit(Schedule::tiles), persistent = bit(Schedule::persistent),
                       packets = bit(Schedule::packets), native = bit(Schedule::native),
                       pipeline = bit(Schedule::pipeline);
    constexpr bool robust = true, fallible = false, by_default = true, on_request = false;
    static const std::vector<KernelRow> rows = {
#define KERNEL(method, layout, ...) {Method::method, Layout::layout, __VA_ARGS__},
#include "kernels/kernel_list.inc"
    };
    return rows;
}

/// Without tasks, schedules and claims if the list lacks the kernel.
KernelRow row_of(const KernelId& kernel)
{
    const auto& rows = kernel_rows();
    const auto row = std::ranges::find_if(rows, [&](const KernelRow& candidate) {
        return candidate.method == kernel.method && candidate.layout == kernel.layout &&
               structure_of(candidate.layout) == kernel.structure;
    });
    return row == rows.end() ? KernelRow{kernel.method, kernel.layout, 0, 0, false, false} : *row;
}

/// Foreign kernels have math mode fast, since we do not control how they compute; packets and native have exact, as the
/// kernels that they are compared with.
bool has_math(const KernelId& kernel)
{
    if (!is_portable(kernel)) return kernel.math == MathMode::fast;
    return kernel.math == MathMode::exact || is_common(kernel.schedule);
}

void add_kernels(std::vector<KernelId>& kernels, Task task, Structure structure, bool portable)
{
    for (const Schedule schedule : values_of<Schedule>())
        for (const MathMode math : {MathMode::exact, MathMode::fast})
            for (const KernelRow& row : kernel_rows()) {
                const KernelId kernel{structure_of(row.layout), row.method, row.layout, math, schedule, task};
                if (kernel.structure == structure && is_portable(kernel) == portable &&
                    (row.schedules & bit(schedule)) != 0 && has_math(kernel) && has_task(kernel))
                    kernels.push_back(kernel);
            }
}

} // namespace

const std::vector<KernelId>& all_kernels()
{
    static const std::vector<KernelId> kernels = kernels_of(Task::trace);
    return kernels;
}

std::vector<KernelId> kernels_of(Task task)
{
    std::vector<KernelId> kernels;
    for (const bool portable : {true, false})
        for (const Structure structure : {Structure::cdt, Structure::bvh})
            add_kernels(kernels, task, structure, portable);
    return kernels;
}

bool has_packets(const KernelId& kernel)
{
    return (row_of(kernel).schedules & bit(Schedule::packets)) != 0 && kernel.math == MathMode::exact;
}

bool has_task(const KernelId& kernel)
{
    const TaskTraits& task = traits_of(kernel.task);
    const bool has_schedule = task.finds_hits || kernel.schedule == Schedule::tiles ||
                              (task.has_packets && kernel.schedule == Schedule::packets);
    if (!has_schedule) return false;
    if (task.crosses && kernel.math != MathMode::exact) return false;
    return (row_of(kernel).tasks & bit(kernel.task)) != 0;
}

Structure structure_of(Layout layout)
{
    const Family family = traits_of(layout).family;
    return family == Family::cdt || family == Family::compact ? Structure::cdt : Structure::bvh;
}

bool is_embree(Layout layout)
{
    return layout == Layout::embree || layout == Layout::embree_medium || layout == Layout::embree_robust;
}

unsigned packet_width(Method method)
{
    return method == Method::packet8 ? 8 : method == Method::packet16 ? 16 : 0;
}

std::string embree_title(std::string_view method, std::string_view layout)
{
    const std::size_t tree = layout.find('_');
    std::string title(method);
    if (tree != std::string_view::npos) title.append(" ").append(layout.substr(tree + 1));
    return title;
}

bool is_compact(Layout layout)
{
    return traits_of(layout).family == Family::compact;
}

bool is_portable(const KernelId& kernel)
{
    return traits_of(kernel.layout).family != Family::foreign;
}

bool claims_robustness(const KernelId& kernel)
{
    return kernel.math == MathMode::exact && row_of(kernel).is_robust;
}

bool is_default(const KernelId& kernel)
{
    return row_of(kernel).is_default;
}

std::string_view name_of(Method value)
{
    return traits_of(value).name;
}

std::string_view name_of(Layout value)
{
    return traits_of(value).name;
}

std::string name_of(const KernelId& kernel)
{
    std::string name(traits_of(kernel.task).finds_hits ? name_of(kernel.structure) : name_of(kernel.task));
    name.append("/").append(name_of(kernel.method)).append("/").append(name_of(kernel.layout));
    return name;
}

const TaskTraits& traits_of(Task task)
{
    switch (task) {
#define TASK(name, text, count, ...)                                                                                   \
    case Task::name: {                                                                                                 \
        static constexpr TaskTraits traits{.what = text, .words = count __VA_OPT__(, ) __VA_ARGS__};                   \
        return traits;                                                                                                 \
    }
#define GIVEN_TASK(name, text, count, ...)                                                                             \
    case Task::name: {                                                                                                 \
        static constexpr TaskTraits traits{                                                                            \
            .what = text, .words = count, .takes_rays = true __VA_OPT__(, ) __VA_ARGS__};                              \
        return traits;                                                                                                 \
    }
#define CROSSING_TASK(name, text, of_task, ...)                                                                        \
    case Task::name: {                                                                                                 \
        static constexpr TaskTraits traits{.what = text,                                                               \
                                           .help = of_task,                                                            \
                                           .words = HIT_WORDS,                                                         \
                                           .takes_rays = true,                                                         \
                                           .crosses = true __VA_OPT__(, ) __VA_ARGS__};                                \
        return traits;                                                                                                 \
    }
#include "kernels/kernel_list.inc"
    }
    throw Error(ErrorKind::internal, "traits_of: no such task");
}

const MethodTraits& traits_of(Method method)
{
    [[maybe_unused]] constexpr bool doubles = true; // the list's word
    switch (method) {
#define METHOD(name, ...)                                                                                              \
    case Method::name: {                                                                                               \
        static constexpr MethodTraits traits{#name, __VA_ARGS__};                                                      \
        return traits;                                                                                                 \
    }
#include "kernels/kernel_list.inc"
    }
    throw Error(ErrorKind::internal, "traits_of: no such method");
}

const LayoutTraits& traits_of(Layout layout)
{
    constexpr std::uint64_t indices = std::uint64_t{1} << 32;
    switch (layout) {
#define LAYOUT(name, family, ...)                                                                                      \
    case Layout::name: {                                                                                               \
        static constexpr LayoutTraits traits{#name, Family::family, __VA_ARGS__, pack_##name};                         \
        return traits;                                                                                                 \
    }
#define FOREIGN_LAYOUT(name)                                                                                           \
    case Layout::name: {                                                                                               \
        static constexpr LayoutTraits traits{#name, Family::foreign, 0, 0, 0, {}};                                     \
        return traits;                                                                                                 \
    }
#include "kernels/kernel_list.inc"
    }
    throw Error(ErrorKind::internal, "traits_of: no such layout");
}

} // namespace tetrace
