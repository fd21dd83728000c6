#include "bench/inspection/inspected.h"

#include "bench/options/option_values.h"

#include <algorithm>
#include <array>
#include <utility>

namespace tetrace {

namespace {

constexpr std::array default_targets = {"gfx1100", "navi21", "gfx906", "sm_75", "sm_90"};

/// Names of one GPU: the instruction set's, and the chip's.
constexpr std::array<std::pair<const char*, const char*>, 11> other_names = {{{"gfx803", "polaris10"},
                                                                              {"gfx900", "vega10"},
                                                                              {"gfx906", "vega20"},
                                                                              {"gfx908", "arcturus"},
                                                                              {"gfx90a", "aldebaran"},
                                                                              {"gfx1010", "navi10"},
                                                                              {"gfx1030", "navi21"},
                                                                              {"gfx1031", "navi22"},
                                                                              {"gfx1100", "navi31"},
                                                                              {"gfx1101", "navi32"},
                                                                              {"gfx1102", "navi33"}}};

bool consists_of(const std::string& text, const char* accepted)
{
    return !text.empty() && text.size() <= 20 && text.find_first_not_of(accepted) == std::string::npos;
}

} // namespace

Target parse_target(const std::string& option, const std::string& text)
{
    if (text.starts_with("sm_") && consists_of(text.substr(3), "0123456789")) return {text, Maker::nvidia};
    if (consists_of(text, "abcdefghijklmnopqrstuvwxyz0123456789")) return {text, Maker::amd};
    reject_value(option, text, "an AMD family as RADV names it (gfx1100, navi21, ...), or sm_ and a number");
}

std::vector<Target> targets_of(const std::vector<std::string>& names)
{
    std::vector<Target> targets;
    for (const std::string& name :
         names.empty() ? std::vector<std::string>(default_targets.begin(), default_targets.end()) : names)
        if (std::ranges::none_of(targets, [&](const Target& target) { return target.name == name; }))
            targets.push_back(parse_target("--target", name));
    return targets;
}

std::vector<std::string> family_names(const std::string& target)
{
    std::vector<std::string> names = {target};
    for (const auto& [set, chip] : other_names)
        if (target == set)
            names.emplace_back(chip);
        else if (target == chip)
            names.emplace_back(set);
    return names;
}

namespace {

template <class T>
bool keeps(const std::vector<T>& list, const T& value)
{
    return list.empty() || std::ranges::find(list, value) != list.end();
}

void add_entries(std::vector<EntryPoint>& points, const KernelId& kernel)
{
    points.push_back({kernel, Entry::outside});
    if (kernel.structure == Structure::cdt) points.push_back({kernel, Entry::inside});
    for (const Task task : values_of<Task>()) {
        KernelId other = kernel;
        other.task = task;
        if (traits_of(task).takes_rays && has_task(other))
            points.push_back({other, *value_named<Entry>(name_of(task))});
    }
}

} // namespace

std::vector<EntryPoint> all_entry_points(Maker maker)
{
    std::vector<EntryPoint> points;
    for (const KernelId& kernel : all_kernels()) {
        const bool is_there =
            kernel.schedule == Schedule::tiles || (maker == Maker::nvidia && kernel.schedule == Schedule::persistent);
        if (is_portable(kernel) && is_there) add_entries(points, kernel);
    }
    return points;
}

bool wants(const Options& options, const EntryPoint& point)
{
    const KernelId& kernel = point.kernel;
    const bool wants_method = options.methods.empty() ? is_default(kernel) : keeps(options.methods, kernel.method);
    const bool wants_math = options.math.empty() ? kernel.math == MathMode::exact : keeps(options.math, kernel.math);
    return keeps(options.structures, kernel.structure) && wants_method && wants_math &&
           keeps(options.layouts, kernel.layout) && keeps(options.schedules, kernel.schedule) &&
           keeps(options.entries, point.entry);
}

std::string name_of(const EntryPoint& point)
{
    const std::string name(name_of(point.entry));
    return point.kernel.schedule == Schedule::tiles ? name : name + " persistent";
}

} // namespace tetrace
