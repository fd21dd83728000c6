#include "bench/options/host_conditions.h"

#include "core/base/control_groups.h"
#include "core/base/files.h"
#include "core/base/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <sstream>
#include <vector>

namespace tetrace {

namespace {

namespace fs = std::filesystem;

/// The first word of a file; empty if there is none.
std::string word_in(const fs::path& file)
{
    std::istringstream words(file_bytes(file, 100).value_or(""));
    std::string word;
    words >> word;
    return printable_line(word);
}

/// "1" or "0"; other texts are not an answer.
std::optional<bool> flag_in(const fs::path& file)
{
    const std::string word = word_in(file);
    return word == "1" || word == "0" ? std::optional(word == "1") : std::nullopt;
}

/// By name; none if the folder cannot be read.
std::set<fs::path> entries_of(const fs::path& folder)
{
    std::error_code none;
    std::set<fs::path> entries;
    for (fs::directory_iterator entry(folder, none), end; !none && entry != end; entry.increment(none))
        entries.insert(entry->path());
    return entries;
}

/// The policies of Linux's cpufreq: groups of CPUs of one frequency.
std::set<fs::path> policies_below(const fs::path& frequencies)
{
    std::set<fs::path> policies;
    for (const fs::path& entry : entries_of(frequencies))
        if (entry.filename().string().starts_with("policy")) policies.insert(entry);
    return policies;
}

std::string governor_of(const std::set<fs::path>& policies)
{
    std::set<std::string> governors;
    for (const fs::path& policy : policies)
        if (std::string word = word_in(policy / "scaling_governor"); !word.empty()) governors.insert(std::move(word));
    return fmt::format("{}", fmt::join(governors, ", "));
}

/// intel_pstate has the opposite; newer drivers have a file for each policy.
std::optional<bool> turbo_of(const fs::path& cpus, const std::set<fs::path>& policies)
{
    if (const auto off = flag_in(cpus / "intel_pstate/no_turbo")) return !*off;
    if (const auto boost = flag_in(cpus / "cpufreq/boost")) return boost;
    std::optional<bool> turbo;
    for (const fs::path& policy : policies)
        if (const auto boost = flag_in(policy / "boost")) turbo = turbo.value_or(false) || *boost;
    return turbo;
}

/// A battery of a mouse (scope Device) is not the machine's.
std::optional<bool> battery_use(const fs::path& supplies)
{
    std::optional<bool> on_battery;
    for (const fs::path& supply : entries_of(supplies)) {
        const std::string type = word_in(supply / "type");
        if (type == "Battery" && word_in(supply / "scope") != "Device")
            on_battery = on_battery.value_or(false) || word_in(supply / "status") == "Discharging";
        else if (type == "Mains" && flag_in(supply / "online").value_or(false))
            return false;
    }
    return on_battery;
}

/// Of /proc/meminfo: "MemTotal:        8142036 kB".
std::uint64_t memory_in(const std::string& text)
{
    std::istringstream words(text);
    std::string key;
    std::uint64_t kilobytes = 0;
    return words >> key >> kilobytes && key == "MemTotal:" ? 1024 * kilobytes : 0;
}

} // namespace

HostConditions host_conditions(const fs::path& root)
{
    const fs::path cpus = root / "sys/devices/system/cpu";
    const auto policies = policies_below(cpus / "cpufreq");
    const ControlGroups groups(root);
    HostConditions found;
    found.governor = governor_of(policies);
    found.turbo = turbo_of(cpus, policies);
    found.smt = flag_in(cpus / "smt/active");
    found.on_battery = battery_use(root / "sys/class/power_supply");
    found.memory_bytes = memory_in(file_bytes(root / "proc/meminfo", 1000).value_or(""));
    found.cpu_limit = groups.cpus();
    found.memory_limit = groups.memory_bytes().value_or(0);
    return found;
}

std::string HostConditions::slowing_text() const
{
    std::string text;
    if (governor.find("powersave") != std::string::npos)
        text = fmt::format("the CPUs' frequency governor is {}", governor);
    if (on_battery.value_or(false)) text += text.empty() ? "the machine ran on its battery" : ", on battery";
    return text;
}

nlohmann::json conditions_json(const HostConditions& conditions)
{
    nlohmann::json json = nlohmann::json::object();
    if (!conditions.governor.empty()) json["governor"] = conditions.governor;
    if (conditions.turbo) json["turbo"] = *conditions.turbo;
    if (conditions.smt) json["smt"] = *conditions.smt;
    if (conditions.on_battery) json["on_battery"] = *conditions.on_battery;
    if (conditions.memory_bytes > 0) json["memory_bytes"] = conditions.memory_bytes;
    if (conditions.cpu_limit) json["cpu_limit"] = *conditions.cpu_limit;
    if (conditions.memory_limit > 0) json["memory_limit_bytes"] = conditions.memory_limit;
    return json;
}

} // namespace tetrace
