#pragma once

#include "bench/inspection/inspected.h"

#include <filesystem>

namespace tetrace {

/// The devices of this machine that --backend and --device keep: those that a driver can compile for, and of each
/// backend named one that cannot, for its reason. None if neither option is given.
/// Throws Error{missing} if --device keeps no device.
[[nodiscard]] std::vector<Target> driver_targets(const Options& options);

/// Asks the driver of a device for each program, which it compiles as for a session. All rows are skipped if it reports
/// nothing of its code or cannot be used. points: those that the target's backend has. code: as in ask_null_hardware().
[[nodiscard]] std::vector<Inspected> ask_driver(const Target& target, const std::vector<EntryPoint>& points,
                                                const std::filesystem::path& code, const PartDone& tell);

} // namespace tetrace
