#include "bench/reproduce/paper.h"

namespace tetrace::paper {

namespace {

constexpr SceneFigures table3[] = {
    {"banana", 71'300, 24'568, 117'994, 6, 9.76, 428},
    {"bunny", 682'733, 222'775, 1'142'650, 62, 10.5, 289},
    {"armadillo", 2'990'552, 1'105'218, 4'875'834, 273, 6.75, 123},
};

constexpr NearestBuild builds[] = {
    {"banana", "pq5Y", 24'568},
    {"bunny", "pq8/4", 69'451},
    {"armadillo", "pq8/4", 345'944},
};

/// A method's row of Table 4 or 5.
struct WrongRays {
    Method method;
    double banana, bunny, armadillo;
};
constexpr WrongRays table4[] = {
    {Method::plane, 33.27, 40.85, 74.85},
    {Method::plucker, 3.6, 22.25, 412.13},
    {Method::stp, 63.07, 204.89, 456.65},
    {Method::ms06, 0.0007, 0.004, 0.422},
    {Method::maria, 0, 0, 0},
};

struct SearchTimes {
    Method method;
    double cpu_ms, gpu_ms;
};
constexpr SearchTimes table5[] = {
    {Method::plane, 15'623, 36}, {Method::plucker, 10'101, 28}, {Method::stp, 4'876, 29},
    {Method::ms06, 5'994, 21},   {Method::maria, 2'663, 13},
};

constexpr FrameRates table6[] = {
    {"banana", 315, 947, 200, 260},
    {"bunny", 130, 1040, 160, 260},
    {"armadillo", 82, 160, 130, 260},
};

constexpr PairOutcome who_is_faster[] = {
    {"banana", true},
    {"bunny", true},
    {"armadillo", false},
};

/// The scene's row of a table of the paper's; empty if it has none.
template <class Row, std::size_t count>
std::optional<Row> find_scene(const Row (&rows)[count], std::string_view scene)
{
    for (const Row& row : rows)
        if (row.scene == scene) return row;
    return std::nullopt;
}

template <class Row, std::size_t count>
std::optional<Row> find_method(const Row (&rows)[count], Method method)
{
    for (const Row& row : rows)
        if (row.method == method) return row;
    return std::nullopt;
}

} // namespace

std::span<const SceneFigures> scenes()
{
    return table3;
}

std::optional<SceneFigures> figures_of(std::string_view scene)
{
    return find_scene(table3, scene);
}

bool has_scene(std::string_view scene)
{
    return figures_of(scene).has_value();
}

double mean_mrays(Place place)
{
    return place == Place::cpu ? 9 : 280;
}

std::optional<NearestBuild> nearest_build(std::string_view scene)
{
    return find_scene(builds, scene);
}

std::optional<double> wrong_rays_of(std::string_view scene, Method method)
{
    const auto row = find_method(table4, method);
    if (!row || !has_scene(scene)) return std::nullopt;
    return scene == "banana" ? row->banana : scene == "bunny" ? row->bunny : row->armadillo;
}

std::optional<double> search_ms(Method method, Place place)
{
    const auto row = find_method(table5, method);
    if (!row) return std::nullopt;
    return place == Place::cpu ? row->cpu_ms : row->gpu_ms;
}

FastestOlder fastest_older(Place place)
{
    return place == Place::cpu ? FastestOlder{Method::stp, 0.83} : FastestOlder{Method::ms06, 0.59};
}

std::optional<FrameRates> frames_of(std::string_view scene)
{
    return find_scene(table6, scene);
}

std::span<const PairOutcome> outcomes()
{
    return who_is_faster;
}

} // namespace tetrace::paper
