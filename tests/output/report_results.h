#pragma once

#include <nlohmann/json.hpp>

#include <string>

// Small results of each verb, as `tetrace report` reads them.
namespace tetrace::test {

using nlohmann::json;

/// Names that would leave their place if anything forgot to escape them; or their innocent counterpart.
struct Names {
    std::string device, reason, title;
};
inline const Names innocent = {"a device", "a reason", "a title"};
inline const Names hostile = {R"(<script>alert("1")</script> & 'Co' </svg></title>)",
                              "</td></table><img src=https://example.org/x onerror=alert(1)>",
                              "\"><style>body{background:url(https://example.org/x)}</style><!-- "};

[[nodiscard]] inline json row_json(const std::string& name, const std::string& backend, const std::string& type,
                                   const Names& names)
{
    return {{"name", name},
            {"scene", "cubes"},
            {"structure", "cdt"},
            {"method", "maria"},
            {"layout", "tet80"},
            {"backend", backend},
            {"rays", "primary"},
            {"math", "exact"},
            {"order", "chains"},
            {"status", "ok"},
            {"device", {{"name", names.device + " of " + backend}, {"type", type}, {"driver", names.device}}},
            {"device_index", 0},
            {"hit_hash", "00000000000000ff"},
            {"bytes", 1000000},
            {"counts", {{"mean_steps", 10.5}}},
            {"times",
             {{"samples_s", {1.0, 1.1, 1.2}},
              {"median_s", 1.1},
              {"lower_quartile_s", 1.05},
              {"upper_quartile_s", 1.15},
              {"noisy", true},
              {"overhead_s", 0.01},
              {"wall_s", 1.11}}},
            {"rates", {{"mrays_per_s", 4.0}, {"msteps_per_s", 40.0}, {"bytes_per_step", 44}}}};
}

[[nodiscard]] inline json device_json(const std::string& backend, const std::string& type, const Names& names)
{
    return {{"backend", backend}, {"index", 0},           {"name", names.device + " of " + backend},
            {"type", type},       {"driver", "a driver"}, {"copy_bytes_per_s", 1e10},
            {"launch_s", 1e-5}};
}

[[nodiscard]] inline json head_json(const char* verb, const Names& names)
{
    return {{"schema_version", 2},
            {"verb", verb},
            {"date", "2026-01-31T12:00:00Z"},
            {"version", "0.1.0"},
            {"commit", "abc1234"},
            {"host", {{"cpu", names.device}, {"system", names.title}, {"threads", 2}}}};
}

[[nodiscard]] inline json scenes_json(const Names& names)
{
    return {{{"name", "cubes"},
             {"hash", "0123456789abcdef"},
             {"source", names.title},
             {"camera_set", "smoke"},
             {"views", {0, 3}},
             {"width", 24},
             {"height", 16}}};
}

/// A row on the processor, on a GPU, on an emulated device, and one that could not run.
[[nodiscard]] inline json bench_json(const Names& names = innocent)
{
    json section = head_json("bench", names);
    section["scenes"] = scenes_json(names);
    section["devices"] = {device_json("openmp", "cpu", names), device_json("cuda", "gpu", names),
                          device_json("vulkan", "emulated", names)};
    section["rows"] = {row_json("row/openmp", "openmp", "cpu", names), row_json("row/cuda", "cuda", "gpu", names),
                       row_json("row/vulkan", "vulkan", "emulated", names)};
    json failed = row_json("row/opencl", "opencl", "emulated", names);
    failed.erase("rates");
    failed.erase("times");
    failed["status"] = "error";
    failed["reason"] = names.reason;
    section["rows"].push_back(failed);
    section["ratios"] = {
        {{"row", "row/vulkan"}, {"reference", "row/openmp"}, {"ratio", 1.1}, {"low", 0.9}, {"high", 1.2}}};
    return {{"tetrace", section}};
}

[[nodiscard]] inline json check_json(const Names& names = innocent)
{
    json section = head_json("check", names);
    section["scenes"] = scenes_json(names);
    section["rows"] = json::array();
    section["missing_devices"] = {names.reason};
    section["matrix"]["cubes"]["cdt maria tet80"] = {{"openmp", {{"cell", "reference"}, {"conformity", "reference"}}},
                                                     {"vulkan", {{"cell", names.reason}, {"conformity", "wrong"}}}};
    return {{"tetrace", section}};
}

[[nodiscard]] inline json reproduce_json(const Names& names = innocent)
{
    const json claims = {{{"id", "1"}, {"text", names.title}, {"verdict", "holds"}, {"evidence", names.reason}},
                         {{"id", "2"}, {"text", "another"}, {"verdict", "does not hold"}, {"evidence", ""}}};
    json section = head_json("reproduce", names);
    section["tables"] = {
        {{"id", "table4"},
         {"title", names.title},
         {"source", names.reason},
         {"columns", {{{"key", "method"}, {"title", names.title}}, {{"key", "rate"}, {"title", "rate"}}}},
         {"rows",
          {{{"method", names.device},
            {"rate", {{"value", 12.5}, {"low", 12}, {"high", 13}, {"paper", 25}, {"ratio", 0.5}}}}}},
         {"claims", claims},
         {"notes", {names.reason}}}};
    section["figures"] = {{{"id", "figure6"},
                           {"title", names.title},
                           {"source", "the paper"},
                           {"x", {{"title", names.title}, {"unit", ""}}},
                           {"y", {{"title", "time"}, {"unit", "ms"}}},
                           {"series", {{{"name", names.device}, {"points", {{0, 1}, {1, 2}}}}}},
                           {"claims", json::array()},
                           {"pictures", json::array()},
                           {"notes", json::array()}}};
    return {{"tetrace", section}};
}

} // namespace tetrace::test
