#pragma once

#include "bench/judging/answers.h"
#include "bench/options/options.h"
#include "bench/output/report.h"

#include <string>

namespace tetrace {

/// What `tetrace judge` found out.
struct JudgedRun {
    std::string mesh; ///< as it was named
    std::uint64_t vertices = 0, triangles = 0, mesh_hash = 0;
    std::uint64_t rays = 0;
    bool rays_are_double = false, hits_are_double = false;
    AnswerTolerance tolerance;
    AnswerCounts counts;
    double seconds = 0; ///< of judging
};

/// name: as the user named it.
void note_mesh(JudgedRun& run, const std::string& name, const TriangleMesh& mesh);

[[nodiscard]] Report judged_report(const JudgedRun& run, const Options& options);

/// A test case for each kind of fault.
[[nodiscard]] std::string judged_junit(const JudgedRun& run);
/// Of a run that has ended early.
[[nodiscard]] std::string judged_junit_of(const std::string& problem);

} // namespace tetrace
