#pragma once

#include "bench/measuring/pulse.h"
#include "bench/measuring/row_devices.h"

#include <nlohmann/json.hpp>

namespace tetrace {

/// A device as results record it (results/README.md); unknown members are left out.
[[nodiscard]] nlohmann::json device_json(const Device& device);

/// A self-test as results record it: its fields under their names, "exact", and its line of text.
[[nodiscard]] nlohmann::json self_test_json(const SelfTest& test);

/// A device that rows ran on, with its yardstick and self-tests.
[[nodiscard]] nlohmann::json row_device_json(const RowDevice& device);

/// What a row's GPU told while its samples were taken.
[[nodiscard]] nlohmann::json gpu_json(const GpuReadings& readings);

/// Sets a result's `load` and `pulses`, where they are known.
void set_steadiness(nlohmann::json& section, const std::optional<MachineLoad>& load, const std::vector<Pulse>& pulses);

} // namespace tetrace
