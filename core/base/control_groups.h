#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// How often the kernel stopped a group because it had used its CPU quota.
struct Throttling {
    std::uint64_t periods = 0; ///< of the quota, mostly 0.1 s each
    double seconds = 0;        ///< added up over CPUs
};

/// What Linux's control groups allow this process, as in a container: versions 1, 2, and both side by side. Of the
/// process's group and those above it, the strictest limit counts. A file that is missing or damaged is no limit.
class ControlGroups {
public:
    /// root: where /proc and /sys are; tests have their own.
    explicit ControlGroups(const std::filesystem::path& root = "/");

    /// How many CPUs' worth of time the process may use.
    [[nodiscard]] std::optional<double> cpus() const;
    /// The quota in whole threads: rounded down, at least 1.
    [[nodiscard]] std::optional<unsigned> threads() const;
    [[nodiscard]] std::optional<std::uint64_t> memory_bytes() const;
    /// What may still be allocated. File caches, which the kernel gives up before it kills a process, count as free.
    [[nodiscard]] std::optional<std::uint64_t> free_memory_bytes() const;
    /// Since the group was made; empty if there is no quota.
    [[nodiscard]] std::optional<Throttling> throttling() const;

private:
    /// A group's folder, in one version's hierarchy.
    struct Group {
        std::filesystem::path folder;
        bool is_unified; ///< version 2
    };
    [[nodiscard]] static std::optional<double> cpus_of(const Group& group);
    [[nodiscard]] static std::optional<std::uint64_t> memory_of(const Group& group);
    [[nodiscard]] static std::uint64_t used_memory_of(const Group& group);

    std::vector<Group> cpu_, memory_; ///< from the process's group up
};

/// Whether a new array of this size stays within the memory limit of the process's groups. Above it the kernel kills
/// the process, which then says nothing. True for small arrays, and without a limit.
[[nodiscard]] bool fits_in_memory(std::uint64_t bytes);

/// What the system can still hand out without swapping, and the process's groups allow, in bytes; all of its memory if
/// it does not say.
[[nodiscard]] std::uint64_t available_memory_bytes();

/// What follows "out of memory" where there is a limit: " (this container may use 512 MB)".
[[nodiscard]] std::string memory_limit_text();

} // namespace tetrace
