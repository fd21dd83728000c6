#pragma once

#include "bench/measuring/pulse.h"
#include "bench/measuring/row_devices.h"
#include "bench/results/result_value.h"

#include <nlohmann/json.hpp>

namespace tetrace {

/// A device as results record it (results/README.md); unknown members are left out.
[[nodiscard]] nlohmann::json device_json(const Device& device);

/// The reverse. Throws Error{invalid_input} naming file and key, as the other readers do.
[[nodiscard]] Device device_from(const ResultValue& value);

/// A device that rows ran on, with its microbenchmark and self-tests.
[[nodiscard]] nlohmann::json row_device_json(const RowDevice& device);

[[nodiscard]] RowDevice row_device_from(const ResultValue& value);

/// Sets a result's `load` and `pulses`, if they are known.
void set_steadiness(nlohmann::json& section, const std::optional<MachineLoad>& load, const std::vector<Pulse>& pulses);

} // namespace tetrace
