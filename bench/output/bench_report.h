#pragma once

#include "bench/measuring/comparison.h"
#include "bench/measuring/measure.h"
#include "bench/measuring/row_devices.h"
#include "bench/measuring/scene_rows.h"
#include "bench/output/report.h"

namespace tetrace {

/// Everything that `tetrace bench` reports. Comparisons point into the rows.
struct BenchResult {
    SceneRows run;
    Measurement measurement;
    std::vector<RowDevice> devices;
    std::vector<std::optional<Comparison>> comparisons; ///< row by row
    std::vector<std::string> missing_scenes;            ///< sentences, see missing_default_scenes()
};

[[nodiscard]] Report bench_report(const BenchResult& result, const Options& options);

/// A scene's heading: counts, size, build; shared by bench and check.
[[nodiscard]] std::string scene_headline(const SceneWork& scene, const std::vector<RowRun>& rows);

/// A closing line: a label, and text filled to its right.
[[nodiscard]] std::string labelled(const std::string& label, const std::string& text);

/// The oracle's findings over all rows, in one sentence.
[[nodiscard]] std::string verdict_sentence(const std::vector<RowRun>& rows);

/// Rows without an answer and their reasons: a line for all rows of a scene that have the same one.
[[nodiscard]] std::string failure_lines(const std::vector<RowRun>& rows);

} // namespace tetrace
