#pragma once

#include "bench/results/result_value.h"
#include "bench/rows/row_record.h"
#include "core/device/backend.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// The schema version of the results that this program writes; raised when a key changes its meaning or is removed.
inline constexpr unsigned schema_version = 2;

/// What made a result, on what, when.
struct ResultHead {
    std::uint64_t schema_version = 0;
    std::string verb, date, version, commit, cpu, system;
    std::optional<double> host_pulse_s;   ///< the fastest of the run; empty if it was not taken
    std::optional<std::uint64_t> threads; ///< that rows and pulse used
    std::string label;                    ///< the user's name of the machine; empty if there is none
    std::string processor;                ///< the CPU with family, model and stepping, if they are known
    std::string machine;                  ///< the label, else the processor

    /// A device's name, but of the processor the machine's: several processors are called "AMD EPYC".
    [[nodiscard]] const std::string& shown(const std::string& device) const { return device == cpu ? machine : device; }
};

/// A scene of a result with the rays that were traced through it.
struct ResultScene {
    std::string name;
    std::string hash;        ///< of all that decides a ray's answer
    std::string mesh_hash;   ///< of all that decides a BVH's answers; empty in results before 2026-11-27
    std::string source_hash; ///< of the mesh file
    std::string tets_kind, domain, switches;
    std::uint64_t divisions = 0;
    std::optional<std::uint64_t> effort; ///< of tets for rays
    std::string camera_set;              ///< a name
    std::string camera_set_hash;         ///< of its numbers; empty if the name determines them
    std::vector<std::uint64_t> views;
    std::uint64_t width = 0, height = 0;
};

/// An API and a device's number in it: "opencl", "opencl:1".
[[nodiscard]] std::string api_name(const std::string& backend, std::uint64_t index);

/// A row of a result; texts are empty if the file has none.
struct ResultRow {
    std::string name;
    std::string scene;     ///< empty: exit searches
    std::string structure; ///< "cdt" or "bvh"; empty: exit searches
    std::string backend;
    Status status = Status::skipped;
    std::string reason;   ///< several lines perhaps; no other control characters
    std::string schedule; ///< how rays come to work items, "tiles" for example
    std::string device, driver;
    std::optional<DeviceKind> device_kind; ///< empty if the row has no device
    std::uint64_t device_index = 0;        ///< in its backend
    std::uint64_t threads = 0;             ///< host threads; 0: those of the whole run
    std::uint64_t in_flight = 1;           ///< launches of a sample that were on the device together
    std::string hit_hash;   ///< empty if no rays were traced, or only by shards; of searches, the hash of their faces
    std::string views_hash; ///< empty in results before 2026-11-23 as well
    std::optional<double> mrays_per_s; ///< of the median sample; of searches, millions of those
    std::optional<double> pulse_ratio; ///< of calibration during its samples to the run's fastest
    std::uint64_t launches = 0;        ///< of a pass of a sample; 0: one for each view
    bool noisy = false;                ///< not to be relied on, by its samples or because the machine was disturbed
    std::vector<double> samples_s;     ///< device seconds, each from 1e-12 to 1e12; empty if the row was not timed

    [[nodiscard]] std::string api() const { return api_name(backend, device_index); }
};

/// A result file, checked as far as these members go. The rest is reached by section(), whose values are checked when
/// they are read.
struct ResultFile {
    std::filesystem::path path;
    nlohmann::json json;
    ResultHead head;
    std::vector<ResultScene> scenes; ///< names are unique
    std::vector<ResultRow> rows; ///< names are unique, in the file's order: row i is section().at("rows").items()[i]
    std::vector<ResultRow> searches; ///< rows of Table 5, whose names begin with "search/"
    std::string search_size;         ///< of those rows: "10000 x 16384"

    /// The section `tetrace`. Refers to this object, which has to outlive it.
    [[nodiscard]] ResultValue section() const { return ResultValue(json, path.string()).at("tetrace"); }
    /// Null if no scene (row) has that name.
    [[nodiscard]] const ResultScene* find_scene(const std::string& name) const;
    [[nodiscard]] const ResultRow* find_row(const std::string& name) const;
    /// The rows of scenes, then those of searches.
    [[nodiscard]] std::vector<const ResultRow*> timed_rows() const;
};

/// The head and the scenes of a result's section `tetrace`, without its rows. Throws as read_result() does for a result
/// that lacks a key or has one of another type.
[[nodiscard]] ResultHead read_head(const ResultValue& section);
[[nodiscard]] std::vector<ResultScene> read_scenes(const ResultValue& section);

/// The kind of a device, from a device of a result. Throws Error{invalid_input} if its "type" names none.
[[nodiscard]] DeviceKind device_kind_of(const ResultValue& device);

/// Reads a result as results/README.md states it, of any verb and of schema versions 1 and 2, which agree on all that
/// ResultFile's members hold. Google Benchmark's own part, which older results of bench also have, is left out. Throws
/// Error{missing} for a missing file; Error{invalid_input} naming file and key for one that cannot be
/// read, exceeds 64 MiB, 6,000,000 values or 64 levels, is not JSON, not a result, of another schema version, lacks a
/// key or has one of another type.
[[nodiscard]] ResultFile read_result(const std::filesystem::path& path);
/// The same of a result's JSON. path: of the file that errors name.
[[nodiscard]] ResultFile result_from(nlohmann::json json, const std::filesystem::path& path);

} // namespace tetrace
