#include "bench/reproduce/paper.h"

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

/// The scene's row of a table of the paper's; empty where it has none.
template <class Row, std::size_t count>
std::optional<Row> find_scene(const Row (&rows)[count], std::string_view scene)
{
    for (const Row& row : rows)
        if (row.scene == scene) return row;
    return std::nullopt;
}

} // namespace

std::optional<SceneCounts> counts_of(std::string_view scene)
{
    return find_scene(table3, scene);
}

std::optional<std::string_view> nearest_switches(std::string_view scene)
{
    const auto found = find_scene(builds, scene);
    return found ? std::optional(found->switches) : std::nullopt;
}

std::optional<FrameRates> frames_of(std::string_view scene)
{
    return find_scene(table6, scene);
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
