#include "bench/reproduce/paper.h"

#include <algorithm>
#include <iterator>

namespace tetrace::paper {

namespace {

constexpr SceneCounts table3[] = {
    {"bunny", 69'451, 682'733, 222'775}, // GRAPP 2017, Table 3; triangles: of Stanford's reconstruction
};

constexpr NearestBuild builds[] = {
    {"bunny", "pq8/4"},
    {"armadillo", "pq8/4"},
    {"banana", "pq5"},
};

constexpr FrameRates table6[] = {
    {"armadillo", 82, 160, 130, 260}, // GRAPP 2017, Table 6
};

constexpr PairOutcome who_is_faster[] = {
    {"banana", true},
    {"bunny", true},
    {"armadillo", false},
};

} // namespace

std::optional<SceneCounts> counts_of(std::string_view scene)
{
    const auto* const found =
        std::find_if(std::begin(table3), std::end(table3), [&](const SceneCounts& row) { return row.scene == scene; });
    if (found == std::end(table3)) return std::nullopt;
    return *found;
}

std::optional<std::string_view> nearest_switches(std::string_view scene)
{
    const auto* const found =
        std::find_if(std::begin(builds), std::end(builds), [&](const NearestBuild& row) { return row.scene == scene; });
    if (found == std::end(builds)) return std::nullopt;
    return found->switches;
}

std::optional<FrameRates> frames_of(std::string_view scene)
{
    const auto* const found =
        std::find_if(std::begin(table6), std::end(table6), [&](const FrameRates& row) { return row.scene == scene; });
    if (found == std::end(table6)) return std::nullopt;
    return *found;
}

std::span<const PairOutcome> outcomes()
{
    return who_is_faster;
}

bool has_scene(std::string_view scene)
{
    return nearest_switches(scene).has_value();
}

} // namespace tetrace::paper
