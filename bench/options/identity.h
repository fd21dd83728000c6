#pragma once

#include "bench/options/options.h"

#include <nlohmann/json.hpp>

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
    std::string system;   ///< the distribution's name, the kernel's release, a container's limits
    unsigned threads = 1; ///< that this process may use, a quota is rounded down
};
[[nodiscard]] HostIdentity host_identity();

/// Now, in UTC: 2026-01-31T12:00:00Z.
[[nodiscard]] std::string utc_now();

/// The text without anything that identifies the machine. Three kinds of path keep only their last part: file names
/// with an absolute path, paths that the options name, and paths below the home folder. A home folder becomes "~".
[[nodiscard]] std::string anonymous_text(const std::string& text, const Options& options);

/// The result with anonymous_text() applied to all its texts.
[[nodiscard]] nlohmann::json anonymous_json(nlohmann::json result, const Options& options);

} // namespace tetrace
