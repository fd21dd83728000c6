#include "core/base/control_groups.h"

#include "core/base/files.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <unistd.h>

namespace tetrace {

namespace fs = std::filesystem;

namespace {

/// What no group may exceed has no limit: version 1 writes the largest multiple of a page.
constexpr std::uint64_t unlimited = std::uint64_t{1} << 60;

/// A number at the start of a file; empty if there is none ("max", "-1").
std::optional<std::uint64_t> number_in(const fs::path& file)
{
    std::istringstream words(file_bytes(file, 100).value_or(""));
    std::int64_t number = 0;
    return words >> number && number >= 0 ? std::optional(static_cast<std::uint64_t>(number)) : std::nullopt;
}

/// A line "name number" of a file of counts.
std::optional<std::uint64_t> count_in(const fs::path& file, std::string_view name)
{
    std::istringstream words(file_bytes(file, 100'000).value_or(""));
    std::string found;
    for (std::uint64_t number = 0; words >> found >> number;)
        if (found == name) return number;
    return std::nullopt;
}

/// Whether a list with commas has a word.
bool lists(const std::string& text, std::string_view word)
{
    std::istringstream words(text);
    for (std::string one; std::getline(words, one, ',');)
        if (one == word) return true;
    return false;
}

/// A hierarchy of groups that is mounted, and the part of it that the mount shows.
struct Mount {
    fs::path folder;     ///< where it is
    std::string top;     ///< the group that is there: "/", or that of a container
    std::string options; ///< with the controllers, of version 1
    bool is_unified;
};

/// Of /proc/self/mountinfo: "36 35 0:31 /top /sys/fs/cgroup/cpu rw,relatime - cgroup cgroup rw,cpu".
std::vector<Mount> mounts_of(const std::string& text, const fs::path& root)
{
    std::vector<Mount> mounts;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t dash = line.find(" - ");
        if (dash == std::string::npos) continue;
        std::istringstream before(line.substr(0, dash)), after(line.substr(dash + 3));
        std::string number, parent, device, top, folder, type, source, options;
        before >> number >> parent >> device >> top >> folder;
        after >> type >> source >> options;
        if (type == "cgroup" || type == "cgroup2")
            mounts.push_back({root / fs::path(folder).relative_path(), top, options, type == "cgroup2"});
    }
    return mounts;
}

/// The group's path below a mount. A container may see its own group as the mount's top, under the host's name for it,
/// or under a name that leads out of its namespace.
fs::path below(const Mount& mount, const std::string& group)
{
    if (mount.top != "/" && (group == mount.top || group.starts_with(mount.top + "/")))
        return fs::path(group.substr(mount.top.size())).relative_path();
    if (mount.top != "/" || group.starts_with("/..")) return {};
    return fs::path(group).relative_path();
}

} // namespace

ControlGroups::ControlGroups(const fs::path& root)
{
    const auto mounts = mounts_of(file_bytes(root / "proc/self/mountinfo").value_or(""), root);
    const auto add = [&](const Mount& mount, const std::string& group, std::vector<Group>& groups) {
        std::error_code ignored; // a group that the mount does not show
        fs::path path = below(mount, group);
        if (!fs::is_directory(mount.folder / path, ignored)) path.clear();
        for (;; path = path.parent_path()) {
            groups.push_back({path.empty() ? mount.folder : mount.folder / path, mount.is_unified});
            if (path.empty()) return;
        }
    };
    // Of /proc/self/cgroup: "4:cpu,cpuacct:/group" of version 1, "0::/group" of version 2.
    std::istringstream lines(file_bytes(root / "proc/self/cgroup").value_or(""));
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1), group = line.substr(second + 1);
        for (const Mount& mount : mounts) {
            if (mount.is_unified != controllers.empty()) continue;
            for (const auto& [controller, groups] : {std::pair("cpu", &cpu_), std::pair("memory", &memory_)})
                if (mount.is_unified || (lists(controllers, controller) && lists(mount.options, controller)))
                    add(mount, group, *groups);
        }
    }
}

