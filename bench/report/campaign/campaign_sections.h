#pragma once

#include "bench/report/campaign/campaign.h"
#include "bench/report/html/html_table.h"

#include <vector>

namespace tetrace {

// The sections of a campaign's page, in order.

[[nodiscard]] Section index_section(const Campaign& campaign);  ///< machines and results; what was left out
[[nodiscard]] Section beside_section(const Campaign& campaign); ///< machines compared, same work only
[[nodiscard]] Section trend_section(const Campaign& campaign);  ///< each machine's rates over its dates

/// The machines that have a rate in a group, ascending.
[[nodiscard]] std::vector<std::size_t> machines_in(const CampaignGroup& group);

/// Where a machine's trends are on the page.
[[nodiscard]] std::string trend_anchor(const Campaign& campaign, std::size_t machine);

/// Whether a machine has the same work in results of several dates.
[[nodiscard]] bool has_trend(const Campaign& campaign, std::size_t machine);

} // namespace tetrace
