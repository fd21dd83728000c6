#pragma once

#include "core/base/enum_names.h"
#include "core/device/backend.h"

#include <string_view>

namespace tetrace {

/// Where drivers that are not ours run: in this process, or in one of their own for each device.
enum class Isolation { none, device };
template <>
inline constexpr auto enum_names<Isolation> = names_up_to<Isolation::device>("none", "device");

/// The first word of the command line of a driver's process; serve_driver() gets the others.
inline constexpr std::string_view driver_verb = "serve-driver";

/// Decides for all_backends(); call it once, before any driver is needed. Without it, drivers run in this process.
/// call_limit_s: seconds that a driver gets for a call; 0: by the size of its work. also: drivers of ours that get a
/// process of their own, too, because they run what another compiler makes.
void set_isolation(Isolation isolation, double call_limit_s, const std::vector<std::string>& also = {});
/// Whether it was decided for Isolation::device.
[[nodiscard]] bool is_isolated();

/// Names of the backends of this build whose drivers are not ours.
[[nodiscard]] const std::vector<std::string>& foreign_backends();

/// The backends, those with drivers that are not ours in processes of their own. foreign: the names of these.
[[nodiscard]] std::vector<Backend*> isolated(const std::vector<Backend*>& backends,
                                             const std::vector<std::string>& foreign);

/// Every backend of this build, each in this process: what a driver's process serves.
[[nodiscard]] const std::vector<Backend*>& direct_backends();

} // namespace tetrace
