#pragma once

#include "bench/results/result_value.h"

/// The keys of a row's fields that other code than row_fields() needs, each stated once. row_fields() takes them from
/// here, and so does what reads rows of any version of tetrace, which need not fit into a RowRecord. The key of any
/// other field is in row_fields() alone. Checked by tests/output/field_keys_test.cpp.
namespace tetrace::row_key {

inline constexpr RowPath name{"", "name"}, scene{"", "scene"}, structure{"", "structure"}, method{"", "method"},
    layout{"", "layout"}, backend{"", "backend"}, device{"", "device"}, device_index{"", "device_index"},
    threads{"", "threads"}, launches_in_flight{"", "launches_in_flight"}, task{"", "task"}, rays{"", "rays"},
    ray_order{"", "ray_order"}, math{"", "math"}, order{"", "order"}, schedule{"", "schedule"}, status{"", "status"},
    reason{"", "reason"}, self_test{"", "self_test"}, bytes{"", "bytes"}, conformity{"", "conformity"},
    hit_hash{"", "hit_hash"}, views_hash{"", "views_hash"};

// Objects of the row, which hold the fields below.
inline constexpr RowPath counts{"", "counts"}, gpu{"", "gpu"}, rates{"", "rates"}, times{"", "times"},
    verification{"", "verification"};

inline constexpr RowPath ray_count{counts.key, "rays"}, hits{counts.key, "hits"}, entering{counts.key, "entering"},
    steps{counts.key, "steps"}, hit_steps{counts.key, "hit_steps"}, mean_steps{counts.key, "mean_steps"},
    mean_steps_hit{counts.key, "mean_steps_hit"}, mean_steps_miss{counts.key, "mean_steps_miss"};

inline constexpr RowPath mrays_per_s{rates.key, "mrays_per_s"}, msteps_per_s{rates.key, "msteps_per_s"},
    bytes_per_step{rates.key, "bytes_per_step"}, ceiling_bytes_per_s{rates.key, "ceiling_bytes_per_s"},
    best_bvh{rates.key, "best_bvh"}, ratio_to_best_bvh{rates.key, "ratio_to_best_bvh"},
    ratio_to_best_bvh_low{rates.key, "ratio_to_best_bvh_low"},
    ratio_to_best_bvh_high{rates.key, "ratio_to_best_bvh_high"};

inline constexpr RowPath samples_s{times.key, "samples_s"}, launches{times.key, "launches"},
    median_s{times.key, "median_s"}, lower_quartile_s{times.key, "lower_quartile_s"},
    upper_quartile_s{times.key, "upper_quartile_s"}, noisy{times.key, "noisy"}, pulse{times.key, "pulse"},
    disturbed{times.key, "disturbed"}, overhead_s{times.key, "overhead_s"}, wall_s{times.key, "wall_s"};

inline constexpr RowPath ties{verification.key, "ties"}, wrong{verification.key, "wrong"},
    lost{verification.key, "lost"}, compared_with_openmp{verification.key, "compared_with_openmp"},
    different_from_openmp{verification.key, "different_from_openmp"},
    first_different{verification.key, "first_different"}, first_wrong{verification.key, "first_wrong"};

} // namespace tetrace::row_key

/// The same for the fields of the group ratio_group; no test looks for these.
namespace tetrace::ratio_key {

inline constexpr const char *row = "row", *ratio = "ratio", *low = "low", *high = "high", *reference = "reference";

} // namespace tetrace::ratio_key
