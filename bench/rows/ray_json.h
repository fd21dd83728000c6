#pragma once

#include "bench/rows/row_run.h"

#include <nlohmann/json.hpp>

namespace tetrace {

// Rays and their answers, as results and the journal of `reproduce` record them.

[[nodiscard]] nlohmann::json hit_json(const Hit& hit);
[[nodiscard]] nlohmann::json wrong_ray_json(const WrongRay& ray);
[[nodiscard]] nlohmann::json differing_ray_json(const DifferingRay& ray);

// The reverse. These throw nlohmann::json's exceptions or std::domain_error for input that the functions above did not
// write.

[[nodiscard]] Hit hit_from(const nlohmann::json& object);
[[nodiscard]] WrongRay wrong_ray_from(const nlohmann::json& object);
[[nodiscard]] DifferingRay differing_ray_from(const nlohmann::json& object);

} // namespace tetrace
