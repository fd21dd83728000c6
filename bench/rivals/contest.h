#pragma once

#include "bench/rivals/rival_claims.h"
#include "bench/rows/row_record.h"
#include "bench/statistics/statistics.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tetrace {

/// What claims ask of a scene.
struct ContestScene {
    std::string name;
    TetsKind tets = TetsKind::rays;
    bool has_own_views = false; ///< those that the catalogue gives it
};

/// Those of a result's `scenes`.
[[nodiscard]] std::vector<ContestScene> contest_scenes(const std::vector<nlohmann::json>& scenes);

/// The rows that may be compared with each other: the same rays of the same scene on the same device. On the host these
/// are openmp's and Embree's; on a GPU those of all of its APIs; an emulated device has a contest of its own.
struct Contest {
    std::string scene;
    RayKind rays = RayKind::primary;
    DeviceKind place = DeviceKind::cpu;
    std::string device;                 ///< "openmp, embree": the APIs
    std::vector<const RowRecord*> rows; ///< in the order of the run, whatever became of them
    std::optional<ContestScene> facts;  ///< of the scene; empty if it could not be loaded
};

/// All contests, in the order of their first rows. Our kernels in fast mode, and rows whose device is not known, are
/// in none.
/// rows: keep their addresses.
[[nodiscard]] std::vector<Contest> contests_of(const std::vector<RowRecord>& rows,
                                               const std::vector<ContestScene>& scenes);

[[nodiscard]] bool is_of(const RowRecord& row, Walk walk);
[[nodiscard]] bool is_of(const RowRecord& row, Rival rival);

/// The rows of a kind: a Walk or a Rival.
template <class Kind>
[[nodiscard]] std::vector<const RowRecord*> rows_of(const Contest& contest, Kind kind)
{
    std::vector<const RowRecord*> found;
    for (const RowRecord* row : contest.rows)
        if (is_of(*row, kind)) found.push_back(row);
    return found;
}

/// The row with the highest rate; null if none has a rate.
[[nodiscard]] const RowRecord* fastest(const std::vector<const RowRecord*>& rows);

/// The row's rate over the other's, with the interval of compare_rates(). Precondition: both have rates.
[[nodiscard]] Estimate rate_ratio(const RowRecord& row, const RowRecord& over);

/// "bunny", "bunny, shadow rays".
[[nodiscard]] std::string title_of(const Contest& contest);

/// "cdt project half32 packets on openmp (203 Mrays/s)"; says so if the row is noisy or flawed. Precondition: it has a
/// rate.
[[nodiscard]] std::string rated_label(const RowRecord& row);

} // namespace tetrace
