#pragma once

#include "bench/reproduce/tables/paper_table.h"
#include "bench/rivals/judged_claim.h"

#include <vector>

namespace tetrace {

/// The page, as tables that `reproduce` records and `show` prints again:
/// - rivals: how many claims hold, by type of device, and each claim with its verdict;
/// - rivals-scenes: one row per scene, kind of rays and device: shares of rays, what building costs, and the ratios of
///   walks to BVHs;
/// - rivals-rows: every row with its rate and its ratio to the fastest BVH of the same contest.
[[nodiscard]] std::vector<PaperTable> rival_tables(const std::vector<RowRecord>& rows,
                                                   const std::vector<ContestScene>& scenes, LeftOut left_out);

/// The first of them.
[[nodiscard]] PaperTable claims_table(const std::vector<Contest>& contests, LeftOut left_out,
                                      const std::vector<RivalClaim>& claims = rival_claims());

} // namespace tetrace
