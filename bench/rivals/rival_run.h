#pragma once

#include "bench/options/options.h"
#include "bench/reproduce/tables/paper_table.h"
#include "bench/rivals/judged_claim.h"
#include "bench/rows/rows.h"

#include <string>
#include <vector>

namespace tetrace {

/// The page, as tables that `reproduce` records and `show` prints again:
/// - rivals: how many claims hold, by type of device, and each claim with its verdict;
/// - rivals-scenes: one row per scene, kind of rays and device: shares of rays, what building costs, and the ratios of
///   walks to BVHs;
/// - rivals-rows: every row with its rate and its ratio to the fastest BVH of the same contest.
[[nodiscard]] std::vector<PaperTable> rival_tables(const std::vector<RowRecord>& rows,
                                                   const std::vector<ContestScene>& scenes, const LeftOut& left_out);

/// The first of them.
[[nodiscard]] PaperTable claims_table(const std::vector<RivalContest>& contests, const LeftOut& left_out,
                                      const std::vector<RivalClaim>& claims = rival_claims());

/// The options of `reproduce rivals` with its scenes, unless some are named: those of rival_scenes() that are available
/// here. missing: gets a sentence for each of them that is not.
[[nodiscard]] Options rival_options(Options options, std::vector<std::string>& missing);

/// The rows of the run. Each scene has primary rays and the other kinds that rival_scenes() gives it; a scene that is
/// not listed has diffuse and random rays. On openmp each kernel of one ray at a time also has its form for AVX2
/// (schedule native). Emulated devices have only primary rays, on scenes with all kinds of rays and on those that are
/// not listed, and so do Embree's trees of other qualities than high unless --layout names them. Unless --method names
/// it, maria has one layout and only primary rays, and none on emulated devices. --filter then keeps those whose names
/// match. Throws Error{usage} as select_rows() does.
[[nodiscard]] std::vector<RowKey> rival_rows(const Options& options);

/// What the options leave out of such a run.
[[nodiscard]] LeftOut left_out(const Options& options, const std::vector<Backend*>& backends = all_backends());

} // namespace tetrace
