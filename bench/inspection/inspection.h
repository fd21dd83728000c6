#pragma once

#include "bench/inspection/inspected.h"
#include "bench/output/report.h"
#include "core/base/progress.h"

namespace tetrace {

/// What every compiler that was asked made of the programs asked for.
struct Inspection {
    std::vector<Inspected> rows;      ///< target after target
    std::vector<std::string> skipped; ///< "sm_90: no nvcc here, ..." for each target that could not be asked
};

/// The entry points that the options keep, of those that the target has.
[[nodiscard]] std::vector<EntryPoint> points_of(const Options& options, const Target& target);

/// Compiles every entry point that the options keep for every target, and every driver's device, that they name; runs
/// nothing.
/// tell: see core/base/progress.h.
/// Throws Error{usage} if no kernel is kept.
[[nodiscard]] Inspection inspect(const Options& options, const Progress& tell);

/// Throws Error{missing} naming the first required target that could not be asked, with the reason, or Error{usage}
/// naming one that is not among those asked.
void require_asked(const Inspection& inspection, const std::vector<std::string>& required);

/// Whether a program of exact mode has a fused operation where signs are decided.
[[nodiscard]] bool decides_fused(const Inspected& row);

/// The programs as a table, in all its forms, with a line for each target that could not be asked and for each fused
/// operation that exact mode forbids. JSON: results/README.md.
[[nodiscard]] Report inspection_report(const Inspection& inspection, const Options& options);

} // namespace tetrace
