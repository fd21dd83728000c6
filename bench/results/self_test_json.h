#pragma once

#include "bench/results/result_value.h"
#include "core/device/self_test.h"

#include <nlohmann/json.hpp>

namespace tetrace {

/// A self-test as results record it: its fields under their names, "exact", and its line of text.
[[nodiscard]] nlohmann::json self_test_json(const SelfTest& test);

/// The reverse. Throws Error{invalid_input} naming file and key.
[[nodiscard]] SelfTest self_test_from(const ResultValue& value);

} // namespace tetrace