std::optional<double> ControlGroups::cpus_of(const Group& group)
{
    std::optional<double> quota, period;
    if (group.is_unified) { // "150000 100000", "max 100000"
        std::istringstream words(file_bytes(group.folder / "cpu.max", 100).value_or(""));
        double time = 0, per = 0;
        if (words >> time >> per) quota = time, period = per;
    } else {
        quota = number_in(group.folder / "cpu.cfs_quota_us");
        period = number_in(group.folder / "cpu.cfs_period_us");
    }
    return quota && period && *quota > 0 && *period > 0 ? std::optional(*quota / *period) : std::nullopt;
}

std::optional<std::uint64_t> ControlGroups::memory_of(const Group& group)
{
    const auto bytes = number_in(group.folder / (group.is_unified ? "memory.max" : "memory.limit_in_bytes"));
    return bytes && *bytes < unlimited ? bytes : std::nullopt;
}

std::uint64_t ControlGroups::used_memory_of(const Group& group)
{
    const std::string total = group.is_unified ? "" : "total_"; // of version 1, with the groups below
    std::uint64_t used =
        number_in(group.folder / (group.is_unified ? "memory.current" : "memory.usage_in_bytes")).value_or(0);
    for (const char* const cache : {"inactive_file", "active_file"})
        used -= std::min(used, count_in(group.folder / "memory.stat", total + cache).value_or(0));
    return used;
}

std::optional<double> ControlGroups::cpus() const
{
    std::optional<double> least;
    for (const Group& group : cpu_)
        if (const auto cpus = cpus_of(group)) least = std::min(least.value_or(*cpus), *cpus);
    return least;
}

std::optional<unsigned> ControlGroups::threads() const
{
    const auto quota = cpus();
    return quota ? std::optional(static_cast<unsigned>(std::clamp(std::floor(*quota), 1.0, 1e6))) : std::nullopt;
}

std::optional<std::uint64_t> ControlGroups::memory_bytes() const
{
    std::optional<std::uint64_t> least;
    for (const Group& group : memory_)
        if (const auto bytes = memory_of(group)) least = std::min(least.value_or(*bytes), *bytes);
    return least;
}

std::optional<std::uint64_t> ControlGroups::free_memory_bytes() const
{
    std::optional<std::uint64_t> least;
    for (const Group& group : memory_)
        if (const auto bytes = memory_of(group)) {
            const std::uint64_t free = *bytes - std::min(*bytes, used_memory_of(group));
            least = std::min(least.value_or(free), free);
        }
    return least;
}

std::optional<Throttling> ControlGroups::throttling() const
{
    std::optional<Throttling> all;
    for (const Group& group : cpu_) {
        if (!cpus_of(group)) continue;
        const fs::path file = group.folder / "cpu.stat";
        const std::uint64_t periods = count_in(file, "nr_throttled").value_or(0);
        const double seconds = group.is_unified
                                   ? 1e-6 * static_cast<double>(count_in(file, "throttled_usec").value_or(0))
                                   : 1e-9 * static_cast<double>(count_in(file, "throttled_time").value_or(0));
        if (!all) all.emplace();
        all->periods += periods;
        all->seconds += seconds;
    }
    return all;
}

bool fits_in_memory(std::uint64_t bytes)
{
    constexpr std::uint64_t small = std::uint64_t{16} << 20; // and what is kept free for all small ones
    if (bytes < small) return true;                          // also what ControlGroups itself allocates
    static const bool is_limited = ControlGroups().memory_bytes().has_value();
    return !is_limited || bytes + small <= ControlGroups().free_memory_bytes().value_or(bytes + small);
}

std::uint64_t available_memory_bytes()
{
    const std::string text = file_bytes("/proc/meminfo").value_or("");
    constexpr std::string_view key = "MemAvailable:";
    const std::size_t place = text.find(key);
    const std::uint64_t bytes = place == std::string::npos
                                    ? static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                                          static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE))
                                    : 1024 * std::strtoull(text.c_str() + place + key.size(), nullptr, 10);
    return std::min(bytes, ControlGroups().free_memory_bytes().value_or(bytes));
}

std::string memory_limit_text()
{
    const auto bytes = ControlGroups().memory_bytes();
    return bytes ? " (this container may use " + std::to_string(*bytes / 1'000'000) + " MB)" : "";
}

} // namespace tetrace
