#pragma once

#include <optional>
#include <string>

namespace tetrace {

/// How this program was built; recorded with every result.
struct BuildIdentity {
    std::string version;
    std::string commit; ///< git describe at build time; "unknown" outside a repository
    std::string compiler;
    std::string flags;     ///< build type and compiler flags; then those of the host's kernels in each math mode
    std::string libraries; ///< that it was built with, with their versions
};
[[nodiscard]] BuildIdentity build_identity();

/// The machine that it runs on.
struct HostIdentity {
    std::string cpu;
    std::optional<unsigned> family, model, stepping; ///< of the CPU, if the system reports them: names may say no
                                                     ///< more than "AMD EPYC"
    std::string system;                              ///< the distribution's name and the kernel's release
    unsigned threads = 1;                            ///< that this process may use
};
[[nodiscard]] HostIdentity host_identity();

/// Now, in UTC: 2026-01-31T12:00:00Z.
[[nodiscard]] std::string utc_now();

} // namespace tetrace
