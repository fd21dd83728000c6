#include "bench/inspection/inspected.h"

#include "bench/options/option_values.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <initializer_list>
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
    constexpr const char* letters = "abcdefghijklmnopqrstuvwxyz0123456789";
    if (text.starts_with(hip_prefix) && consists_of(text.substr(std::string(hip_prefix).size()), letters))
        return {text, Maker::hip};
    if (consists_of(text, letters)) return {text, Maker::amd};
    reject_value(
        option, text,
        "an AMD family as RADV names it (gfx1100, navi21, ...), hip: and a chip (hip:gfx90a), or sm_ and a number");
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
        const bool has_persistent = maker == Maker::nvidia || maker == Maker::driver;
        const bool is_there =
            kernel.schedule == Schedule::tiles || (has_persistent && kernel.schedule == Schedule::persistent);
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

std::string code_file_name(const EntryPoint& point)
{
    std::string entry = name_of(point);
    std::ranges::replace(entry, ' ', '-');
    return fmt::format("-{}-{}-{}-{}.s", name_of(point.kernel.method), name_of(point.kernel.layout),
                       name_of(point.kernel.math), entry);
}

namespace {

/// Under the first of these names that the statistics have, if it is a number of this program: NVIDIA's Vulkan has been
/// seen to report local memory of 2^36 bytes.
std::optional<double> statistic(const std::map<std::string, double>& statistics,
                                std::initializer_list<const char*> names)
{
    constexpr double most = 1u << 31;
    for (const char* const name : names)
        if (const auto found = statistics.find(name);
            found != statistics.end() && found->second >= 0 && found->second < most)
            return found->second;
    return std::nullopt;
}

} // namespace

void take_statistics(Inspected& row, const std::map<std::string, double>& statistics)
{
    const auto count = [&](std::initializer_list<const char*> names) -> Inspected::Count {
        const auto value = statistic(statistics, names);
        return value ? Inspected::Count(static_cast<std::uint64_t>(*value)) : std::nullopt;
    };
    row.registers = count({"VGPRs", "Register Count", "NUM_REGS"});
    row.scalar_registers = count({"SGPRs"});
    const auto vectors = count({"Spilled VGPRs"}), scalars = count({"Spilled SGPRs"});
    if (vectors || scalars) row.spilled_registers = vectors.value_or(0) + scalars.value_or(0);
    row.scratch_bytes = count({"Scratch size", "Local Memory Size", "LOCAL_SIZE_BYTES"});
    row.subgroups = count({"Subgroups per SIMD", "warps per multiprocessor"});
    row.max_subgroups = count({"max warps per multiprocessor"});
    row.code_bytes = count({"Code size", "Binary Size"});
    row.instructions = count({"Instructions"});
    row.branches = count({"Branches"});
    row.latency_cycles = statistic(statistics, {"Latency"});
    row.cycles_a_subgroup = statistic(statistics, {"Inverse Throughput"});
}

} // namespace tetrace
