#pragma once

#include "bench/report/campaign/campaign.h"
#include "bench/report/sections.h"

namespace tetrace {

/// The whole page, self-contained: without scripts, and loading nothing, which its content security policy enforces.
/// Throws as the sections do.
[[nodiscard]] std::string report_page(const ReportInput& input);

/// The page of a campaign: an index of machines and results, machines compared, and each machine's rates over its
/// dates. Throws as picture_section() does.
[[nodiscard]] std::string campaign_page(const Campaign& campaign, const std::vector<std::filesystem::path>& pictures);

/// Reads the results. Throws as read_result() and report_rows() do.
[[nodiscard]] ReportInput read_report_input(const std::vector<std::filesystem::path>& results,
                                            std::vector<std::filesystem::path> pictures);

} // namespace tetrace
