#pragma once

#include "bench/measuring/comparison.h"
#include "bench/measuring/measure.h"
#include "bench/measuring/row_devices.h"
#include "bench/measuring/scene_rows.h"
#include "bench/output/report.h"
#include "bench/output/row_fields.h"
#include "bench/output/trust.h"
#include "bench/results/result_value.h"

#include <string>

namespace tetrace {

/// Everything that `tetrace bench` reports. Comparisons point into the rows.
struct BenchResult {
    std::vector<RowRecord> rows;
    Measurement measurement;
    HostConditions conditions;
    std::vector<RowDevice> devices;
    std::vector<std::optional<Comparison>> comparisons; ///< row by row
    std::vector<std::optional<Comparison>> best_bvhs;   ///< row by row, with the fastest BVH
    std::vector<std::string> missing_scenes;            ///< sentences, see missing_default_scenes()
    std::vector<std::string> missing_devices;           ///< sentences, see missing_devices()
    std::vector<nlohmann::json> scenes;                 ///< as results record them
    unsigned threads = 0;
    unsigned samples_asked = 0; ///< a row; known, as the next one is, where fewer were taken
    double budget_s = 0;
    bool interrupted = false;
};

/// As results record it; read_measurement() reads it again.
void set_measurement(nlohmann::json& section, const Measurement& measurement);

/// Whether any row has a rate.
[[nodiscard]] bool is_timed(const BenchResult& result);

/// What `bench` prints, and `show` prints again.
[[nodiscard]] Sheet bench_sheet(const BenchResult& result);

/// head: as result_head() makes it.
[[nodiscard]] Report bench_report(const BenchResult& result, const Options& options, nlohmann::json head);

/// A scene's heading: counts, size, build; shared by bench and check. scene: as results record it. Throws
/// Error{invalid_input} where it lacks one of them.
[[nodiscard]] std::string scene_headline(const ResultValue& scene);

/// The oracle's findings over all rows, in one sentence.
[[nodiscard]] std::string verdict_sentence(const std::vector<RowRecord>& rows);

/// Rows without an answer and their reasons, and an empty line: a line for all faulty rows that have the same one, and
/// one for all that are skipped or unsupported.
[[nodiscard]] Sheet failure_lines(const std::vector<RowRecord>& rows);

/// What a run found, in three lines: the fastest row of each scene; CDT compared with BVH, and each API with openmp;
/// whether to trust the rates. Empty if nothing was timed.
[[nodiscard]] Sheet answer_of(const BenchResult& result);

/// Of a run that was timed.
[[nodiscard]] Steadiness steadiness_of(const BenchResult& result);

/// What the fields of each row are read from.
[[nodiscard]] std::vector<RowFacts> facts_of(const BenchResult& result);

/// The results of a scene's rows, by device, under headings that name the hardware; failure_lines() has those that were
/// skipped or are unsupported.
[[nodiscard]] Table rate_table(const std::string& scene, const BenchResult& result);

/// Where the time of all rows goes, in milliseconds, by scene and device.
[[nodiscard]] Table time_table(const BenchResult& result);

/// The rows' devices and their peak rates.
[[nodiscard]] Table device_table(const std::vector<RowDevice>& devices);

/// The keys of all columns of the three tables above.
[[nodiscard]] std::vector<std::string> bench_columns();

/// Every row with all its figures, flat.
[[nodiscard]] Table flat_table(const BenchResult& result, const RunOrigin& origin);

} // namespace tetrace
