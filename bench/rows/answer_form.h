#pragma once

#include "bench/truth/hit_checks.h"
#include "core/pack/kernel_id.h"

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace tetrace {

/// How the answers of a task are counted, recorded and printed. They have a hit's size, and travel as hits.
struct AnswerForm {
    RayTotals (*count)(std::span<const Hit> answers);
    nlohmann::json (*to_json)(const Hit& answer);
    /// Throws nlohmann::json's exceptions or std::domain_error for what to_json() did not write.
    Hit (*from_json)(const nlohmann::json& object);
    const char* key; ///< of to_json()'s object, which no other task's has
    std::string (*text)(const Hit& answer);
    /// What the rays of a row cross, with the kind of rays; empty for tasks that find hits, whose means are in tables.
    std::string (*mean)(std::string_view rays, const RayTotals& totals);
};
/// Tasks trace and rays have the same. Throws Error{internal} for task search, whose answers are faces.
[[nodiscard]] const AnswerForm& answers_of(Task task);
/// The form of a recorded answer: that whose key it has.
[[nodiscard]] Task task_of(const nlohmann::json& answer);

/// "triangle 7", "no hit", "lost".
[[nodiscard]] std::string face_text(std::uint32_t face);

} // namespace tetrace
