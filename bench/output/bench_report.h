#pragma once

#include "bench/measuring/comparison.h"
#include "bench/measuring/measure.h"
#include "bench/measuring/row_devices.h"
#include "bench/measuring/scene_rows.h"
#include "bench/output/report.h"

namespace tetrace {

/// All that `tetrace bench` has to tell. Comparisons point into the rows.
struct BenchResult {
    SceneRows run;
    Measurement measurement;
    std::vector<RowDevice> devices;
    std::vector<std::optional<Comparison>> comparisons; ///< row by row
    std::vector<std::string> missing_scenes;            ///< sentences, see missing_default_scenes()
};

[[nodiscard]] Report bench_report(const BenchResult& result, const Options& options);

/// A scene's headline: counts, size, build; shared by bench and check.
[[nodiscard]] std::string scene_headline(const SceneWork& scene, const std::vector<RowRun>& rows);

/// A closing line: a label, and text filled beside it.
[[nodiscard]] std::string labelled(const std::string& label, const std::string& text);

/// What the oracle found over all rows, one sentence.
[[nodiscard]] std::string verdict_sentence(const std::vector<RowRun>& rows);

/// Rows that have no answer, each with its reason, a line each.
[[nodiscard]] std::string failure_lines(const std::vector<RowRun>& rows);

} // namespace tetrace
